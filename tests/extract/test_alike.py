"""How far errors are alike is told from centres alone, whatever the surface."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from murkscan.extract.alike import Alike
from murkscan.types.background import Noise

FRAMES, LENGTH, SIGMA = 5, 600, 0.05
LINES = np.arange(LENGTH)
NOISE = Noise(1.0, 0.0, 255.0, shared=True)
WAVES = 3 * np.sin(LINES / 60)
EVEN = np.zeros(LENGTH)
ROOF = 0.8 * np.abs(LINES % 60 - 30)
"""A surface with an edge every thirty scan lines."""


def _measure(surface, *, along=0.0, same=0.0, count=FRAMES, half=False, noise=NOISE, drawn=EVEN):
    """Measure centres with noise that lines share (a Gaussian of 1σ), and frames (a share)."""
    rng = np.random.default_rng(1)
    error = rng.standard_normal((count, LENGTH))
    error = np.sqrt(1 - same) * error + np.sqrt(same) * rng.standard_normal(LENGTH)
    error = gaussian_filter1d(error, along) if along else error
    centres = surface + SIGMA * error / error.std()
    lines = np.tile(LINES.astype(float), (count, 1))
    lines[1::2] += 0.5 * half
    starts = LENGTH * np.arange(count + 1)
    sigma = np.full(centres.size, SIGMA)
    uneven = np.tile(drawn, count)
    return Alike.of(lines.ravel(), centres.ravel(), sigma, uneven, starts, noise=noise)


@pytest.mark.parametrize("surface", [WAVES, ROOF])
def test_a_surface_is_no_noise_that_frames_share(surface):
    alike = _measure(surface)
    assert alike.lines < 1.4
    assert alike.same < 0.05


def test_noise_that_neighbours_share_is_measured_with_its_length():
    """A Gaussian of 1σ a leaves noise alike over 2 √π a lines, 2.8 here."""
    assert 1.6 <= _measure(WAVES, along=0.8).lines <= 3.5


@pytest.mark.parametrize("surface", [WAVES, ROOF])
@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("same", [0.3, 0.7])
def test_noise_that_frames_share_is_measured(surface, half, same):
    """Of 600 lines' 10 pairs, of 5 frames, a correlation is known to 0.04."""
    assert _measure(surface, same=same, half=half).same == pytest.approx(same, abs=0.1)


def test_few_centres_and_single_frames_tell_nothing():
    assert _measure(WAVES, count=1).same == 0.0
    few = np.arange(40.0)
    alone = Alike.of(few, few, np.ones(40), np.zeros(40), np.array([0, 40]), noise=NOISE)
    assert alone == Alike()


def test_a_rough_surface_is_seen_but_no_error_where_pixels_share_none():
    walk = np.cumsum(0.1 * np.random.default_rng(2).standard_normal(LENGTH))
    alike = _measure(walk, noise=Noise(1.0, 0.0, 255.0))
    assert alike.seen > 0.3
    assert alike.same == 0.0


@pytest.mark.parametrize("share", [0.0, 0.5, 0.9])
def test_it_is_measured_by_how_much_uneven_light_draws_centres(share):
    """Sizes of 150 lines' differences, four of which are one independent, have a median to 15 %."""
    drawn = np.where(LINES % 60 < 15, 4 * SIGMA, 0.0)
    off = share * drawn * np.random.default_rng(3).standard_normal(LENGTH)
    assert _measure(WAVES + off, drawn=drawn).drawn == pytest.approx(share, abs=0.25)
