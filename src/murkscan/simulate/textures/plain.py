"""One albedo everywhere."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ...types.arrays import Points, Scalars
from .base import AbstractTexture, check_albedos


@final
@dataclass(frozen=True)
class Plain(AbstractTexture):
    """Paint of one albedo."""

    share: float = 0.1
    """Share of the light that it throws back."""

    def __post_init__(self) -> None:
        """Refuse an albedo that is no share."""
        check_albedos("Plain paint", share=self.share)

    def albedo(self, points: Points) -> Scalars:
        """Give the same to all points."""
        return np.full(len(points), float(self.share))
