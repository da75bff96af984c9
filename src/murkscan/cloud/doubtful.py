"""Points that their finder itself hardly believes."""

from dataclasses import dataclass
from typing import final

from ..errors import InputError
from ..types.arrays import Mask
from .base import AbstractOutlierRule, SeenCloud


@final
@dataclass(frozen=True)
class Doubtful(AbstractOutlierRule):
    """Points less probable to be the surface than not to be. Finders without posterior say 1."""

    min_posterior: float = 0.5
    """Probability below which a point goes; 0 lets all stay."""

    def __post_init__(self) -> None:
        """Refuse what is no probability."""
        if not 0 <= self.min_posterior <= 1:
            raise InputError(f"min_posterior must lie from 0 to 1, got {self.min_posterior:g}.")

    @property
    def cause(self) -> str:
        """See `AbstractOutlierRule.cause`."""
        return "posterior"

    def find(self, seen: SeenCloud) -> Mask:
        """See `AbstractOutlierRule.find`; a point without a number stays."""
        return seen.cloud.posterior < self.min_posterior
