"""How murky the water is, and how it scatters."""

from dataclasses import dataclass, field

from ..errors import InputError
from .phase import AbstractPhase
from .phase_petzold import PetzoldHarbour


@dataclass(frozen=True)
class Medium:
    """Water that absorbs and scatters light, the same everywhere."""

    attenuation: float
    """Beam attenuation c [1/m]; light that meets nothing falls by e over 1/c."""
    single_scattering_albedo: float = 0.83
    """Share b / c of the attenuation that is scattering; the rest is absorption."""
    phase: AbstractPhase = field(default_factory=PetzoldHarbour)
    """Where scattered light goes."""

    def __post_init__(self) -> None:
        """Refuse what no water does."""
        if not 0 <= self.attenuation <= 1000:
            raise InputError(
                "The attenuation of water must lie between 0 and 1000 per metre, got "
                f"{self.attenuation:g}."
            )
        if not 0 <= self.single_scattering_albedo <= 1:
            raise InputError(
                "The single scattering albedo of water must lie between 0 and 1, got "
                f"{self.single_scattering_albedo:g}."
            )

    @property
    def scattering(self) -> float:
        """Scattering coefficient b [1/m]."""
        return self.attenuation * self.single_scattering_albedo

    @property
    def absorption(self) -> float:
        """Absorption coefficient a [1/m]."""
        return self.attenuation - self.scattering
