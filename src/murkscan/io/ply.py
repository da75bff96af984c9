"""Point clouds as binary PLY files: the project's own columns, and what MeshLab shows of them."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import FormatError
from ..types.cloud import PointCloud
from .atomic import replacing
from .cloud_columns import ADDED, BLOCK, COLUMNS, as_rows, from_columns

_TYPES = {"<f8": "double", "<f4": "float", "<i4": "int", "|u1": "uchar"}
"""What PLY calls them."""
_FORMAT = "format binary_little_endian 1.0"
_LONGEST_HEADER = 100
"""Lines of a header after which it is none."""
_LONGEST_LINE = 1000
_DIGITS = 20
"""Room for the number of points, which is known last."""


def save_cloud(path: Path, cloud: PointCloud) -> None:
    """Write a cloud: positions and deviations in metres, signal in grey levels.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with writing_cloud(path) as write:
        write(cloud)


@contextmanager
def writing_cloud(path: Path) -> Iterator[Callable[[PointCloud], None]]:
    """Write a cloud block by block; the file appears whole when the context ends, or not at all.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with writing_rows(path, COLUMNS) as write:
        yield lambda cloud: write(as_rows(cloud))


@contextmanager
def writing_rows(path: Path, columns: np.dtype[np.void]) -> Iterator[Callable[[np.ndarray], None]]:
    """Write the rows of a table as the points of a PLY file; see `writing_cloud`.

    Args:
        path: The file.
        columns: What every row has.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    count = 0
    with replacing(path) as aside, aside.open("wb") as file:
        file.write(_header(0, columns))

        def write(rows: np.ndarray) -> None:
            nonlocal count
            count += len(rows)
            file.write(rows.data)

        yield write
        file.seek(0)
        file.write(_header(count, columns))


def load_cloud(path: Path) -> PointCloud:
    """Read a cloud that `save_cloud` wrote; columns may stand in any order.

    Raises:
        FormatError: The file is no such cloud; a header that lies about the number of points costs
            no memory.
        FileNotFoundError: There is no such file.
    """
    return PointCloud.concatenate(list(iterate_cloud(path)))


def iterate_cloud(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read a cloud that `save_cloud` wrote, some points at a time.

    Raises:
        FormatError: As for `load_cloud`, before the first points are given.
        FileNotFoundError: There is no such file.
    """
    with path.open("rb") as file:
        count, columns = _read_header(file, path)
        start = file.tell()
        there = path.stat().st_size - start
        if there != count * columns.itemsize:
            raise FormatError(
                f"{path} declares {count} points of {columns.itemsize} bytes but holds {there} "
                "bytes; it is cut off or damaged. Make it again with murkscan cloud."
            )
        for begin in range(0, count, block):
            rows = np.fromfile(file, columns, min(block, count - begin))
            yield from_columns({name: rows[name] for name in columns.names or ()})


def _header(count: int, columns: np.dtype[np.void]) -> bytes:
    # The comment makes room, so that the number of points may be written last.
    room = " " * (_DIGITS - len(str(count)))
    lines = ["ply", _FORMAT, f"comment murkscan: metres{room}", f"element vertex {count}"]
    lines += [f"property {_TYPES[columns[name].str]} {name}" for name in columns.names or ()]
    return "\n".join([*lines, "end_header", ""]).encode("ascii")


def _read_header(file: BinaryIO, path: Path) -> tuple[int, np.dtype[np.void]]:
    """Read up to the first point: the number of points, and the columns as they stand."""
    if file.readline(_LONGEST_LINE).rstrip() != b"ply":
        raise FormatError(f"{path} is not a PLY file.")
    count, names = -1, list[str]()
    for _ in range(_LONGEST_HEADER):
        line = file.readline(_LONGEST_LINE).decode("ascii", "replace").rstrip()
        words = line.split()
        if line == "end_header":
            _require_columns(names, count, path)
            return count, np.dtype([(name, COLUMNS[name]) for name in names])
        if words[:2] == ["element", "vertex"] and words[2:3] and words[2].isdecimal() and count < 0:
            count = int(words[2])
        elif words[:1] == ["property"] and count >= 0:
            names.append(_known_column(words, path))
        elif line != _FORMAT and words[:1] not in (["comment"], ["obj_info"]):
            raise FormatError(f"{path} has the line {line[:60]!r}, which no murkscan cloud has.")
    raise FormatError(f"{path} is a PLY file without an end to its header.")


def _known_column(words: list[str], path: Path) -> str:
    name = words[-1]
    if name not in (COLUMNS.names or ()) or words[1:] != [_TYPES[COLUMNS[name].str], name]:
        raise FormatError(f"{path} has the unknown column {' '.join(words[1:])[:60]!r}.")
    return name


def _require_columns(names: list[str], count: int, path: Path) -> None:
    missing = [name for name in COLUMNS.names or () if name not in (*names, *ADDED)]
    if missing or count < 0 or len(set(names)) < len(names):
        raise FormatError(
            f"{path} lacks the column {missing[0]!r}."
            if missing
            else f"{path} has columns twice, or no points declared."
        )
