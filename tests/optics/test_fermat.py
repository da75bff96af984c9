"""Light takes the shortest optical way: the paths of this room against ways found by minimising.

Nothing of the package is used to find them: no law of refraction, only lengths.
"""

import numpy as np
import pytest
from scipy.optimize import minimize

from murkscan.optics import back_project, project, trace_fan
from murkscan.types.laser import Fan
from murkscan.types.port import DomePort, FlatPort

from .ports import GLASS, PORTS, WATER, camera_behind

MICROMETRE = 1e-6


def surfaces_of(port):
    """Give for each surface where it is, as a function of two numbers, and the indices between."""
    if isinstance(port, FlatPort):
        across = np.linalg.svd(port.normal[None])[2][1:]
        depths = port.distance + np.cumsum([0.0, *(layer.thickness for layer in port.layers)])
        on = [lambda ab, d=d: d * port.normal + ab @ across for d in depths]
        return on, [1.0, *(layer.index for layer in port.layers), WATER]

    def on_sphere(ab, radius):
        outwards = np.array([*ab, radius])
        return port.centre + radius * outwards / np.linalg.norm(outwards)

    radii = [port.radius, port.radius + port.thickness]
    return [lambda ab, r=r: on_sphere(ab, r) for r in radii], [1.0, port.index, WATER]


def shortest_way(port, target):
    """Find the crossings of all surfaces on the way from the origin to the target [m]."""
    surfaces, indices = surfaces_of(port)

    def corners(x):
        pairs = x.reshape(-1, 2) / 1e3
        return [np.zeros(3), *(on(ab) for on, ab in zip(surfaces, pairs, strict=True)), target]

    def optical_length(x):
        legs = np.linalg.norm(np.diff(corners(x), axis=0), axis=1)
        return 1e3 * (legs @ indices)

    # In millimetres, so that numerical derivatives are of the order of 1. The length is flat at
    # its minimum: rounding of 1e-13 leaves the crossings uncertain by nanometres.
    start = np.zeros(2 * len(surfaces))
    found = minimize(optical_length, start, method="BFGS", jac="3-point", options={"gtol": 1e-9})
    polished = minimize(
        optical_length, found.x, method="BFGS", jac="3-point", options={"gtol": 1e-10}
    )
    return np.array(corners(polished.x)[1:-1])


@pytest.mark.parametrize("name", PORTS)
@pytest.mark.parametrize("pixel", [(0.0, 0.0), (700.0, 100.0), (300.0, 560.0)])
def test_a_cameras_ray_is_the_shortest_way(name, pixel):
    port = PORTS[name]
    camera, pixels = camera_behind(port), np.array([pixel])
    rays = back_project(camera, pixels, WATER)
    for distance in (0.2, 2.0):
        target = rays.origins[0] + distance * rays.directions[0]
        crossings = shortest_way(port, target)
        np.testing.assert_allclose(crossings[-1], rays.origins[0], atol=0.1 * MICROMETRE)
        # The first leg is the ray inside the housing, which a camera without port sees along.
        seen = project(camera_behind(None), crossings[:1])
        # 0.1 µm on a port 30 mm away, at a focal length of 554 px.
        np.testing.assert_allclose(seen, pixels, atol=2e-3)


def fan_behind(port):
    """Make a fan of 60 degrees at 14 degrees to the axis."""
    lean = np.radians(14)
    return Fan(
        np.array([0.0, -0.25, 0.0]),
        np.array([0.0, np.sin(lean), np.cos(lean)]),
        np.array([1.0, 0.0, 0.0]),
        np.radians(30),
        port,
    )


@pytest.mark.parametrize(
    "port",
    [
        FlatPort(np.array([0.0, 0.0, 1.0]), 0.03, (GLASS,)),
        DomePort(np.array([0.003, 0.002, 0.004]), 0.04, 0.005, 1.49),
    ],
    ids=["flat", "dome"],
)
def test_a_fan_is_traced_to_a_micrometre(port):
    fan = fan_behind(port)
    angles = np.radians([-30, -17, 0, 8, 30])
    inside = np.cos(angles)[:, None] * fan.direction + np.sin(angles)[:, None] * fan.tangent
    rays = trace_fan(fan, angles, WATER)
    for distance in (1.0, 2.0):
        targets = rays.origins + distance * rays.directions
        for start, ray, target in zip(rays.origins, inside, targets, strict=True):
            crossings = shortest_way(port, target - fan.origin)
            np.testing.assert_allclose(crossings[-1], start - fan.origin, atol=0.1 * MICROMETRE)
            # What the first leg turns away from the fan's own ray, carried on to the target.
            first = crossings[0] / np.linalg.norm(crossings[0])
            assert np.linalg.norm(first - ray) * distance <= MICROMETRE
