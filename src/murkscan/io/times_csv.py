"""times.csv: when each picture of a folder was taken."""

import csv
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from ..errors import FormatError
from .atomic import replacing

_HEADER = ["file", "time_s"]


def read_times(path: Path, files: Sequence[str]) -> tuple[float, ...]:
    """Read the time of every picture.

    Args:
        path: The file, with the header file,time_s.
        files: Names of the folder's pictures, in order.

    Returns:
        One time for each picture, in the order of the pictures [s].

    Raises:
        FormatError: A line is no file and time, names a file that is not there or that it named
            before, a picture has no line, or times do not increase.
    """
    try:
        rows = list(csv.reader(path.read_text("utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise FormatError(f"{path} cannot be read; save it as CSV in UTF-8.") from error
    if not rows or [cell.strip() for cell in rows[0]] != _HEADER:
        raise FormatError(f"{path} line 1 must be the header {','.join(_HEADER)}.")
    lines: dict[str, tuple[int, float]] = {}
    known = set(files)
    for line, row in enumerate(rows[1:], start=2):
        if row:
            name, time = _parse(path, line, row)
            if name not in known:
                raise FormatError(f"{path} line {line}: there is no picture {name} beside it.")
            if name in lines:
                raise FormatError(
                    f"{path} line {line}: {name} has a time in line {lines[name][0]}."
                )
            lines[name] = (line, time)
    return _order(path, lines, files)


def _parse(path: Path, line: int, row: list[str]) -> tuple[str, float]:
    try:
        name, text = row
        time = float(text)
    except ValueError:
        time = math.nan
    if not math.isfinite(time):
        raise FormatError(
            f"{path} line {line}: '{','.join(row)}' is not a file name and a time in seconds."
        )
    return name.strip(), time


def _order(
    path: Path, lines: dict[str, tuple[int, float]], files: Sequence[str]
) -> tuple[float, ...]:
    """Give the times in the order of the pictures, increasing."""
    for name in files:
        if name not in lines:
            raise FormatError(
                f"{path} has no line for the picture {name}; add its time, or remove the picture."
            )
    for before, name in pairwise(files):
        line, time = lines[name]
        if time <= lines[before][1]:
            raise FormatError(
                f"{path} line {line}: {name} at {time:g} s comes after {before} at "
                f"{lines[before][1]:g} s in natural order, so its time must be later."
            )
    return tuple(lines[name][1] for name in files)


def write_times(path: Path, times: dict[str, float]) -> None:
    """Write the time of every picture [s] by its name.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, aside.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_HEADER)
        writer.writerows((name, repr(float(time))) for name, time in times.items())
