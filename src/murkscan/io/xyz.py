"""Points as text, one a line: .xyz for every program, .csv with all columns."""

import codecs
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import chain, islice
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc

from ..errors import FormatError
from ..types.cloud import PointCloud
from .atomic import replacing
from .blocks import lines_at_once
from .cloud_columns import BLOCK, COLUMNS, as_rows, from_columns, known_name
from .xyz_layout import COMMENTS, HEAD, find_layout

_LONGEST_LINE = 4000
_UNIT = 1e-3
"""How far three numbers may be from unit length and still be a normal."""
_NAMES = [*(COLUMNS.names or ())]
_SIX = "%.7f %.7f %.7f %.6f %.6f %.6f"
_OPTIONS = pc.WriteOptions(include_header=False, quoting_style="none")


@contextmanager
def writing_xyz(path: Path) -> Iterator[Callable[[PointCloud], None]]:
    """Write positions [m] and normals, six numbers a line and nothing else: so all can read it.

    Positions have steps of 0.1 µm. Every number has its point: CloudCompare takes a whole one for
    the number of the point. The file appears whole when the context ends, or not at all.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, aside.open("wb") as file:

        def write(cloud: PointCloud) -> None:
            np.savetxt(file, np.concatenate([cloud.points, cloud.normals], axis=1), _SIX)

        yield write


@contextmanager
def writing_csv(path: Path) -> Iterator[Callable[[PointCloud], None]]:
    """Write all columns of cloud.ply parted by commas, below a line with their names.

    The file appears whole when the context ends, or not at all.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, aside.open("wb") as file:
        file.write((",".join(_NAMES) + "\n").encode("ascii"))

        def write(cloud: PointCloud) -> None:
            rows = as_rows(cloud)
            table = pa.table({name: np.ascontiguousarray(rows[name]) for name in _NAMES})
            pc.write_csv(table, file, _OPTIONS)

        yield write


def iterate_xyz(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read points from text: numbers parted by blanks, tabs, commas or semicolons.

    The first line may name the columns, also after # or //; one number alone on the line before the
    points is their count. Between semicolons, tabs or blanks a comma is the decimal sign. Without
    names the first three are x, y
    and z [m]; of six, the last three are the normal if they have unit length.

    Raises:
        FormatError: A line holds something other than as many numbers as the first.
        FileNotFoundError: There is no such file.
    """
    with path.open("rb") as file:
        rest = _lines(file, path)
        head = list(islice(rest, HEAD))
        layout = find_layout(head)
        names = list(layout.names)
        lines = (
            layout.as_numbers(line)
            for line in chain(head[layout.num_skipped :], rest)
            if not line.startswith(COMMENTS)
        )
        width = 0
        while some := lines_at_once(lines, block):
            values = _parse(some, path)
            width = width or values.shape[1]
            if values.shape[1] != width or width < 3 or (names and width != len(names)):
                raise FormatError(
                    f"{path} has lines of {values.shape[1]} numbers where "
                    f"{len(names) or max(width, 3)} are expected."
                )
            names = names or _guess(values)
            known = [
                (known_name(name), column) for name, column in zip(names, values.T, strict=True)
            ]
            columns = {name: column for name, column in known if name is not None}
            if not {"x", "y", "z"} <= columns.keys():
                raise FormatError(f"{path} names no columns x, y and z in its first line.")
            yield from_columns(columns)


def _lines(file: BinaryIO, path: Path) -> Iterator[str]:
    """Give the lines that are not empty."""
    if file.read(len(codecs.BOM_UTF8)) != codecs.BOM_UTF8:
        file.seek(0)
    while line := file.readline(_LONGEST_LINE):
        if len(line) == _LONGEST_LINE:
            raise FormatError(f"{path} has a line longer than {_LONGEST_LINE} bytes.")
        text = line.decode("ascii", "replace").strip()
        if text:
            yield text


def _guess(values: np.ndarray) -> list[str]:
    width = values.shape[1]
    names = ["x", "y", "z"] + [""] * (width - 3)
    length = np.linalg.norm(values[:, 3:6], axis=1)
    if width == 6 and np.mean(np.abs(length - 1) < _UNIT) > 0.5:
        names[3:] = ["nx", "ny", "nz"]
    return names


def _parse(lines: list[str], path: Path) -> np.ndarray:
    try:
        return np.loadtxt(lines, ndmin=2, comments=COMMENTS)
    except ValueError as error:
        raise FormatError(
            f"{path} cannot be read as columns of numbers: a line holds something else, or more or "
            "fewer of them than the first."
        ) from error
