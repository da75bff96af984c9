"""Photos of a board, in colour, from a folder or out of a video; read as often as needed."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import FormatError, InputError
from ..io.images import read_colour
from ..types.arrays import ColourImage, Image
from .container import open_video
from .decode import Loss, decode_pictures
from .folder import list_pictures

_MAX_FROM_VIDEO = 100
"""Pictures taken out of a video, spread over it; neighbouring ones show the same."""
_UNREAD = (".heic", ".heif", ".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".orf")
"""Kinds of pictures that cameras and phones write and that are not read."""


@dataclass(frozen=True, eq=False)
class Photo:
    """One photo."""

    name: str
    """Name of its file, or its number in the video."""
    image: ColourImage
    """What it shows."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [px]."""
        height, width = self.image.shape[:2]
        return width, height

    def as_grey(self) -> Image:
        """Give its brightness, in which the board is looked for."""
        weights = np.array([0.299, 0.587, 0.114], np.float32)
        return np.rint(self.image.astype(np.float32) @ weights).astype(np.uint8)


@dataclass(eq=False)
class BoardPhotos:
    """The photos of a folder, or pictures spread over a video."""

    path: Path
    """The folder or the video."""
    num_photos: int | None = None
    """How many photos there are, for a progress bar; None where the video does not say."""
    skipped: dict[str, str] = field(default_factory=dict)
    """Photos that cannot be read, and why; filled while reading."""

    @classmethod
    def open(cls, path: Path) -> "BoardPhotos":
        """Look what is there.

        Raises:
            InputError: There is no such folder or file.
            FormatError: The folder holds no pictures.
        """
        if not path.exists():
            raise InputError(f"There is no folder or video {path}; give the one with the photos.")
        if path.is_dir():
            return cls(path, len(list_pictures(path)))
        return cls(path)

    def __iter__(self) -> Iterator[Photo]:
        """Read the photos in order; those that cannot be read are noted and passed over.

        Raises:
            FormatError: None of them can be read.
        """
        is_empty = True
        for photo in self._read_folder() if self.path.is_dir() else self._read_video():
            is_empty = False
            yield photo
        if is_empty:
            raise FormatError(
                f"None of the {self.num_photos or 0} photos in {self.path} can be read; the first: "
                f"{next(iter(self.skipped.values()), 'it holds no pictures')}"
            )

    def _read_folder(self) -> Iterator[Photo]:
        for file in sorted(self.path.iterdir()):
            if file.suffix.lower() in _UNREAD:
                self.skipped[file.name] = (
                    f"is of a kind that is not read ({file.suffix}): export PNG"
                )
        for name in list_pictures(self.path):
            try:
                yield Photo(name, read_colour(self.path / name))
            except (FormatError, OSError) as error:
                self.skipped[name] = str(error)

    def _read_video(self) -> Iterator[Photo]:
        with open_video(self.path) as container:
            step = max(1, container.streams.video[0].frames // _MAX_FROM_VIDEO)
            for item in decode_pictures(container):
                if isinstance(item, Loss):
                    self.skipped[f"{self.path.stem}_{item.first:06d}"] = (
                        f"{item.count} pictures of {self.path} cannot be decoded."
                    )
                elif item.number % step == 0:
                    image = item.decoded.to_ndarray(format="rgb24")
                    yield Photo(f"{self.path.stem}_{item.number:06d}", image)
