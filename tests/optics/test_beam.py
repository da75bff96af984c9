"""A laser's light: what is quickly told apart from it is not in it."""

import numpy as np
import pytest

from murkscan.optics.beam import Beam, Light
from murkscan.types.laser import Fan

from .ports import PORTS, WATER, unit

TIMES = 4.0


@pytest.mark.parametrize("port", [None, *PORTS.values()], ids=["no port", *PORTS])
def test_no_point_in_the_light_is_told_to_be_out_of_it(port):
    rng = np.random.default_rng(0)
    fan = Fan.spread(np.zeros(3), unit(0.3, 0.2, 1), np.array([1.0, 0, 0]), 0.5, port)
    beam = Beam(fan, Light(), WATER)
    points = rng.uniform((-1, -1, 0.1), (1, 1, 4), (20_000, 3))
    where = beam.locate(points)
    lit = np.abs(where.distance) < TIMES * beam.thickness(where.range)
    lit &= np.abs(where.angle) < fan.half_angle
    assert lit.sum() > 20
    kept = beam.may_light(points, TIMES)
    assert kept[lit].all()
    near = np.linalg.norm(points, axis=1) < 2.9
    assert kept[near].mean() < 0.2  # else it would spare nobody anything
