"""A recording kept as a folder of pictures."""

import re
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import final

from ..errors import FormatError
from ..io.images import NOT_READ, read_image
from ..types.arrays import Image
from ..types.frame import Frame
from .base import AbstractRecording, Skip, fingerprint_files, ignore_skip, spread_evenly
from .colour import AbstractColour
from .fields import split_fields

_SUFFIXES = (
    *(".bmp", ".dib", ".jp2", ".jpe", ".jpeg", ".jpg", ".pbm", ".pgm", ".png", ".pnm", ".ppm"),
    *(".tif", ".tiff", ".webp"),
)
TIMES = "times.csv"
"""Name of the file that may tell the pictures' times."""


def is_picture(path: Path) -> bool:
    """Tell by its name whether a file is a picture; hidden ones are not meant."""
    return path.suffix.lower() in _SUFFIXES and not path.name.startswith(".")


def natural_key(name: str) -> tuple[list[tuple[int, str]], str]:
    """Sort by this for the order that people expect: frame2 before frame10."""
    parts = re.split(r"([0-9]+)", name.casefold())
    return [(int(part), "") if i % 2 else (0, part) for i, part in enumerate(parts)], name


def list_pictures(path: Path) -> tuple[str, ...]:
    """List the names of a folder's pictures in natural order; other files are passed over.

    Pictures of kinds that are not read are listed as well, so that each keeps its place; but not
    where a readable one of the same name lies beside it, as cameras write both.

    Raises:
        FormatError: There is none that is read.
    """
    there = [file for file in path.iterdir() if file.is_file() and file.name[:1] != "."]
    files = [file for file in there if is_picture(file)]
    names = {file.stem for file in files}
    others = [file for file in there if file.suffix.lower() in NOT_READ]
    if files:
        files += [file for file in others if file.stem not in names]
    if not files:
        kinds = ", ".join(sorted({file.suffix for file in others}))
        if others:
            raise FormatError(
                f"The {len(others)} pictures in {path} are of a kind that is not read ({kinds}); "
                "convert them to PNG or TIFF, without another size or other tones."
            )
        raise FormatError(
            f"The folder {path} holds no pictures ({', '.join(_SUFFIXES)}). Give the "
            "folder they lie in, or a video file itself."
        )
    return tuple(sorted((file.name for file in files), key=natural_key))


@final
@dataclass(frozen=True)
class ImageFolder(AbstractRecording):
    """A folder of pictures in natural order. `open_recording` makes it."""

    files: tuple[str, ...]
    """Name of each picture's file."""
    pages: tuple[int, ...]
    """Number of each picture in its file: a TIFF may have several pages."""
    times: tuple[float, ...]
    """Time of each picture [s], increasing, or its number where it has none."""
    spacing: float
    """Usual time between two pictures [s]; 1 where they have no times."""
    colour: AbstractColour
    """How colours become grey levels."""

    @property
    def starts_anywhere(self) -> bool:
        """Tell whether reading can start at any frame; see the base."""
        return True

    @property
    def span(self) -> tuple[float, float]:
        """Give the times of the first and of the last picture [s]."""
        return self.times[0], self.times[-1]

    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; see the base."""
        each = self.fields_per_picture
        for picture in range(start // each, len(self.files)):
            first = max(picture * each, start)
            try:
                image = self._read(picture)
            except FormatError as error:
                on_skip(Skip(first, str(error), (picture + 1) * each - first))
                continue
            yield from (frame for frame in self._split(image, picture) if frame.index >= start)

    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording; see the base."""
        frames: list[Frame] = []
        wanted = spread_evenly(len(self.files), count)
        with ThreadPoolExecutor() as pool:
            reads = [pool.submit(self._read, picture) for picture in wanted]
            for picture, read in zip(wanted, reads, strict=True):
                try:
                    image = read.result()
                except FormatError:
                    continue
                fields = self._split(image, picture)
                frames.append(fields[len(frames) % len(fields)])
        frames = frames or list(islice(self.frames(), count))
        if not frames:
            raise FormatError(f"None of the {len(self.files)} pictures in {self.path} can be read.")
        return frames

    def in_colour(self, colour: AbstractColour, *remarks: str) -> AbstractRecording:
        """Give the same recording with other grey levels; see the base."""
        return replace(self, colour=colour, remarks=(*self.remarks, *remarks))

    def fingerprint(self) -> str:
        """Give a text that changes when the recording's frames or their times would."""
        reading = (self.order, self.is_timed, self.times, self.colour)
        names = dict.fromkeys(self.files)
        return fingerprint_files([locate(self.path, name) for name in names], reading)

    def _read(self, picture: int) -> Image:
        file = locate(self.path, self.files[picture])
        return read_grey(file, self.colour, self.pages[picture])

    def _split(self, image: Image, picture: int) -> list[Frame]:
        height, width = len(image), image.shape[1] // self.colour.channels
        if (width, height) != self.size:
            raise FormatError(
                f"{locate(self.path, self.files[picture])} is {width} x {height} px, but the "
                f"recording is {self.size[0]} x {self.size[1]} px; remove it or sort the "
                "recordings apart."
            )
        return split_fields(
            image,
            picture=picture,
            time=self.times[picture],
            period=self._period(picture),
            order=self.order,
        )

    def _period(self, picture: int) -> float:
        """Give the time that a picture's fields share [s]: the usual one, or up to the next."""
        if picture + 1 == len(self.times):
            return self.spacing
        return min(self.times[picture + 1] - self.times[picture], self.spacing)


def locate(path: Path, name: str) -> Path:
    """Give the file of a picture: in a folder, or the recording's only file itself."""
    return path if path.name == name and path.is_file() else path / name


def read_grey(path: Path, colour: AbstractColour, page: int = 0) -> Image:
    """Read a picture as grey levels, 8 or 16 bit.

    Raises:
        FormatError: The file is no picture, or a broken one.
    """
    try:
        image = read_image(path, page)
    except OSError as error:
        raise FormatError(f"{path} cannot be read: {error.strerror or error}.") from error
    return colour.grey(image)
