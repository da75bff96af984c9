"""The chain's posterior is that of all ways through it, added up one by one."""

import math

import numpy as np
import pytest

from murkscan._kernels.chain import follow_chain

NEAR, WIDE, NEAR_SHARE, WIDE_SHARE, SCALE = BENDS = np.array([0.25, 1.2, 0.80, 0.19, 0.35])
LENGTH, BIRTH, DEATH, MISS = 300, 0.02, 0.1, 0.04
LINES, MOST = 6, 2


def _weigh_link(step, change, gap):
    """Write the docstrings' densities down as they stand."""
    density = (1 - NEAR_SHARE - WIDE_SHARE) / LENGTH
    if step < 12 * gap:
        narrow, broad = NEAR * gap + 0.1, WIDE * gap
        density += NEAR_SHARE * math.exp(-step / narrow) / (2 * narrow)
        density += WIDE_SHARE * math.exp(-step / broad) / (2 * broad)
    spread = SCALE * math.sqrt(gap)
    off = abs(change) / spread
    like = 0.85 * math.exp(-min(off, off**2 / 2)) / (2.6 * spread) + 0.0375
    return (1 - DEATH) * MISS ** (gap - 1) * density * like


def _walk(places, heights, evidence, line, ridge):
    """List weight and ridges of every way on from a ridge of a line, or from none (-1)."""
    if line == LINES - 1:
        yield 1.0, ()
        return
    if ridge < 0:
        steps = [(line + 1, -1, 1 - BIRTH)]
        steps += [(line + 1, k, BIRTH / LENGTH / 4) for k in range(MOST)]
    else:
        steps = [(line + 1, -1, DEATH)]
        for gap in range(1, min(4, LINES - 1 - line) + 1):
            for k in range(MOST):
                step = abs(places[line + gap, k] - places[line, ridge])
                change = math.log(heights[line + gap, k] / heights[line, ridge])
                steps.append((line + gap, k, _weigh_link(step, change, gap)))
    for to, k, weight in steps:
        own = ((to, k),) if k >= 0 else ()
        share = evidence[to, k] if k >= 0 else 1.0
        for onward, rest in _walk(places, heights, evidence, to, k):
            yield weight * share * onward, own + rest


@pytest.mark.parametrize("seed", range(4))
def test_the_posterior_is_that_of_all_ways_added_up(seed):
    """To 1e-7: the loops take exponentials from a short series."""
    rng = np.random.default_rng(seed)
    places = 50.0 + rng.normal(0, 3, (LINES, MOST)) + [0.0, 40.0]
    heights = np.exp(rng.normal(1.5, 0.6, (LINES, MOST)))
    evidence = np.exp(rng.normal(3, 2, (LINES, MOST))) * (rng.uniform(size=(LINES, MOST)) < 0.8)
    ways = [(1 - BIRTH, -1, ())]
    ways += [(10 * BIRTH / LENGTH / 4 * evidence[0, k], k, ((0, k),)) for k in range(MOST)]
    expected, total = np.zeros((LINES, MOST)), 0.0
    for begin, ridge, own in ways:
        for onward, rest in _walk(places, heights, evidence, 0, ridge):
            total += begin * onward
            for place in own + rest:
                expected[place] += begin * onward
    counts, ones = np.full(LINES, MOST), np.ones((LINES, MOST))
    found = follow_chain(places, heights, counts, ones, evidence, LENGTH, BIRTH, DEATH, MISS, BENDS)
    assert np.abs(found - expected / total).max() < 1e-7
