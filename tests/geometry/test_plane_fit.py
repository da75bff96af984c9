import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import Degenerate, NotEnoughData
from murkscan.geometry.plane_fit import fit_plane
from murkscan.types.plane import Plane

TRUE = Plane.through(np.array([0.1, -0.2, 0.8]), np.array([0.9, -0.1, 0.4]))


def points_on_plane(random, count, noise=0.0):
    """Scatter points over 0.2 m around the true plane's foot."""
    spread = random.uniform(-0.1, 0.1, (count, 3)) + np.array([0.1, -0.2, 0.8])
    flat = spread - TRUE.distance_to(spread)[:, None] * TRUE.normal
    return flat + random.normal(0, noise, (count, 1)) * TRUE.normal if noise else flat


def angle_between(a, b):
    return np.linalg.norm(np.cross(a, b))


@given(st.integers(0, 10_000))
def test_points_of_a_plane_give_that_plane_back(seed):
    points = points_on_plane(np.random.default_rng(seed), 30)
    fit = fit_plane(points)
    assert fit.inliers.all()
    # Only rounding: 1e-16 of a metre over a spread of 0.1 m.
    assert angle_between(fit.plane.normal, TRUE.normal) < 1e-12
    assert fit.rms < 1e-12


@pytest.mark.parametrize("share", [0.1, 0.3, 0.45])
def test_outliers_do_not_move_the_plane(share):
    random = np.random.default_rng(1)
    good = points_on_plane(random, 2000, noise=1e-4)
    bad = random.uniform(-0.3, 0.3, (int(share / (1 - share) * 2000), 3)) + np.array(
        [0.3, 0.1, 1.2]
    )
    fit = fit_plane(np.concatenate([good, bad]))
    # Noise of 0.1 mm on 2000 points 58 mm (1 σ) wide: 1e-4 / (0.058 √2000) = 4e-5 rad, times 4.
    assert angle_between(fit.plane.normal, TRUE.normal) < 1.6e-4
    assert fit.inliers[:2000].mean() > 0.99
    assert fit.inliers[2000:].mean() < 0.01
    assert fit.rms == pytest.approx(1e-4, rel=0.1)


def test_points_that_are_not_numbers_are_left_out():
    points = points_on_plane(np.random.default_rng(2), 50)
    points[::5] = np.nan
    fit = fit_plane(points)
    assert not fit.inliers[::5].any()
    assert fit.inliers.sum() == 40
    assert np.isnan(fit.residuals[::5]).all()


def test_equal_points_give_an_equal_plane():
    points = points_on_plane(np.random.default_rng(3), 5000, noise=1e-3)
    first, second = fit_plane(points), fit_plane(points)
    np.testing.assert_array_equal(first.plane.normal, second.plane.normal)


def test_points_on_one_line_are_refused():
    line = np.linspace(0, 1, 40)[:, None] * [[1.0, 2.0, 3.0]]
    with pytest.raises(Degenerate, match="one line"):
        fit_plane(line)


def test_two_points_are_too_few():
    with pytest.raises(NotEnoughData, match="at least 3 points, got 2"):
        fit_plane(np.eye(3)[:2])
