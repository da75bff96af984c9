"""From a folder of pictures, or the pages of a TIFF, to a recording."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..errors import FormatError, InputError
from ..io.clock_times import TICKS, UNIX, guess_unit
from ..io.images import NOT_READ
from ..io.picture_notes import count_pages, find_turn
from ..io.times_csv import read_times
from ..types.arrays import Image
from .base import spread_evenly
from .clock import usual_spacing
from .colour import AbstractColour
from .field_order import RUN, Fields, decide_order, say_order
from .folder import TIMES, ImageFolder, list_pictures, locate, read_grey

_PAGED = (".tif", ".tiff")
_DEEP = 1 << 14
"""Grey levels below which a camera of 10, 12 or 14 bits has written into 16."""
_CLOCK = re.compile(r"\d{10,19}(\.\d+)?")
"""A time since 1970 in a picture's name: seconds, or one of the smaller units."""


def open_folder(
    path: Path, colour: AbstractColour, fps: float | None, fields: Fields
) -> ImageFolder:
    """Open a folder of pictures, or a TIFF of several pages; see `open_recording`."""
    names = list_pictures(path) if path.is_dir() else (path.name,)
    files, pages = _turn_pages(path, names)
    times, clock = _find_times(path, files, pages, fps)
    read = list(zip(files, pages, strict=True))
    first = _first_image(path, read, colour)
    height, width = first.shape
    order = decide_order(fields, lambda count: _runs(path, read, colour, count))
    return ImageFolder(
        path=path,
        size=(width, height),
        order=order,
        is_timed=bool(clock) or fps is not None,
        num_frames=len(files) * (1 if order == "progressive" else 2),
        remarks=(
            *say_order(order, fields),
            *_say_odd(path, names, files),
            *_say_bits(first),
            *clock[1:],
        ),
        files=files,
        pages=pages,
        times=times,
        spacing=usual_spacing([times]) or 1 / (fps or 1.0),
        colour=colour,
    )


def _turn_pages(path: Path, names: Sequence[str]) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """List each page of each file."""
    counts = [
        count_pages(locate(path, name)) if name.lower().endswith(_PAGED) else 1 for name in names
    ]
    listed = [
        (name, page) for name, count in zip(names, counts, strict=True) for page in range(count)
    ]
    return tuple(name for name, _ in listed), tuple(page for _, page in listed)


def _find_times(
    path: Path, files: Sequence[str], pages: Sequence[int], fps: float | None
) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Give the times [s], and where they are from; from nowhere where they are but numbers."""
    if path.is_dir() and (path / TIMES).exists():
        if fps is not None:
            raise InputError(
                f"{path / TIMES} gives the times of the pictures, so {fps:g} pictures a second "
                "cannot hold as well; leave that out, or remove the file."
            )
        if any(pages):
            raise FormatError(
                f"{path / TIMES} gives one time a file, but a TIFF has several pages; remove it "
                "and give the pictures a second."
            )
        return read_times(path / TIMES, files), (TIMES,)
    named = None if fps is not None else _times_in_names(files)
    if named is not None:
        return named, ("names", "the times of its pictures are taken from their names")
    return tuple(float(number) for number in np.arange(len(files)) / (fps or 1.0)), ()


def _times_in_names(files: Sequence[str]) -> tuple[float, ...] | None:
    """Read times since 1970 out of names, as many loggers write them; None where there are none."""
    found = [_CLOCK.search(Path(name).stem) for name in files]
    if len(files) < 2 or not all(found):
        return None
    ticks = np.array([float(one[0]) for one in found if one])
    times = ticks / TICKS[guess_unit(ticks)]
    is_clock = (times > UNIX).all() and (np.diff(times) > 0).all()
    return tuple(times.tolist()) if is_clock else None


def _say_odd(path: Path, names: Sequence[str], files: Sequence[str]) -> tuple[str, ...]:
    odd = [name for name in names if Path(name).suffix.lower() in NOT_READ]
    said = []
    if odd:
        kinds = ", ".join(sorted({Path(name).suffix for name in odd}))
        said.append(
            f"{len(odd)} of its {len(files)} pictures are of a kind that is not read ({kinds}); "
            "each keeps its number, but gives no frame"
        )
    if len(files) > len(names):
        said.append(f"its {len(names)} files have {len(files)} pages, each of them a picture")
    if turn := find_turn(locate(path, names[0])):
        said.append(
            f"a note asks to turn its pictures by {turn} degrees; they stay as they were recorded"
        )
    return tuple(said)


def _say_bits(image: Image) -> tuple[str, ...]:
    """Say so where a picture leaves the upper bits of its numbers empty."""
    top = int(image.max(initial=0))
    if image.dtype != np.uint16 or not 0 < top < _DEEP:
        return ()
    return (
        f"its pictures use {max(top.bit_length(), 8)} of 16 bits; grey levels stay as they are, "
        "not stretched",
    )


def _first_image(path: Path, read: Sequence[tuple[str, int]], colour: AbstractColour) -> Image:
    for name, page in read:
        try:
            return read_grey(locate(path, name), colour, page)
        except FormatError:
            continue
    raise FormatError(
        f"None of the {len(read)} pictures in {path} can be read; copy them anew from the camera."
    )


def _runs(
    path: Path, read: Sequence[tuple[str, int]], colour: AbstractColour, count: int
) -> Iterable[list[Image]]:
    """Read runs of pictures that follow one another, those of a run all of one size."""
    # Runs that share pictures would only seem to agree.
    apart = min(count, max(len(read) // RUN, 1))
    for start in spread_evenly(max(len(read) - RUN + 1, 1), apart):
        run: list[Image] = []
        for name, page in read[start : start + RUN]:
            try:
                image = read_grey(locate(path, name), colour, page)
            except FormatError:
                continue
            if not run or image.shape == run[0].shape:
                run.append(image)
        yield run
