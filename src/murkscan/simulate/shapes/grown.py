"""A plate that bends like a hull and is grown over: what tells one place from another."""

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.ndimage import gaussian_filter

from ...errors import InputError
from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes

_PITCH = 1 / 4
"""Distance of vertices, in the size of the bumps: a Gaussian field has no finer detail."""
_MOST = 4_000_000
"""Vertices of a plate, at most."""


@final
@dataclass(frozen=True)
class Grown(AbstractShape):
    """A plate in z = 0 that faces the camera, bent about y, with bumps; its middle is the origin.

    The bumps are a Gaussian random field. Marine growth of a year stands out by about a millimetre
    and goes together over one or two centimetres.
    """

    width: float = 0.8
    """Along x [m]."""
    height: float = 1.5
    """Along y [m]."""
    bump: float = 1e-3
    """Standard deviation of the bumps [m]."""
    size: float = 12e-3
    """How far a bump goes together with itself, 1σ [m]."""
    radius: float = 5.0
    """Of the bend about y; the middle lies nearest to the camera [m]."""
    pattern: int = 0
    """Which of all plates."""

    def __post_init__(self) -> None:
        """Refuse a plate without area or bumps, and one of too many vertices."""
        check_sizes("A grown plate", width=self.width, height=self.height, bump=self.bump,
                    size=self.size, radius=self.radius)  # fmt: skip
        count = self.width * self.height / (_PITCH * self.size) ** 2
        if count > _MOST or self.pattern < 0:
            raise InputError(
                f"A grown plate of {self.width:g} × {self.height:g} m with bumps of {self.size:g} "
                f"m has {count:.3g} vertices, more than {_MOST:,}; or its pattern, "
                f"{self.pattern}, is below 0."
            )

    def mesh(self) -> Mesh:
        """Make triangles between the vertices of a grid, without a back."""
        pitch = _PITCH * self.size
        columns, rows = (max(round(side / pitch), 2) + 1 for side in (self.width, self.height))
        x = np.linspace(-self.width / 2, self.width / 2, columns)
        y = np.linspace(-self.height / 2, self.height / 2, rows)
        random = np.random.default_rng(self.pattern)
        field = gaussian_filter(random.normal(size=(rows, columns)), self.size / pitch)
        across, along = np.meshgrid(x, y)
        depth = across**2 / (2 * self.radius) - self.bump * field / field.std()
        number = np.arange(depth.size).reshape(depth.shape)
        a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
        corners = np.stack([np.stack([a, c, b], -1), np.stack([b, c, d], -1)])
        return Mesh(np.stack([across, along, depth], -1).reshape(-1, 3), corners.reshape(-1, 3))
