"""How far the light went: what is too far is told from what is too dark, where that can be told."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.extract import Murk
from murkscan.optics.medium import Medium
from murkscan.report import (
    CAUSES,
    Reach,
    SurfaceDirections,
    SwathLayout,
    frame_statistics,
    map_coverage,
)
from murkscan.simulate import Body, Scene, Sensor, simulate_frames
from murkscan.simulate.textures import Bands
from murkscan.triangulate import RaySheet, triangulate
from murkscan.types.frame_times import FrameTimes
from murkscan.types.mesh import Mesh
from murkscan.types.pose import Pose
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

from ..scenes import air_rig, smaller

C, BRIGHT = 5.0, 4000.0
TOO_FAR, TOO_DARK, EITHER = (1 + CAUSES.index(c) for c in ("too_far", "too_dark", "far_or_dark"))


def _signal(ranges):
    """A stripe in water of attenuation C."""
    return BRIGHT * np.exp(-2 * C * ranges) / ranges**2


def _seen(low, high, *, limit, seed=0):
    """Points between two ranges, of paint with a spread of 20 %, without the weak ones."""
    random = np.random.default_rng(seed)
    ranges = random.uniform(low, high, 20_000)
    signals = _signal(ranges) * np.exp(0.2 * random.standard_normal(len(ranges)))
    found = signals > limit
    return ranges[found], signals[found]


@pytest.mark.parametrize("limit", [2.0, 20.0])
def test_the_limit_is_that_of_what_was_found_where_the_stripe_fades(limit):
    reach = Reach.from_points(*_seen(0.4, 2.0, limit=limit), noise=0.3)
    # 1 % of points are weaker than the limit that is told; the stripe fades by 6 a metre.
    assert reach.least == pytest.approx(limit, rel=0.15)
    true = np.interp(-2 * limit, -_signal(np.linspace(0.4, 2, 999)), np.linspace(0.4, 2, 999))
    # A bin of ranges is 2 to 3 cm wide.
    assert reach.farthest == pytest.approx(true, abs=0.03)
    assert reach.tell(np.array([0.5, 1.5 * true])).tolist() == [TOO_DARK, TOO_FAR]


def test_a_false_point_far_away_hides_nothing():
    ranges, signals = _seen(0.4, 2.0, limit=10.0)
    clean = Reach.from_points(ranges, signals, noise=0.3)
    strayed = Reach.from_points(np.append(ranges, 30.0), np.append(signals, 12.0), noise=0.3)
    assert strayed.farthest == pytest.approx(clean.farthest, abs=0.03)


def test_on_an_even_bright_wall_nothing_is_too_far():
    ranges, signals = _seen(0.6, 0.62, limit=1.0)
    reach = Reach.from_points(ranges, signals, noise=0.3)
    assert reach.farthest is None
    assert np.all(reach.tell(np.linspace(0.6, 0.62, 9)) == TOO_DARK)


def test_on_a_wall_at_the_edge_of_the_noise_it_cannot_be_told():
    ranges, signals = _seen(1.0, 1.02, limit=0.0)
    reach = Reach.from_points(ranges, signals, noise=np.median(signals) / 15)
    assert np.all(reach.tell(ranges) == EITHER)


def test_without_points_it_cannot_be_told():
    reach = Reach.from_points(np.zeros(0), np.zeros(0))
    assert reach.farthest is None
    assert reach.tell(np.array([1.0])).tolist() == [EITHER]


@given(st.floats(0.01, 100))
def test_the_unit_of_the_signal_does_not_matter(scale):
    ranges, signals = _seen(0.4, 2.0, limit=5.0)
    one = Reach.from_points(ranges, signals, noise=0.3)
    other = Reach.from_points(ranges, scale * signals, noise=scale * 0.3)
    places = np.linspace(0.3, 2.0, 40)
    np.testing.assert_allclose(other.headroom(places), one.headroom(places), rtol=1e-9)


DARK = (0.20, 0.28)
"""A band of black paint across the valley, along the motion [m]."""


def _valley():
    """Two walls that meet in a groove along the motion, too deep for the light."""
    x, z = np.array([-0.75, 0.0, 0.75]), np.array([0.5, 1.4, 0.5])
    points = np.array([[x[k], y, z[k]] for y in (-0.6, 1.4) for k in range(3)])
    faces = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    paint = Bands((0.002, 0.2), (DARK[1] - DARK[0], 10.0))
    shift = np.array([0.0, DARK[0], 0.0])
    return Body(Mesh(points - shift, faces), Pose(np.eye(3), shift), texture=paint)


@pytest.fixture(scope="module")
def coverage():
    """A simulated scan of the valley in murky water: 5 mm a frame."""
    step, count = 0.005, 90
    times = np.arange(count) * 0.04
    places = np.zeros((count, 3))
    places[:, 1] = step * np.arange(count)
    way = Trajectory(times, places, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)))
    scene = Scene(
        (_valley(),), air_rig(distance=0.8), way, times, medium=Medium(C),
        sensor=Sensor(peak_grey=200.0), glow=False,
    )  # fmt: skip
    scene = smaller(scene, 4)
    frames = [simulated.frame for simulated in simulate_frames(scene)]
    finder = Murk()
    background = finder.learn(frames[::10], scene.rig)
    stripes = finder.extract(frames, scene.rig, background)
    profile = Profile.concatenate([triangulate(s, scene.rig, RaySheet()) for s in stripes])
    assert len(frame_statistics(profile).frame) > 80
    ranges = np.linalg.norm(profile.points, axis=1)
    layout = SwathLayout(
        FrameTimes(np.arange(count, dtype=np.uint32), times), way, "y", scene.rig.camera.size, 1,
        SurfaceDirections.from_trajectory(way, "y"),
    )  # fmt: skip
    reach = Reach.from_points(ranges, profile.signal, noise=background.noise)
    return map_coverage([profile], {0: layout}, reach=reach, wanted=0.006, spacing=0.006)


def _areas(coverage, *, across, along):
    """Area of each state in a window of the map [m²]; covered first."""
    (left, low), edge = coverage.corner, coverage.cell
    _, rows, columns = coverage.areas.shape
    x = low + edge * (np.arange(rows) + 0.5)
    y = left + edge * (np.arange(columns) + 0.5)
    inside = across(x)[:, None] & ((y > along[0]) & (y < along[1]))[None]
    return coverage.areas[:, inside].sum(axis=1)


def test_a_black_band_within_reach_is_too_dark(coverage):
    low, high = DARK
    areas = _areas(coverage, across=lambda x: np.abs(x) > 0.4, along=(low + 0.01, high - 0.01))
    missing = areas[1:].sum()
    assert missing > 10 * areas[0]
    # What is left are false finds in the band, behind which the rest looks hidden.
    assert areas[TOO_DARK] > 0.8 * missing
    assert areas[TOO_FAR] == 0


def test_a_groove_beyond_reach_is_too_far(coverage):
    areas = _areas(coverage, across=lambda x: np.abs(x) < 0.15, along=(0.35, 0.5))
    missing = areas[1:].sum()
    assert missing > areas[0]
    assert areas[TOO_FAR] > 0.8 * missing
    assert areas[TOO_DARK] == 0


def test_the_walls_in_reach_are_covered(coverage):
    areas = _areas(coverage, across=lambda x: np.abs(x) > 0.3, along=(0.05, 0.15))
    assert areas[0] > 0.97 * areas.sum()
