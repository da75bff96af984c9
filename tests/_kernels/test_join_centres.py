"""Centres are joined to the surface that they lie on, flat or bent, and no nearer than it shows."""

import numpy as np
import pytest

from murkscan._kernels.join_centres import join_centres

LINES, FRAMES, SAME = np.arange(-20.0, 21.0), np.arange(-2.0, 3.0), 60
ROUGH = 0.01


def join_surface(bend: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Join noisy centres of a surface that bends so over frames; errors and what they are told."""
    random = np.random.default_rng(7)
    lines, times = np.tile(LINES, len(FRAMES)), np.repeat(FRAMES, len(LINES))
    zero, starts = np.zeros(len(lines)), len(LINES) * np.arange(len(FRAMES) + 1)
    first, last = starts[2] + 10, starts[3] - 10
    surface, parts = bend * times**2 + 0.005 * lines**2, []
    for _ in range(SAME):
        joined = join_centres(
            lines, times, surface + random.normal(0.0, sigma, len(lines)), zero + sigma, zero, zero,
            zero + ROUGH, starts, first, last, 8.0, 1.0, 1.0, 0.0, 0.0,
        )  # fmt: skip
        parts.append(joined - np.stack([surface, zero], axis=1)[first:last])
    off, told = np.concatenate(parts).T
    return off, told


@pytest.mark.parametrize(("bend", "sigma"), [(0.08, 0.1), (0.2, 0.03), (0.2, 0.1), (0.2, 0.3)])
def test_a_bent_surface_is_not_drawn_flat(bend, sigma):
    off, told = join_surface(bend, sigma)
    assert abs(off.mean()) < 0.15 * told.mean()
    assert 0.62 < np.mean(np.abs(off) < told) < 0.8


@pytest.mark.parametrize("sigma", [0.1, 0.3, 0.8])
def test_a_flat_surface_pays_little_for_what_bends(sigma):
    off, told = join_surface(0.0, sigma)
    # Where curvature is not held at all, it is up to a quarter more than where it is known.
    assert np.sqrt(np.mean(off**2)) < 1.1 * told.min()
    assert 0.62 < np.mean(np.abs(off) < told) < 0.75
