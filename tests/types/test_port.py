"""What windows and fans there can be."""

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.port import DomePort, FlatPort, Layer

AHEAD, ASIDE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
GLASS = Layer(0.008, 1.49)


@pytest.mark.parametrize("distance", [0.0, -0.01, float("nan"), float("inf")])
def test_a_flat_port_inside_the_lens_is_refused(distance):
    with pytest.raises(InputError, match="inside the lens"):
        FlatPort(AHEAD, distance, (GLASS,))


def test_a_dome_that_cuts_the_lens_is_refused():
    with pytest.raises(InputError, match="inside the lens"):
        DomePort(np.array([0.0, 0.0, 0.06]), 0.05, 0.005, 1.49)


def test_glass_is_at_least_as_dense_as_air_and_not_thinner_than_nothing():
    with pytest.raises(InputError, match="index"):
        Layer(0.008, 0.99)
    with pytest.raises(InputError, match="thickness"):
        Layer(-0.008, 1.49)
    with pytest.raises(InputError, match="index"):
        DomePort(np.zeros(3), 0.05, 0.005, float("nan"))


def test_the_normal_of_a_port_is_a_direction_towards_the_water():
    with pytest.raises(InputError, match="length 1"):
        FlatPort(2 * AHEAD, 0.03, (GLASS,))
    with pytest.raises(InputError, match="forwards"):
        Camera((720, 576), (554.0, 554.0), (360.0, 288.0), port=FlatPort(-AHEAD, 0.03, (GLASS,)))


def test_a_fan_spreads_across_its_direction():
    fan = Fan.spread(np.zeros(3), 2 * AHEAD, np.array([3.0, 0.0, 1.0]), 0.5)
    np.testing.assert_allclose(fan.tangent, ASIDE)
    np.testing.assert_allclose(fan.direction, AHEAD)
    with pytest.raises(InputError, match="across"):
        Fan.spread(np.zeros(3), AHEAD, 2 * AHEAD, 0.5)
    with pytest.raises(InputError, match="right angles"):
        Fan(np.zeros(3), AHEAD, np.array([0.8, 0.0, 0.6]), 0.5)


@pytest.mark.parametrize("half_angle", [0.0, -0.1, np.pi / 2, float("nan")])
def test_a_fan_spreads_less_than_half_a_circle(half_angle):
    with pytest.raises(InputError, match="half angle"):
        Fan(np.zeros(3), AHEAD, ASIDE, half_angle)


def test_a_fan_must_pass_its_window():
    with pytest.raises(InputError, match="pass its port"):
        Fan(np.zeros(3), AHEAD, ASIDE, 0.5, FlatPort(-AHEAD, 0.03, (GLASS,)))


def test_a_fans_laser_sits_along_the_larger_component_of_its_normal():
    assert Laser.from_sheet(Fan(np.zeros(3), AHEAD, ASIDE, 0.5)).axis == "y"
