"""What a LAS file says of itself, before anyone believes it."""

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import FormatError

_SHORTEST = 227
"""Bytes of the header up to version 1.2; what follows came with 1.3 and 1.4."""
_RECORD = 54
"""Bytes of the head of a variable-length record."""
_PACKED = 0x80
"""Bit of the point format that says LAZ."""
_POINT_SIZES = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)
"""Bytes of a point of each format, at least (LAS 1.4 R15, tables 7 to 17)."""
_SMALLEST_CHUNK = 16
"""Bytes below which no chunk of packed points is."""


@dataclass(frozen=True)
class _Stated:
    minor: int
    header_size: int
    offset: int
    num_records: int
    is_packed: bool
    point_format: int
    point_size: int
    count: int
    numbers: tuple[float, ...]
    """Scales and offsets of the coordinates."""


def check_las_header(path: Path) -> None:
    """Refuse a header that lies about sizes, so that none of them costs memory.

    Raises:
        FormatError: The file is no LAS file, or shorter than it says.
        FileNotFoundError: There is no such file.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(375)
        if len(head) < _SHORTEST or head[:4] != b"LASF":
            raise FormatError(f"{path} is not a LAS file.")
        stated = _read(head)
        records = stated.header_size + _RECORD * stated.num_records
        if not _SHORTEST <= stated.header_size <= records <= stated.offset <= size:
            raise FormatError(
                f"{path} declares a header of {stated.header_size} bytes, {stated.num_records} "
                f"records and points from byte {stated.offset} on, but holds {size} bytes; it is "
                "damaged."
            )
        if not np.isfinite(stated.numbers).all():
            raise FormatError(f"{path} has a scale or an offset that is no number.")
        _check_point_size(stated, path)
        wanted = stated.count * stated.point_size
        if stated.is_packed:
            _check_chunks(file, stated, path, size)
        elif size - stated.offset < wanted:
            raise FormatError(
                f"{path} declares {stated.count} points, which need {wanted} bytes, but holds "
                f"{size - stated.offset} bytes; it is cut off or damaged."
            )


def _read(head: bytes) -> _Stated:
    header_size, offset, num_records, kind, point_size, count = struct.unpack_from(
        "<HIIBHI", head, 94
    )
    minor = head[25]
    if minor >= 4 and len(head) >= 255:
        (count,) = struct.unpack_from("<Q", head, 247)
    numbers = struct.unpack_from("<6d", head, 131)
    packed, kind = bool(kind & _PACKED), kind & 0x3F
    return _Stated(
        minor, header_size, offset, num_records, packed, kind, point_size, count, numbers
    )


def _check_point_size(stated: _Stated, path: Path) -> None:
    """Refuse points that have no room for what their format says is in them."""
    if stated.point_format >= len(_POINT_SIZES):
        raise FormatError(
            f"{path} has points of format {stated.point_format}, which LAS 1.4 does not know; it "
            "is damaged, or newer."
        )
    needed = _POINT_SIZES[stated.point_format]
    if stated.point_size < needed:
        raise FormatError(
            f"{path} declares points of {stated.point_size} bytes, but those of its format "
            f"{stated.point_format} have {needed}; it is damaged. Save it anew."
        )


def _check_chunks(file: BinaryIO, stated: _Stated, path: Path, size: int) -> None:
    """Refuse a table of more chunks of packed points than the file has room for."""
    file.seek(stated.offset)
    (table,) = struct.unpack("<q", file.read(8).ljust(8, b"\0"))
    if table == -1 and size >= stated.offset + 16:
        file.seek(-8, 2)
        (table,) = struct.unpack("<q", file.read(8))
    if stated.count == 0 and table in (0, stated.offset + 8):
        return
    if not stated.offset + 8 <= table <= size - 8:
        raise FormatError(f"{path} has lost its table of packed points; it is cut off or damaged.")
    file.seek(table + 4)
    (chunks,) = struct.unpack("<I", file.read(4))
    if chunks > (table - stated.offset) // _SMALLEST_CHUNK + 1:
        raise FormatError(
            f"{path} declares {chunks} chunks of packed points in {table - stated.offset} bytes; "
            "it is damaged."
        )
