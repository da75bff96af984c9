"""What a LAZ file says of its packed points, before anyone makes room for them.

A file is a row of chunks. Of the newer point formats each begins with one point as it is, the
number of points, and the length of each of its layers::

    offset ─▶ where the table is │ point · count · lengths · layers │ … │ table of chunks
"""

import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ..errors import FormatError

_LAYERED = 3
"""Compressor of the newer point formats."""
_RECORD = 22204
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}
"""Layers of an item, by its type; of extra bytes (14) each is a layer."""
_EXTRA = 14


def check_laz_chunks(path: Path, header: Any) -> None:
    """Refuse packed points whose lengths add up to more than there is.

    Args:
        path: A LAZ file whose header has been checked.
        header: The header, as laspy has read it.

    Raises:
        FormatError: They do.
    """
    import lazrs

    records = [record for record in header.vlrs if record.record_id == _RECORD]
    if not records:
        raise FormatError(f"{path} does not say how its points are packed; it is damaged.")
    stated = bytes(records[0].record_data)
    compressor, items = _items(stated, path)
    if sum(size for _, size in items) != header.point_format.size:
        raise FormatError(f"{path} packs other points than its header declares; it is damaged.")
    if header.point_count == 0:
        return
    start = header.offset_to_point_data
    with path.open("rb") as file:
        file.seek(start)
        vlr = lazrs.LazVlr(stated)
        chunks = lazrs.read_chunk_table(file, vlr)
        _check_count(chunks, vlr, header.point_count, path)
        room = path.stat().st_size - start
        lengths = np.array([length for _, length in chunks], float)
        if lengths.sum() > room:
            raise FormatError(
                f"{path} declares {lengths.sum():.0f} bytes of packed points but holds {room}; it "
                "is cut off or damaged."
            )
        if compressor == _LAYERED:
            num_layers = sum(
                size if kind == _EXTRA else _LAYERS.get(kind, 0) for kind, size in items
            )
            begins = start + 8 + np.concatenate([[0.0], np.cumsum(lengths)])
            for begin, length in zip(begins, lengths, strict=False):
                _check_layers(
                    file, int(begin), int(length), header.point_format.size, num_layers, path
                )


def _check_count(
    chunks: Sequence[tuple[int | None, int]], vlr: Any, num_points: int, path: Path
) -> None:
    """Refuse fewer chunks than the points need: what is read behind them is not looked at here."""
    sizes = [vlr.chunk_size() if count is None else count for count, _ in chunks]
    if vlr.uses_variable_size_chunks() is False:
        sizes = [vlr.chunk_size()] * len(chunks)
    if sum(sizes) < num_points:
        raise FormatError(
            f"{path} declares {num_points} points but has room for {sum(sizes)} in "
            f"{len(chunks)} chunks; it is damaged."
        )


def _items(stated: bytes, path: Path) -> tuple[int, list[tuple[int, int]]]:
    """Give the compressor, and type and size of each item of a point."""
    if len(stated) < 34:
        raise FormatError(f"{path} does not say how its points are packed; it is damaged.")
    (compressor,) = struct.unpack_from("<H", stated)
    (count,) = struct.unpack_from("<H", stated, 32)
    if len(stated) < 34 + 6 * count:
        raise FormatError(f"{path} does not say how its points are packed; it is damaged.")
    items = [struct.unpack_from("<HH", stated, 34 + 6 * number) for number in range(count)]
    return compressor, items


def _check_layers(
    file: BinaryIO, begin: int, length: int, point_size: int, num_layers: int, path: Path
) -> None:
    file.seek(begin + point_size + 4)
    sizes = file.read(4 * num_layers)
    if len(sizes) < 4 * num_layers or sum(struct.unpack(f"<{num_layers}I", sizes)) > length:
        raise FormatError(f"{path} has a chunk of packed points that is damaged.")
