"""Statistics of pictures are those that sorting all their levels gives."""

import numpy as np
import pytest

from murkscan._kernels.alike import average_alike
from murkscan._kernels.smallest import find_smallest, sum_smallest
from murkscan.extract.quantiles import count_levels_of, quantile_of_counts


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
@pytest.mark.parametrize("frames", [1, 9, 48])
def test_the_smallest_levels_are_those_that_sorting_finds(depth, frames):
    top = np.iinfo(depth).max
    stack = np.random.default_rng(0).integers(0, top, (frames, 1100), depth, endpoint=True)
    ordered = np.sort(stack, axis=0)
    for rank in (0, frames // 2, frames - 1):
        found = find_smallest(stack, rank)
        assert np.array_equal(found, ordered[rank])
        total = ordered[: rank + 1].astype(int).sum(axis=0)
        assert np.array_equal(sum_smallest(stack, rank + 1, found), total)


@pytest.mark.parametrize("share", [0.0, 0.5, 0.9999, 1.0])
@pytest.mark.parametrize("shape", [(1, 1), (30, 41), (30, 40)])
def test_counted_levels_have_the_quantiles_of_the_levels_themselves(share, shape):
    image = np.random.default_rng(1).integers(0, 3000, shape).astype(np.uint16)
    known = quantile_of_counts(count_levels_of(image), share)
    assert known == pytest.approx(np.quantile(image, share), abs=1e-9)


def test_a_particle_does_not_count_in_a_mean():
    """Nor does what is not known; the median of an even number lies half way."""
    values = np.array([[3.0, 5, 4, 90], [np.nan, 4, 90, 3], [np.nan] * 4, [7, np.nan, np.nan, 9]])
    means, counts = average_alike(values, np.array([1.0, 0, 0, 0, 255]), 3.0, 1.5)
    assert means == pytest.approx([4.0, 3.5, 0.0, 8.0])
    assert counts == pytest.approx([3, 2, 1, 2])
