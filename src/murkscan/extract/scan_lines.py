"""A frame seen along its scan lines: each is a column, whichever way the stripe runs."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Shaped

from ..types.arrays import Indices, Pixels, Scalars
from ..types.background import FixedPattern, Noise
from ..types.frame import Frame
from ..types.laser import Axis
from .round_spots import find_round_spots
from .row_noise import without_rows


@dataclass(frozen=True, eq=False)
class ScanLines:
    """Grey levels with a scan line in each column, of pixels that may be averaged along it."""

    frame: Frame
    axis: Axis
    """The camera's axis along which the laser sits; for y, scan lines are image columns."""
    levels: Shaped[np.ndarray, "length lines"]
    """Grey levels as recorded."""
    signal: Shaped[np.ndarray, "length lines"]
    """The same without what is fixed to the picture."""
    white: float
    """Level from which a pixel is saturated."""
    hidden: Bool[np.ndarray, "_ lines"] | None = None
    """Pixels of the frame's image that show nothing of the scene."""
    binning: int = 1
    """Pixels of the image in one of these."""
    slope: float = 0.0
    """Full-frame pixels by which an even wall's stripe moves along scan lines over one across."""

    @classmethod
    def of(
        cls,
        frame: Frame,
        axis: Axis,
        *,
        noise: Noise,
        fixed: Sequence[FixedPattern] = (),
        slope: float = 0.0,
    ) -> "ScanLines":
        """Look at a frame along its scan lines.

        Args:
            frame: The frame.
            axis: The camera's axis along which the laser sits.
            noise: Of a pixel; its rows' noise is taken away where it lies across scan lines.
            fixed: What is fixed to the picture, of all kinds of fields.
            slope: Of an even wall's stripe; see `sheets.expected_slope`.
        """
        image = frame.image if axis == "y" else frame.image.T
        levels = signal = np.ascontiguousarray(image)
        hidden = None
        for one in fixed:
            if one.first_row == frame.first_row and one.levels.shape == frame.image.shape:
                own = one if axis == "y" else one.transposed
                signal, hidden = levels - own.levels, own.overlay
        stretch = float(frame.row_step) if axis == "y" else 1.0 / frame.row_step
        spots = find_round_spots(levels, noise.white, stretch)
        if spots is not None:
            hidden = spots if hidden is None else hidden | spots
        if noise.rows and axis == "y":
            signal = without_rows(signal, noise)
        return cls(frame, axis, levels, signal, noise.white, hidden, slope=slope)

    @classmethod
    def bare(cls, frame: Frame, axis: Axis, *, slope: float = 0.0) -> "ScanLines":
        """Look at a frame as it was recorded, holding no picture but its own."""
        levels = frame.image if axis == "y" else frame.image.T
        return cls(frame, axis, levels, levels, math.inf, slope=slope)

    def binned(self, binning: int) -> "ScanLines":
        """Average pixels along scan lines; what is left over at their ends is left out.

        An average that has a saturated pixel is saturated.
        """
        if binning == self.binning:
            return self
        length = len(self.levels) // binning
        groups, signal = (
            each[: length * binning].reshape(length, binning, -1)
            for each in (self.levels, self.signal)
        )
        is_white = (groups >= self.white).any(axis=1)
        levels = np.where(is_white, np.float32(self.white), groups.mean(axis=1, dtype=np.float32))
        mean = signal.mean(axis=1, dtype=np.float32) if self.has_fixed else levels
        return replace(self, levels=levels, signal=mean, binning=binning)

    @property
    def has_fixed(self) -> bool:
        """Tell whether something fixed to the picture has been taken away."""
        return self.signal is not self.levels

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

    def even_wall(self, lines: Scalars) -> Scalars:
        """Give how far an even wall's stripe has moved since scan line 0 [full-frame px]."""
        return self.slope * self.line_step * lines

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

    def full_frame_lines(self, lines: Scalars) -> Scalars:
        """Give scan lines in pixels of the full frame."""
        return lines if self.axis == "y" else self.frame.as_full_rows(lines)

    def from_image(self, positions: Scalars) -> Scalars:
        """Compute positions in these pixels from those in the frame's image."""
        return (positions - 0.5 * (self.binning - 1)) / self.binning

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
