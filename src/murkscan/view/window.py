"""Where the surface lies in the picture, and what each of its pixels shows."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float32, Int, Int32

from ..errors import InputError
from ..types.arrays import Mask, Normals, Points, Vector

Depths = Float32[np.ndarray, "h w"]
Owners = Int32[np.ndarray, "h w"]
Cells = Int[np.ndarray, "n 2"]

SAMPLES = 2
"""Samples a pixel along each side."""
_SIDE, _TOP, _BOTTOM, _BAR = 0.04, 0.08, 0.15, 0.16
"""Shares of the picture kept free for the writing: at the sides, and on the right for a colour
bar."""


@dataclass(frozen=True)
class Window:
    """Maps the view frame [m] to samples of the picture."""

    size: tuple[int, int]
    """Width and height of the picture [px]."""
    scale: float
    """Samples a metre."""
    centre: tuple[float, float]
    """The sample that shows the origin of the view frame, u and v."""

    @classmethod
    def around(cls, points: Points, size: tuple[int, int], *, with_bar: bool) -> "Window":
        """Fit points into the part of the picture that the writing leaves free.

        Args:
            points: Points in the view frame [m], at least one.
            size: Width and height of the picture [px].
            with_bar: Whether a colour bar stands on the right.

        Raises:
            InputError: The picture is too small to be one.
        """
        width, height = size
        if min(size) < 64:
            raise InputError(f"A picture needs at least 64 x 64 pixels, got {width} x {height}.")
        right = _BAR if with_bar else _SIDE
        free = np.array([width * (1 - _SIDE - right), height * (1 - _TOP - _BOTTOM)]) * SAMPLES
        start = np.array([width * _SIDE, height * _TOP]) * SAMPLES
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        scale = float(np.min(free / np.maximum(high - low, 1e-9)))
        u, v = start + free / 2 - scale * (low + high) / 2
        return cls(size, scale, (float(u), float(v)))

    def centred_on(self, point: Vector) -> "Window":
        """Show a point of the view frame [m] where the view frame's origin is shown now."""
        u, v = self.centre
        return replace(self, centre=(u - self.scale * point[0], v - self.scale * point[1]))

    def as_samples(self, points: Points) -> Points:
        """Give points of the view frame [m] as samples u, v and depth in the same unit."""
        return points * self.scale + np.array([*self.centre, 0.0])

    def empty_buffers(self, points: Points) -> tuple[Depths, Owners, float]:
        """Make a picture's depths and owners before anything is seen, and where depth starts.

        Args:
            points: What will be seen, in samples, with its depth.
        """
        width, height = self.num_samples
        depth = np.full((height, width), np.inf, np.float32)
        return depth, np.zeros((height, width), np.int32), float(np.floor(points[:, 2].min()))

    @property
    def num_samples(self) -> tuple[int, int]:
        """Width and height in samples."""
        return self.size[0] * SAMPLES, self.size[1] * SAMPLES


@dataclass(frozen=True, eq=False)
class Relief:
    """What the samples of a picture show, in the view frame."""

    depth: Depths
    """Depth [samples] beyond the start; inf where there is nothing."""
    start: float
    """Depth of what is nearest to the viewer [samples]: single precision counts from there."""
    seen: Cells
    """Row and column of each sample that shows something."""
    normals: Normals
    """Unit normals of those, turned to the viewer."""
    outside: Mask
    """Whether the viewer looks there at the side that the camera saw."""
