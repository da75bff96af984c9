"""Waters known by name: Jerlov's types and Petzold's stations."""

from ..errors import InputError
from .medium import Medium
from .phase import AbstractPhase
from .phase_petzold import PetzoldHarbour

KNOWN_WATERS: dict[str, tuple[float, float]] = {
    # Williamson and Hollins 2022, measured, at 532 nm.
    "Jerlov IB": (0.177, 0.124),
    "Jerlov II": (0.241, 0.179),
    "Jerlov III": (0.371, 0.290),
    "Jerlov 1C": (0.527, 0.432),
    "Jerlov 3C": (0.779, 0.651),
    "Jerlov 5C": (1.378, 1.210),
    # Solonenko and Mobley 2015, inverted from diffuse attenuation, at 532 nm.
    "Jerlov 7C": (2.709, 2.487),
    "Jerlov 9C": (3.714, 3.307),
    # Petzold 1972, measured, at 530 nm.
    "Petzold AUTEC 7": (0.199, 0.117),
    "Petzold AUTEC 8": (0.151, 0.037),
    "Petzold AUTEC 9": (0.165, 0.043),
    "Petzold HAOCE 5": (0.470, 0.275),
    "Petzold HAOCE 11": (0.398, 0.219),
    "Petzold NUC 2240": (1.330, 1.205),
    "Petzold NUC 2200": (1.920, 1.583),
    "Petzold NUC 2040": (2.190, 1.824),
}
"""Attenuation c and scattering b [1/m] of each."""


def medium_of(name: str, phase: AbstractPhase | None = None) -> Medium:
    """Give a water that is known by name.

    Args:
        name: One of `KNOWN_WATERS`, in any case.
        phase: How it scatters; without it as Petzold's harbour, because a Jerlov type says
            nothing of it.

    Raises:
        InputError: No water is known by that name.

    References:
        Williamson and Hollins, Measured inherent optical properties of Jerlov water types, Applied
        Optics 61(33), 2022, for IB to 5C; Solonenko and Mobley, Inherent optical properties of
        Jerlov water types, Applied Optics 54(17), 2015, for 7C and 9C; Petzold, Volume scattering
        functions for selected ocean waters, SIO Ref. 72-78, 1972, for the stations.
    """
    by_name = {known.casefold(): values for known, values in KNOWN_WATERS.items()}
    if name.casefold() not in by_name:
        known = ", ".join(KNOWN_WATERS)
        raise InputError(f"No water is known as {name!r}; take one of {known}.")
    attenuation, scattering = by_name[name.casefold()]
    return Medium(attenuation, scattering / attenuation, phase or PetzoldHarbour())
