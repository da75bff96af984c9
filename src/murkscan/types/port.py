"""The window between the air in a housing and the water outside.

Positions are measured from the point at which the light starts or ends, the camera's optical
centre or the laser's fan origin, along the camera's axes.
"""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from .arrays import Vector
from .short_repr import ShortRepr


@final
@dataclass(frozen=True)
class Layer:
    """A sheet of one medium between two parallel planes."""

    thickness: float
    """Along the normal [m]."""
    index: float
    """Refractive index relative to air, at the laser's wavelength."""

    def __post_init__(self) -> None:
        """Refuse a layer that cannot be."""
        _check_medium(self.thickness, self.index)


@final
@dataclass(frozen=True, eq=False, repr=False)
class FlatPort(ShortRepr):
    """Plane layers one after another; a flat window has one.

    ::

        optical                inner      outer
        centre                 face       face
           ●───────distance──────┃glass ...┃     water
                                 ┃         ┃
                                      ───────▶ normal
    """

    normal: Vector
    """Unit normal, towards the water."""
    distance: float
    """From the optical centre to the inner face, along the normal [m]."""
    layers: tuple[Layer, ...]
    """From inside out."""

    def __post_init__(self) -> None:
        """Refuse a port that cannot be."""
        if not math.isclose(float(np.linalg.norm(self.normal)), 1.0, abs_tol=1e-6):
            raise InputError(f"The normal of a port must have length 1, got {self.normal}.")
        if not 0 < self.distance < math.inf:
            raise InputError(
                f"A port needs a distance above 0 along its normal, got "
                f"{self.distance * 1e3:g} mm: it would lie inside the lens."
            )


@final
@dataclass(frozen=True, eq=False, repr=False)
class DomePort(ShortRepr):
    """A shell between two concentric spheres, around the optical centre.

    Rays through the middle of a dome are not bent; the farther the optical centre lies from it,
    the more they are.
    """

    centre: Vector
    """Centre of both spheres [m]; the zero vector where the dome is adjusted perfectly."""
    radius: float
    """Radius of the inner face [m]."""
    thickness: float
    """Thickness of the shell [m]."""
    index: float
    """Refractive index of the shell relative to air, at the laser's wavelength."""

    def __post_init__(self) -> None:
        """Refuse a port that cannot be."""
        _check_medium(self.thickness, self.index)
        away = float(np.linalg.norm(self.centre))
        if not away < self.radius < math.inf:
            raise InputError(
                f"A dome of inner radius {self.radius * 1e3:g} mm must enclose the optical centre, "
                f"which lies {away * 1e3:g} mm from the dome's centre: "
                "the port would lie inside the lens."
            )


Port = FlatPort | DomePort
"""Any window."""


def _check_medium(thickness: float, index: float) -> None:
    if not 0 <= thickness < math.inf:
        raise InputError(
            f"The thickness of a port must not be negative, got {thickness * 1e3:g} mm."
        )
    if not 1 <= index <= 4:
        raise InputError(f"The index of a port must lie between 1 (air) and 4, got {index:g}.")
