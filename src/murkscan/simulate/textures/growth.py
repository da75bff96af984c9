"""Patches of marine growth."""

import math
from dataclasses import dataclass
from functools import cached_property
from statistics import NormalDist
from typing import final

import numpy as np
from scipy.spatial.transform import Rotation

from ..._kernels.value_noise import value_noise
from ...errors import InputError
from ...types.arrays import Points, Scalars
from ..shapes.base import check_sizes
from .base import AbstractTexture, check_albedos

_TABLE = 1024
"""Cells after which a grid repeats itself."""
_SPREAD = math.sqrt((2 * 181 / 462) ** 3 / 12)
"""Standard deviation of one grid's field: its corners are even between 0 and 1, and 181 / 462 is
the mean square of the blending 6 t⁵ - 15 t⁴ + 10 t³."""
_EDGE = 2.0
"""How wide the way from bare to grown is, in standard deviations of the field."""
_TURN = np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
"""Axis about which each grid is turned against the one before, by a radian: lest a pattern of
squares shows."""


@final
@dataclass(frozen=True)
class Growth(AbstractTexture):
    """Dark growth in patches on lighter paint, the same for the same seed on every machine.

    A random field of a few octaves, each half as coarse and half as strong as the one before, is
    cut where the wanted share of a large surface is covered. It holds no detail finer than
    `size` / 2^octaves.
    """

    dark: float = 0.03
    """Albedo of thick growth."""
    light: float = 0.11
    """Albedo of the bare paint."""
    size: float = 0.06
    """Side of the coarsest grid's cells [m]: about the width of a patch."""
    cover: float = 0.5
    """Share of a large surface that is more grown than bare, above 0 and below 1; met to 0.02."""
    octaves: int = 4
    """How many grids are added up, 1 to 8."""
    seed: int = 0
    """Where the patches are; not negative."""

    def __post_init__(self) -> None:
        """Refuse albedos, shares and numbers that cannot be."""
        check_albedos("Growth", dark=self.dark, light=self.light)
        check_sizes("Growth", size=self.size)
        if self.dark > self.light:
            raise InputError(
                f"Growth is darker than its paint, got dark = {self.dark:g} and "
                f"light = {self.light:g}; exchange them and take 1 - cover."
            )
        if not 0 < self.cover < 1:
            raise InputError(f"Growth needs a cover above 0 and below 1, got {self.cover:g}.")
        if not (1 <= self.octaves <= 8 and self.seed >= 0):
            raise InputError(
                f"Growth needs 1 to 8 octaves and a seed of 0 or more, got octaves = "
                f"{self.octaves} and seed = {self.seed}."
            )

    def albedo(self, points: Points) -> Scalars:
        """Give the albedo between `dark` and `light`; it has no steps."""
        weights = 0.5 ** np.arange(self.octaves)
        weights /= weights.sum()
        field = value_noise(np.ascontiguousarray(points), *self._grids, weights, *self._tables)
        spread = _SPREAD * math.sqrt(weights @ weights)
        # A sum of several grids is close to normal; of a single one the cover is less exact.
        cut = 0.5 + spread * NormalDist().inv_cdf(1 - self.cover)
        grown = np.clip((field - cut) / (_EDGE * spread) + 0.5, 0, 1)
        return self.light - (self.light - self.dark) * (grown * grown * (3 - 2 * grown))

    @cached_property
    def _grids(self) -> tuple[np.ndarray, np.ndarray]:
        """Give each octave's grid: axes in cells a metre, and shift in cells."""
        number = np.arange(self.octaves)
        turns = Rotation.from_rotvec((number[:, None] + 1.0) * _TURN).as_matrix()
        shifts = self._draw(3 * self.octaves).reshape(-1, 3) * _TABLE
        return turns * (2.0**number / self.size)[:, None, None], shifts

    @cached_property
    def _tables(self) -> tuple[np.ndarray, np.ndarray]:
        """Give the permutation, and the values at the corners."""
        first, second = self._draw(2 * _TABLE).reshape(2, -1)
        return np.argsort(first), (np.argsort(second) + 0.5) / _TABLE

    def _draw(self, count: int) -> Scalars:
        """Draw from 0 to 1. The bits themselves stay the same from version to version of NumPy."""
        return np.random.PCG64(self.seed).random_raw(count) / 2.0**64
