"""The water at a site."""

from dataclasses import dataclass

from ..errors import InputError

_LIMITS = {
    "temperature_c": (-2.0, 40.0),
    "salinity_psu": (0.0, 45.0),
    "depth": (0.0, 11_000.0),
    "index": (1.0, 2.0),
}
"""What water there is: from a polar sea to a warm pool, from rain to the Red Sea."""


@dataclass(frozen=True)
class Water:
    """What decides how strongly water bends light: its state, or its index where that is known."""

    temperature_c: float = 20.0
    """Temperature [°C]."""
    salinity_psu: float = 35.0
    """Salinity [PSU]: 0 for fresh water, 35 for the open sea."""
    depth: float = 0.0
    """Depth below the surface [m]."""
    index: float | None = None
    """Refractive index relative to air, measured at the laser's wavelength; takes the place of the
    other three."""

    def __post_init__(self) -> None:
        """Refuse what is no water."""
        for name, (low, high) in _LIMITS.items():
            value = getattr(self, name)
            if value is not None and not low <= value <= high:
                raise InputError(
                    f"The {name} of water must lie between {low:g} and {high:g}, got {value:g}."
                )
