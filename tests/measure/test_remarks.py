"""A number that means little says so, with what to do; one that means something says nothing."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.measure import (
    Sample,
    deviation_from_smooth,
    measure_cylinder,
    measure_distance,
    measure_plane,
    measure_sphere,
    measure_step,
    remark_on_smooth,
)

from .. import scans


def sample_of(surface) -> Sample:
    return Sample.from_cloud(scans.scan_cloud(surface, spacing=2e-3, noise=1e-4))


def hull(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.5 + 4 * (x * x + y * y)


def keeled(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A hull with a keel of 20 mm, 14 mm wide."""
    return hull(x, y) - np.where(np.abs(y - 0.01) < 7e-3, 0.02, 0.0)


def test_a_plane_through_a_hull_says_that_it_is_none():
    (said,) = measure_plane(sample_of(hull)).remarks
    assert "is no plane" in said
    assert "--near-m and --within-mm" in said


@pytest.mark.parametrize(
    ("measure", "surface"),
    [(measure_plane, scans.plane), (measure_sphere, scans.sphere),
     (measure_cylinder, scans.cylinder)],
)  # fmt: skip
def test_shapes_that_are_there_say_nothing(measure, surface):
    assert measure(sample_of(surface)).remarks == ()


def test_a_plane_that_leaves_out_a_third_says_so():
    (said,) = measure_plane(two_levels()).remarks
    assert said.startswith("Only 6")
    assert "left out" in said


def two_levels() -> Sample:
    """Two of three parts of the points at one level."""
    sample = sample_of(scans.step)
    y = sample.cloud.points[:, 1]
    return sample[(y > 0) | (y < -0.03)]


def test_a_step_of_what_is_no_plane_says_so():
    sample = sample_of(keeled)
    x = sample.cloud.points[:, 0]
    assert any("no plane" in said for said in measure_step(sample[x < 0], sample[x > 0]).remarks)


def test_a_distance_says_that_its_ends_are_not_those_asked_for():
    sample = sample_of(scans.plane)
    ends = sample.cloud.points[[100, 4000]]
    assert measure_distance(sample, ends).remarks == ()
    (said,) = measure_distance(sample, ends + np.array([[0, 0, -3e-3], [0, 0, 0]])).remarks
    assert " and 0.00 mm from the places asked for" in said
    assert "view/index.html" in said


def test_dents_are_not_looked_for_beside_a_keel_without_a_word():
    for surface, is_odd in ((hull, False), (keeled, True)):
        sample = sample_of(surface)
        said = remark_on_smooth(sample, deviation_from_smooth(sample, largest=0.06), 0.06)
        assert bool(said) == is_odd
    assert "keels" in said[0]
    assert "--reference" in said[0]


def test_points_without_a_deviation_do_not_count():
    sample = sample_of(hull)
    deviation = deviation_from_smooth(sample, largest=0.06)
    unknown = replace(deviation, values=np.full_like(deviation.values, np.nan))
    assert remark_on_smooth(sample, unknown, 0.06) == ()
