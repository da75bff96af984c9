"""Forward scattering: once as the path integral, often as its powers."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from murkscan.errors import InputError
from murkscan.optics.medium import Medium
from murkscan.optics.phase_fournier_forand import FournierForand
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.optics.phase_petzold import PetzoldHarbour
from murkscan.optics.spread import Spread

PHASES = (PetzoldHarbour(), HenyeyGreenstein(0.9), FournierForand())


def weights_at(spread, laser_range, camera_range):
    return spread.weights(np.array([laser_range]), np.array([camera_range]))[0]


def density_at(spread, weights, tangent):
    """Give the light per area of the tangent plane at a distance from where it belongs."""
    variances = spread.widths**2
    return np.sum(weights / (2 * np.pi * variances) * np.exp(-0.5 * tangent**2 / variances))


def transform_at(spread, weights, frequency):
    return np.sum(weights * np.exp(-0.5 * (frequency * spread.widths) ** 2))


def scatter_once(phase, tangent):
    """Add up the light of a Lambertian point at 1 m that is scattered once on its way.

    Seen at an angle to it, for each place along the line of sight, and for b = 1 /m without loss.
    """
    theta = np.arctan(tangent)

    def rate(way):
        x, z = way * np.sin(theta), 1 - way * np.cos(theta)
        square = x * x + z * z
        alpha = np.arctan2(x, z)
        density = phase.at_angle(np.array([theta + alpha]))[0]
        return density * max(np.cos(alpha), 0.0) / square

    whole = 1 / np.cos(theta)
    marks = np.cos(theta) - tangent * np.array([30.0, 10.0, 3.0, 1.0, 0.0])
    edges = [0.0, *marks[marks > 0], whole]
    total = sum(quad(rate, *edge, epsrel=1e-4)[0] for edge in pairwise(edges))
    return total * np.cos(theta) ** 3


@pytest.mark.parametrize("phase", PHASES, ids=repr)
@pytest.mark.parametrize("tangent", [0.005, 0.02, 0.1, 0.3, 0.7, 1.2])
def test_thin_water_spreads_light_as_one_scattering_does(phase, tangent):
    water = Medium(1e-3, 1.0, phase)
    spread = Spread.of(water)
    depth = water.scattering * 2.0
    found = density_at(spread, weights_at(spread, 1.0, 1.0), tangent) / depth
    # Eleven Gaussians ripple by 2 to 5 % about a power law; the second scattering adds 0.2 %.
    assert found == pytest.approx(scatter_once(phase, tangent), rel=0.06)


@pytest.mark.parametrize("phase", PHASES, ids=repr)
@pytest.mark.parametrize("frequency", [1.0, 5.0, 20.0, 100.0])
def test_spreading_twice_by_half_the_way_is_spreading_once_by_all_of_it(phase, frequency):
    spread = Spread.of(Medium(1.0, 1.0, phase))
    half = transform_at(spread, weights_at(spread, 1.0, 1.0), frequency)
    whole = transform_at(spread, weights_at(spread, 2.0, 2.0), frequency)
    # Ripple as above, and light spread beyond 1.4 is not asked for.
    assert 1 + whole == pytest.approx((1 + half) ** 2, rel=0.04)


@pytest.mark.parametrize("make", [Spread.of, Spread.of_glow])
@pytest.mark.parametrize("phase", PHASES, ids=repr)
@pytest.mark.parametrize("albedo", [0.5, 1.0])
def test_no_more_light_is_spread_than_is_scattered(make, phase, albedo):
    spread = make(Medium(1.0, albedo, phase))
    depth = np.geomspace(0.01, 30.0, 40)
    weights = spread.weights(depth / albedo / 2, depth / albedo / 2)
    assert (weights >= 0).all()
    # A glow sends up to 8 % more to the sides than ahead, at each scattering; ripple is 2 %.
    assert (weights.sum(axis=1) <= np.expm1(1.08 * depth) * 1.02).all()


def test_a_longer_way_spreads_more_light_and_wider():
    spread = Spread.of(Medium(2.0))
    ways = np.linspace(0.05, 2.0, 30)
    weights = spread.weights(ways, ways)
    variance = (weights * spread.widths**2).sum(axis=1) / weights.sum(axis=1)
    assert (np.diff(weights.sum(axis=1)) > 0).all()
    assert (np.diff(variance) > 0).all()


def test_only_the_whole_way_counts_and_pictures_keep_their_shape():
    spread = Spread.of(Medium(2.0))
    there, back = np.full((3, 4), 0.5), np.full((3, 4), 0.7)
    weights = spread.weights(there, back)
    assert weights.shape == (3, 4, len(spread.widths))
    np.testing.assert_allclose(weights, spread.weights(back, there))


def test_the_skirt_of_a_stripe_is_as_broad_as_a_path_tracer_finds_it():
    # Traced with g = 0.9, albedo 0.8, c = 1.5 /m, a wall at 0.8 m and f = 280 px: every row from
    # 9 to 25 px off carries 2 to 3 % of what the stripe's own 7 rows carry, on both sides.
    spread = Spread.of(Medium(1.5, 0.8, HenyeyGreenstein(0.9)))
    weights, widths = weights_at(spread, 0.85, 0.8), 280 * spread.widths
    rows = np.arange(-60, 61)

    def line(sigma):
        return np.exp(-0.5 * (rows / sigma) ** 2) / (sigma * np.sqrt(2 * np.pi))

    core = 1.4
    profile = line(core) + sum(
        w * line(np.hypot(s, core)) for w, s in zip(weights, widths, strict=True)
    )
    off = abs(rows)
    share = profile[(off >= 9) & (off <= 25)] / profile[off <= 3].sum()
    assert share.min() > 0.01
    assert share.max() < 0.04
    assert share.mean() == pytest.approx(0.025, abs=0.007)


def test_water_that_only_absorbs_spreads_nothing():
    assert not weights_at(Spread.of(Medium(3.0, 0.0)), 1.0, 1.0).any()


def test_weights_stay_finite_where_no_light_is_left():
    assert np.isfinite(weights_at(Spread.of(Medium(50.0)), 10.0, 10.0)).all()


def test_a_negative_way_is_refused():
    with pytest.raises(InputError, match="way in the water"):
        weights_at(Spread.of(Medium(1.0)), -1.0, 0.5)
