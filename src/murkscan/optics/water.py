"""How strongly water bends light."""

from ..types.water import Water

AIR = 1.0
"""Refractive index of air; all others are relative to it."""

_PER_DECIBAR = 1.45e-6
"""Growth of the index with pressure; a metre of water presses with one decibar, to 2 %."""


def refractive_index(water: Water | None, wavelength: float) -> float:
    """Give the refractive index of water relative to air; that of air where there is none.

    Args:
        water: The water, or None for air.
        wavelength: Wavelength in air [m]; fitted from 400 to 700 nm.

    References:
        Quan and Fry, Empirical equation for the index of refraction of seawater, Applied Optics
        34(18), 1995, equation (3), at the surface. For measurements under pressure see Austin and
        Halikas, The index of refraction of seawater, SIO Ref. 76-1, 1976.
    """
    if water is None:
        return AIR
    if water.index is not None:
        return water.index
    t, s, nm = water.temperature_c, water.salinity_psu, wavelength * 1e9
    return (
        1.31405
        + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t**2) * s
        - 2.02e-6 * t**2
        + (15.868 + 0.01155 * s - 0.00423 * t) / nm
        - 4382 / nm**2
        + 1.1455e6 / nm**3
        + _PER_DECIBAR * water.depth
    )
