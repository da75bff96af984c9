"""What a forecast is made for: the water, the light, the sensor, the surface."""

from dataclasses import dataclass, field

from ..errors import InputError
from ..optics.beam import Light
from ..optics.medium import Medium
from ..optics.sensor import Sensor

_BLACK_DISC = 4.8
"""Attenuation lengths at which a black disc disappears."""
_SECCHI = 8.69
"""Sum of beam and diffuse attenuation times the depth at which a Secchi disc disappears."""
_DIFFUSE = 0.25
"""Diffuse attenuation as a share of beam attenuation: it is 3 to 6 times smaller, so that a Secchi
depth tells c to 7 % at best."""


@dataclass(frozen=True)
class Conditions:
    """All but the rig that decides what is seen."""

    medium: Medium
    """The water."""
    light: Light = field(default_factory=Light)
    """The laser's power and thickness, and the daylight."""
    sensor: Sensor = field(default_factory=Sensor)
    """The camera's sensor, with its exposure."""
    albedo: float = 0.1
    """Share of light that the surface throws back, evenly to all sides."""

    def __post_init__(self) -> None:
        """Refuse a surface that cannot be.

        Raises:
            InputError: The albedo is not above 0 and up to 1.
        """
        if not 0 < self.albedo <= 1:
            raise InputError(
                f"The albedo must lie above 0 and not above 1, got {self.albedo:g}; antifouling "
                "paint has 0.03 to 0.1."
            )


def attenuation_from_visibility(visibility: float) -> float:
    """Give the beam attenuation [1/m] of water in which a black disc disappears at a distance [m].

    A diver's horizontal visibility is about that.

    Raises:
        InputError: The distance is not above 0.

    References:
        Hou, Lee and Weidemann, Why does the Secchi disk disappear? An imaging perspective, Optics
        Express 15(6), 2007.
    """
    if not visibility > 0:
        raise InputError(f"A visibility must be above 0 m, got {visibility:g}.")
    return _BLACK_DISC / visibility


def visibility_from_attenuation(attenuation: float) -> float:
    """Give how far a diver sees [m] in water of a beam attenuation [1/m]: the inverse."""
    return _BLACK_DISC / max(attenuation, 1e-9)


def attenuation_from_secchi(depth: float) -> float:
    """Give the beam attenuation [1/m] of water in which a Secchi disc disappears at a depth [m].

    The diffuse attenuation that the disc feels, too, is taken to be a quarter of it.

    Raises:
        InputError: The depth is not above 0.

    References:
        Tyler, The Secchi disc, Limnology and Oceanography 13(1), 1968.
    """
    if not depth > 0:
        raise InputError(f"A Secchi depth must be above 0 m, got {depth:g}.")
    return _SECCHI / (1 + _DIFFUSE) / depth
