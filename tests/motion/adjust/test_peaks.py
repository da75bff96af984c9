"""Where a tile lies in another relief: a seam tells one direction, growth all."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from murkscan._kernels.tiles import correlate
from murkscan.motion.adjust.peaks import find_peak

SHAPE, MARGIN, NOISE = (12, 30), 6, 0.3


def lay(surface, random):
    """Look at a surface twice, with noise: give a tile of its middle, and all of it."""
    one, two = (surface + NOISE * random.normal(size=surface.shape) for _ in range(2))
    return one[MARGIN:-MARGIN, MARGIN:-MARGIN], two


def find(surface, seed):
    tile, whole = lay(surface, np.random.default_rng(seed))
    return find_peak(correlate(tile, whole, tile.size // 2), tile.size)


def grow(seed):
    """Give growth of RMS 1 that goes together over three pixels."""
    size = [side + 2 * MARGIN for side in SHAPE]
    field = gaussian_filter(np.random.default_rng(100 + seed).normal(size=size), 2.0)
    return field / field.std()


def weld(direction):
    """Give a seam of height 3 through the middle, along a direction in pixels."""
    sides = [side + 2 * MARGIN for side in SHAPE]
    rows, columns = np.meshgrid(*map(np.arange, sides), indexing="ij")
    across = (rows - sides[0] / 2) * direction[1] - (columns - sides[1] / 2) * direction[0]
    return 3 * np.exp(-0.5 * across**2)


def test_growth_is_found_along_both_axes():
    off, sigma = [], []
    for seed in range(20):
        peak = find(grow(seed), seed)
        off.append(peak.place - MARGIN)
        sigma.append(np.sqrt(np.diag(peak.spread)))
    assert np.max(sigma) < 1.0
    # Errors of 20 tiles along two axes are within what is stated, which is not ten times as much.
    pull = np.sqrt(np.mean((np.array(off) / np.array(sigma)) ** 2))
    assert 0.1 < pull < 1.2


@pytest.mark.parametrize("angle", [0, 30, 90])
def test_a_seam_tells_nothing_of_its_own_direction(angle):
    along = np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])
    found = [peak for seed in range(20) if (peak := find(weld(along), seed)) is not None]
    assert len(found) >= 5
    for peak in found:
        variance, axes = np.linalg.eigh(peak.spread)
        assert abs(axes[:, 1] @ along) > 0.95
        # It is not known to a fraction of a pixel, as it is across.
        assert np.sqrt(variance[1]) > 1.0 > 2 * np.sqrt(variance[0])
        assert abs((peak.place - MARGIN) @ axes[:, 0]) < 3 * np.sqrt(variance[0])


def test_of_two_places_that_are_alike_none_is_found():
    tile = grow(1)[MARGIN:-MARGIN, MARGIN:-MARGIN]
    twice = np.hstack([tile, tile])
    twice = np.pad(twice, ((2, 2), (2, 2)))
    assert find_peak(correlate(tile, twice, tile.size // 2), tile.size) is None
