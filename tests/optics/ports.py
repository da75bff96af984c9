"""Ports and a camera that the tests of this room share."""

import numpy as np

from murkscan.types.camera import Camera
from murkscan.types.port import DomePort, FlatPort, Layer


def unit(x, y, z):
    return np.array([x, y, z]) / np.linalg.norm([x, y, z])


AHEAD = unit(0, 0, 1)
TILTED = unit(0.15, -0.1, 1)
GLASS = Layer(0.008, 1.49)
PORTS = {
    "flat": FlatPort(AHEAD, 0.03, (GLASS,)),
    "tilted flat": FlatPort(TILTED, 0.03, (GLASS,)),
    "layers": FlatPort(TILTED, 0.03, (GLASS, Layer(0.02, 1.0), Layer(0.012, 1.52))),
    "dome": DomePort(np.zeros(3), 0.05, 0.005, 1.49),
    "decentred dome": DomePort(np.array([0.004, -0.003, 0.007]), 0.05, 0.005, 1.49),
}
WATER = 1.34


def camera_behind(port):
    """Make the PAL camera of the paper, 66 degrees wide, with a lens that distorts."""
    bent = np.array([-0.2, 0.05, 0.001, -0.0005, 0.0])
    return Camera((720, 576), (554.0, 554.8), (359.5, 287.5), bent, port)
