"""A port and what lies behind it, as the surfaces at which light bends."""

import numpy as np

from .._kernels.refraction import Interfaces
from ..errors import InputError
from ..types.arrays import Vector
from ..types.port import FlatPort, Port
from .water import AIR


def interfaces_of(port: Port | None, index: float | None) -> Interfaces:
    """Give the surfaces of a port, from inside out.

    Args:
        port: The port; None gives no surface at all, so that light goes straight.
        index: Refractive index of what lies outside.

    Raises:
        InputError: There is a port but no index, or the index is below 1.
    """
    if port is None:
        return Interfaces(False, (0.0, 0.0, 1.0), np.zeros(0), np.ones(1))
    if index is None or not index >= AIR:
        raise InputError(
            f"What lies outside a port needs a refractive index of 1 or more, got {index}; "
            "give that of the water, or 1 for air."
        )
    if isinstance(port, FlatPort):
        thicknesses = [layer.thickness for layer in port.layers]
        sizes = port.distance + np.cumsum([0.0, *thicknesses])
        media = [layer.index for layer in port.layers]
        return Interfaces(False, as_triple(port.normal), sizes, np.array([AIR, *media, index]))
    sizes = np.array([port.radius, port.radius + port.thickness])
    return Interfaces(True, as_triple(port.centre), sizes, np.array([AIR, port.index, index]))


def as_triple(vector: Vector) -> tuple[float, float, float]:
    """Give a vector as three numbers, which compiled loops read faster than an array."""
    x, y, z = vector.tolist()
    return x, y, z
