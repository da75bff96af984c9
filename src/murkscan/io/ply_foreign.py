"""PLY files for other programs, and points of those that they wrote, in text or binary."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import FormatError
from ..types.cloud import PointCloud
from .blocks import lines_at_once, rows_at_once
from .cloud_columns import BLOCK, COLUMNS, SCALARS, as_rows, from_columns, known_name
from .ply import writing_rows

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS = {"ascii": "<", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 1000
_LONGEST_LINE = 4000
_SHORTEST_VALUE = 2
"""Bytes of a number in a text file and of what parts it from the next."""


_SHOWN = np.dtype(
    [(f"scalar_{name}" if name in SCALARS else name, COLUMNS[name]) for name in COLUMNS.names or ()]
    + [("quality", "<f4")]
)
"""The columns of cloud.ply with names that CloudCompare shows without being asked, and the one
scalar field that MeshLab shows: the signal."""


@contextmanager
def writing_shown_ply(path: Path) -> Iterator[Callable[[PointCloud], None]]:
    """Write a cloud block by block as MeshLab and CloudCompare show it.

    The file appears whole when the context ends, or not at all.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with writing_rows(path, _SHOWN) as write:

        def write_cloud(cloud: PointCloud) -> None:
            rows, ours = np.empty(len(cloud), _SHOWN), as_rows(cloud)
            for name, shown in zip(COLUMNS.names or (), _SHOWN.names or (), strict=False):
                rows[shown] = ours[name]
            rows["quality"] = cloud.signal
            write(rows)

        yield write_cloud


@dataclass(frozen=True)
class _Header:
    encoding: str
    count: int
    """Points."""
    names: list[str]
    types: list[str]
    before: int
    """Bytes, or in text lines, of what stands before the points."""


def iterate_ply(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read the points of any PLY file, some at a time; other elements are passed over.

    Raises:
        FormatError: The file is no PLY file with x, y and z, or shorter than it says; a header
            that lies about the number of points costs no memory.
        FileNotFoundError: There is no such file.
    """
    with path.open("rb") as file:
        header = _read_header(file, path)
        if header.encoding == "ascii":
            yield from _read_text(file, header, path, block)
        else:
            yield from _read_binary(file, header, path, block)


def _read_binary(file: BinaryIO, header: _Header, path: Path, block: int) -> Iterator[PointCloud]:
    order = _ORDERS[header.encoding]
    rows_type = np.dtype([(str(k), order + kind) for k, kind in enumerate(header.types)])
    _require_room(file, path, header, header.before + header.count * rows_type.itemsize)
    file.seek(header.before, 1)
    block = rows_at_once(rows_type.itemsize, block)
    for begin in range(0, header.count, block):
        rows = np.fromfile(file, rows_type, min(block, header.count - begin))
        yield _as_cloud(header, [rows[str(k)] for k in range(len(header.names))])


def _read_text(file: BinaryIO, header: _Header, path: Path, block: int) -> Iterator[PointCloud]:
    width = len(header.names)
    rows = header.before + header.count * width
    _require_room(file, path, header, _SHORTEST_VALUE * rows - 1)
    for _ in range(header.before):
        file.readline(_LONGEST_LINE)
    lines, left = iter(lambda: file.readline(_LONGEST_LINE), b""), header.count
    while left:
        some = lines_at_once(lines, min(block, left))
        try:
            values = np.loadtxt(some, ndmin=2, usecols=range(width)) if some else np.empty(0)
        except ValueError as error:
            raise FormatError(f"{path} holds a line that is no {width} numbers.") from error
        if not some or len(values) != len(some):
            raise FormatError(f"{path} declares {header.count} points but holds fewer.")
        yield _as_cloud(header, list(values.T))
        left -= len(some)


def _as_cloud(header: _Header, values: list[np.ndarray]) -> PointCloud:
    known = [(known_name(name), column) for name, column in zip(header.names, values, strict=True)]
    return from_columns({name: column for name, column in known if name is not None})


def _require_room(file: BinaryIO, path: Path, header: _Header, wanted: int) -> None:
    there = path.stat().st_size - file.tell()
    if there < wanted:
        raise FormatError(
            f"{path} declares {header.count} points, which need {wanted} bytes or more, but holds "
            f"{there} bytes; it is cut off or damaged."
        )


def _read_header(file: BinaryIO, path: Path) -> _Header:
    if file.readline(_LONGEST_LINE).rstrip() != b"ply":
        raise FormatError(f"{path} is not a PLY file.")
    encoding, elements = "", list[tuple[str, int, list[list[str]]]]()
    for _ in range(_LONGEST_HEADER):
        words = file.readline(_LONGEST_LINE).decode("ascii", "replace").split()
        match words:
            case ["end_header"]:
                return _make_header(encoding, elements, path)
            case ["format", known, _] if known in _ORDERS:
                encoding = known
            case ["element", name, count] if count.isdecimal() and len(count) < 19:
                elements.append((name, int(count), []))
            case ["property", *rest] if elements and len(rest) >= 2:
                elements[-1][2].append(rest)
            case ["comment" | "obj_info", *_] | []:
                pass
            case _:
                raise FormatError(f"{path} has the line {' '.join(words)[:60]!r} in its header.")
    raise FormatError(f"{path} is a PLY file without an end to its header.")


def _make_header(
    encoding: str, elements: list[tuple[str, int, list[list[str]]]], path: Path
) -> _Header:
    before = 0
    for name, count, properties in elements:
        if any(len(words) != 2 or words[0] not in _TYPES for words in properties):
            raise FormatError(f"{path} has lists before or in its points, which no cloud has.")
        types = [_TYPES[words[0]] for words in properties]
        if name == "vertex":
            names = [words[1] for words in properties]
            ours = [known_name(name) for name in names]
            twice = len({name for name in ours if name}) < len([name for name in ours if name])
            if not {"x", "y", "z"} <= set(ours) or twice or not encoding:
                raise FormatError(f"{path} has no columns x, y and z, or one of them twice.")
            return _Header(encoding, count, names, types, before)
        size = sum(np.dtype(kind).itemsize for kind in types)
        before += count if encoding == "ascii" else count * size
    raise FormatError(f"{path} has no points: there is no element vertex.")
