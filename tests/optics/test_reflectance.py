"""Two paints keep their ratio, and each its own brightness, at any range, slope and water."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.optics.medium import Medium
from murkscan.optics.reflectance import StripeBrightness
from murkscan.simulate import Body
from murkscan.simulate.frames import Simulator
from murkscan.simulate.shapes import Plane
from murkscan.simulate.textures import Bands
from murkscan.types.pose import Pose

from ..scenes import QUIET, smaller, standing, wall

ALBEDOS, WIDTH = (0.1, 0.4), 0.08
SENSOR = replace(
    QUIET, vignetting=True, peak_grey=None, exposure=1e-3, full_well=1e7, read_noise=0.0
)


def find_reflectance(distance, attenuation, tilt):
    """Give the median reflectance of both paints on a wall, of the simulator's true stripe."""
    turn = Rotation.from_euler("xy", [tilt, tilt / 2], degrees=True).as_matrix()
    place = np.array([0.0, 0.0, distance])
    wall = Body(
        Plane(8.0, 8.0).mesh(), Pose(turn, place), texture=Bands(ALBEDOS, (WIDTH, WIDTH), "x")
    )
    medium = Medium(attenuation) if attenuation else None
    scene = smaller(standing(wall, sensor=SENSOR, medium=medium), 2)
    seen = Simulator.of(scene).draw_frame(0).stripe
    bright = StripeBrightness(scene.rig.camera, scene.rig.lasers[0], 1.0, attenuation)
    normals = np.tile(turn @ [0, 0, -1.0], (len(seen.points), 1))
    told = seen.signal / bright.of(seen.points, normals)
    along = (seen.points - place) @ turn[:, 0] / WIDTH
    inside = np.abs(along - np.round(along)) > 0.2
    return [np.median(told[inside & (np.floor(along) % 2 == k)]) for k in (0, 1)]


@pytest.fixture(scope="module")
def plain():
    return find_reflectance(0.5, 0.0, 15.0)  # so that the line crosses pixels


def test_two_paints_differ_as_their_albedos(plain):
    # In clear air there is nothing but Lambert's law; the stripe is 16 bit.
    assert plain[1] / plain[0] == pytest.approx(4.0, rel=0.01)


@pytest.mark.parametrize(
    ("distance", "attenuation", "tilt"), [(0.9, 0.0, 15.0), (0.5, 0.0, 35.0), (0.8, 1.0, 20.0)]
)
def test_a_paint_is_as_bright_at_another_range_slope_and_water(plain, distance, attenuation, tilt):
    dark, light = find_reflectance(distance, attenuation, tilt)
    # The stripe's width in the picture is known to some percent; without the correction it would
    # be off by factors of 3.5, 1.3 and 20.
    assert light == pytest.approx(plain[1], rel=0.08)
    # In murk the dark paint has some glare of the light one beside it: 2 to 3 percent of a stripe
    # lie on each row around it (path-traced), four times as many of one that is four times darker.
    assert light / dark == pytest.approx(4.0, rel=0.1 if attenuation else 0.02)


def test_what_the_light_only_grazes_is_not_told():
    scene = standing(wall())
    bright = StripeBrightness(scene.rig.camera, scene.rig.lasers[0], 1.0)
    point = np.array([[0.0, 0.0, 0.5]])
    assert np.isnan(bright.of(point, np.array([[1.0, 0.0, 0.0]])))
    assert np.isnan(bright.of(point, np.zeros((1, 3))))
    assert bright.of(point, np.array([[0.0, 0.0, -1.0]])) > 0
