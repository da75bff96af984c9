"""Points outside of the volume that is wanted: the wall behind a turntable, the sea floor."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from ..types.arrays import Mask
from .base import AbstractOutlierRule, SeenCloud

Place = tuple[float, float, float]


@final
@dataclass(frozen=True)
class Outside(AbstractOutlierRule):
    """Points outside of a box along the world's axes.

    It is asked before the rules that look at neighbours: a wall that stands still before a
    turntable is no surface in the turning object's frame, and must not count as one.
    """

    low: Place
    """The corner with the smallest coordinates [m]."""
    high: Place
    """The corner with the largest ones [m]."""

    def __post_init__(self) -> None:
        """Refuse a box without size."""
        if not all(low < high for low, high in zip(self.low, self.high, strict=True)):
            raise InputError(
                f"The corners of a volume must differ in x, y and z; got {self.low} and "
                f"{self.high} m."
            )

    @property
    def cause(self) -> str:
        """See `AbstractOutlierRule.cause`."""
        return "volume"

    def find(self, seen: SeenCloud) -> Mask:
        """See `AbstractOutlierRule.find`."""
        points = seen.cloud.points
        return ~np.all((points >= self.low) & (points <= self.high), axis=1)
