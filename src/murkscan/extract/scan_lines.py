"""A frame seen along its scan lines: each is a column, whichever way the stripe runs."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from ..types.arrays import Indices, Pixels, Scalars
from ..types.frame import Frame
from ..types.laser import Axis


@dataclass(frozen=True, eq=False)
class ScanLines:
    """Grey levels with a scan line in each column, of pixels that may be averaged along it."""

    frame: Frame
    axis: Axis
    """The camera's axis along which the laser sits; for y, scan lines are image columns."""
    levels: Shaped[np.ndarray, "length lines"]
    binning: int
    """Pixels of the image in one of these."""

    @classmethod
    def of(cls, frame: Frame, axis: Axis, *, binning: int, white: float) -> "ScanLines":
        """Look at a frame along its scan lines.

        Args:
            frame: The frame.
            axis: The camera's axis along which the laser sits.
            binning: Pixels to average; what is left over at the end of a line is left out.
            white: Level from which a pixel is saturated; so is an average that has one.
        """
        levels = np.ascontiguousarray(frame.image if axis == "y" else frame.image.T)
        if binning > 1:
            length = len(levels) // binning
            groups = levels[: length * binning].reshape(length, binning, -1)
            mean = groups.mean(axis=1, dtype=np.float32)
            levels = np.where((groups >= white).any(axis=1), np.float32(white), mean)
        return cls(frame, axis, levels, binning)

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.frame.index

    @property
    def num_lines(self) -> int:
        """Count the scan lines."""
        return self.levels.shape[1]

    @property
    def stretch(self) -> int:
        """Full-frame pixels in one of these, along a scan line."""
        return self.binning * (self.frame.row_step if self.axis == "y" else 1)

    @property
    def line_step(self) -> int:
        """Full-frame pixels from one scan line to the next."""
        return 1 if self.axis == "y" else self.frame.row_step

    def offset(self, other: "ScanLines") -> tuple[float, float]:
        """Give what must be added to another's (position, line) to be this one's.

        Nothing, but between fields of different rows.
        """
        rows = (other.frame.first_row - self.frame.first_row) / self.frame.row_step
        return (rows / self.binning, 0.0) if self.axis == "y" else (0.0, rows)

    def as_full_frame(self, positions: Scalars) -> Scalars:
        """Give positions along scan lines in pixels of the full frame."""
        along = self.binning * positions + 0.5 * (self.binning - 1)
        return self.frame.as_full_rows(along) if self.axis == "y" else along

    def from_full_frame(self, positions: Scalars) -> Scalars:
        """Give positions along scan lines, of the full frame, in pixels of the frame's image."""
        if self.axis == "x":
            return positions
        return (positions - self.frame.first_row) / self.frame.row_step

    def split(self, pixels: Pixels) -> tuple[Indices, Scalars]:
        """Give the scan lines, and the positions along them, of pixels of the full frame."""
        u, v = pixels.T
        if self.axis == "y":
            return np.rint(u).astype(int), v
        return np.rint((v - self.frame.first_row) / self.frame.row_step).astype(int), u

    def join(self, lines: Scalars, positions: Scalars) -> Pixels:
        """Give pixels of the full frame from scan lines and positions of the full frame."""
        if self.axis == "y":
            return np.stack([lines, positions], axis=1)
        return np.stack([positions, self.frame.as_full_rows(lines)], axis=1)
