"""Bands of paint with sharp edges."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from ...errors import InputError
from ...types.arrays import Points, Scalars
from .base import AbstractTexture, check_albedos


@final
@dataclass(frozen=True)
class Bands(AbstractTexture):
    """Bands that follow one another along an axis, and begin again after the last.

    The first band begins at the origin and goes along + axis.
    """

    albedos: tuple[float, ...] = (0.05, 0.4)
    """Albedo of each band."""
    widths: tuple[float, ...] = (0.05, 0.05)
    """Width of each band along the axis [m]."""
    axis: str = "y"
    """The axis of the object along which they follow one another: x, y or z."""

    def __post_init__(self) -> None:
        """Refuse a single band, and bands without width."""
        if not 2 <= len(self.albedos) == len(self.widths):
            raise InputError(
                f"Bands need two albedos or more and a width for each, got "
                f"{len(self.albedos)} albedos and {len(self.widths)} widths."
            )
        if not all(math.isfinite(width) and width > 0 for width in self.widths):
            raise InputError(
                f"Each band needs a width above 0 m, got widths = {list(self.widths)} m."
            )
        if self.axis not in ("x", "y", "z"):
            raise InputError(f"Bands follow one another along x, y or z, got axis = {self.axis!r}.")
        for albedo in self.albedos:
            check_albedos("Each band", albedos=albedo)

    def albedo(self, points: Points) -> Scalars:
        """Give each point the albedo of its band; an edge belongs to the band that begins there."""
        ends = np.cumsum(self.widths)
        place = points[:, "xyz".index(self.axis)] % ends[-1]
        # Rounding may put a place just before the origin at the very end.
        band = np.minimum(np.searchsorted(ends, place, side="right"), len(ends) - 1)
        return np.array(self.albedos, float)[band]
