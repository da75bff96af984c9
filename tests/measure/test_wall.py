"""A wall in elevation: its axes, its map, its curves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.measure import Sample, find_anomalies, find_deflection, map_wall
from murkscan.types.cloud import PointCloud
from murkscan.types.cylinder import Cylinder
from murkscan.types.plane import Plane
from murkscan.types.wall import WallFrame

UP = np.array([0.0, -1.0, 0.1])
PLANE = WallFrame.of_plane(
    Plane.through(np.array([432100.0, 7.0, 0.6]), np.array([0.2, 0.0, -1.0])),
    np.array([432100.0, 7.0, 0.6]),
    UP,
)


def cylinder(viewer):
    axis = np.array([0.0, -1.0, 0.0])
    pile = Cylinder(np.array([0.0, 0.0, 2.0]), axis, 1.2)
    return WallFrame.of_cylinder(pile, np.array([0.1, 0.3, 0.8]), np.array([0.0, 0.0, viewer]))


@pytest.mark.parametrize("frame", [PLANE, cylinder(-1.0), cylinder(1.0)])
@given(
    along=st.floats(-1.5, 1.5), height=st.floats(-5, 5), out=st.floats(-0.5, 0.5)
)  # fmt: skip
def test_places_come_back_from_the_world(frame, along, height, out):
    located = np.array([[along, height, out]])
    np.testing.assert_allclose(frame.locate(frame.place(located)), located, atol=1e-6)
    step = frame.place(located + np.array([0, 0, 1e-3])) - frame.place(located)
    np.testing.assert_allclose(step / 1e-3, frame.outwards(located), atol=1e-5)


def test_the_viewer_sees_along_to_the_right_and_up_upwards():
    frame = WallFrame.of_plane(
        Plane.through(np.array([0, 0, 1.0]), np.array([0, 0, -1.0])), np.zeros(3), -np.eye(3)[1]
    )
    np.testing.assert_allclose(frame.axes, [[1, 0, 0], [0, -1, 0], [0, 0, -1]], atol=1e-12)
    for viewer in (-1.0, 1.0):
        along, up, out = cylinder(viewer).axes
        np.testing.assert_allclose(np.cross(along, up), out, atol=1e-12)
        assert out[2] * viewer > 0


def test_a_floor_is_no_wall():
    with pytest.raises(InputError, match="--up"):
        WallFrame.of_plane(
            Plane.through(np.zeros(3), np.array([0.1, 1.0, 0.0])), np.zeros(3), np.eye(3)[1]
        )


def strip(seed, common, alike=1):
    """A bent strip of 200 profiles with 24 points; errors of points and of whole profiles.

    The latter are means over some profiles in a row.
    """
    random = np.random.default_rng(seed)
    profile, line = (grid.ravel() for grid in np.mgrid[:200, :24])
    x, y = 0.1 + line * 2e-3, profile * 0.02 + 0.01
    truth = 0.03 * np.exp(-((y - 2) ** 2) / 2) + 0.01 * x
    whole = np.convolve(random.standard_normal(199 + alike), np.full(alike, alike**-0.5), "valid")
    error = 1e-4 * random.standard_normal(len(x)) + common * whole[profile]
    points = np.stack([x, -y, -(truth + error)], axis=1)
    ones, none = np.ones(len(x), np.float32), np.zeros(len(x), np.uint8)
    whole = profile.astype(np.int32), line.astype(np.int32)
    normals = np.tile(np.array([0, 0, -1], np.float32), (len(x), 1))
    cloud = PointCloud(points, normals, ones, ones, 1e-4 * ones, 0 * ones, *whole, none, none)
    return Sample.from_cloud(cloud), np.stack([x, y, truth + error], axis=1), truth


FLAT = WallFrame(np.zeros(3), np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, -1]]))


@pytest.mark.parametrize(("common", "alike"), [(0.0, 1), (5e-5, 1), (2e-4, 3)])
def test_a_curve_states_how_far_it_is_off(common, alike):
    ratios = []
    for seed in range(3):
        sample, located, truth = strip(seed, common, alike)
        curve = find_deflection(sample, located, FLAT, along=0.123, width=0.1, cell=0.02)
        off = curve.distance - truth.reshape(200, 24).mean(axis=1)
        ratios.append(off / curve.sigma_own)
        assert np.abs(off).max() < 1e-3
        assert curve.sigma_common is None
    # Of 600 places, of which three in a row may be alike: the root mean square is known to 5 %,
    # the deviation itself to some 8 %.
    assert 0.85 < np.sqrt(np.mean(np.square(ratios))) < 1.18


def test_a_strip_of_which_a_part_was_seen_tells_where_that_lies():
    sample, located, _ = strip(0, 0.0)
    # The wall leans by 0.3 along; of the upper half of the strip only the left third was seen.
    seen = (located[:, 1] < 2) | (located[:, 0] < 0.116)
    located[:, 2] += 0.3 * located[:, 0]
    some = Sample.from_cloud(sample.cloud[seen])
    curve = find_deflection(some, located[seen], FLAT, along=0.123, width=0.1, cell=0.02)
    truth = 0.03 * np.exp(-((curve.height - 2) ** 2) / 2) + 0.31 * curve.places
    # The left third alone lies 15 mm aside, by which it would be 4.6 mm off.
    assert np.ptp(curve.places) == pytest.approx(0.015, abs=2e-3)
    assert np.abs(curve.distance - truth).max() < 3e-4


def ribbed_wall():
    x, y = (grid.ravel() for grid in np.mgrid[0:3:0.01, -4:0:0.01])
    ribs = 0.1 * (np.mod(x, 0.6) < 0.3)
    dent = -0.02 * ((np.abs(x - 1.2) < 0.1) & (np.abs(y + 1.0) < 0.2))
    noise = 1e-4 * np.random.default_rng(0).standard_normal(len(x))
    return np.stack([x, y, ribs + dent + noise], axis=1)


def test_a_part_that_stands_back_is_found_between_ribs():
    wall = map_wall(ribbed_wall(), 0.02).without_profile()
    (found,) = find_anomalies(wall, least=0.005)
    assert found.distance == pytest.approx(-0.02, abs=1e-3)
    assert found.along == pytest.approx(1.2, abs=0.1)
    assert found.height == pytest.approx(-1.0, abs=0.2)
    assert (found.width, found.rise) == pytest.approx((0.2, 0.4), abs=0.041)
    assert found.area == pytest.approx(0.08, rel=0.15)


def test_noise_alone_is_no_anomaly():
    assert not find_anomalies(map_wall(ribbed_wall()[:, [0, 1, 1]] * [1, 1, 0], 0.02), least=0.0)


def test_a_map_of_too_many_cells_is_refused():
    with pytest.raises(InputError, match="--cell-mm"):
        map_wall(np.array([[0.0, 0.0, 0.0], [1e4, 1e4, 0.0]]), 1e-3)
