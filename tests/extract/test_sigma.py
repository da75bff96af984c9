"""The sigma of a centre holds about two thirds of the errors, whatever they come from."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from murkscan.extract import Murk
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

pytestmark = pytest.mark.without_types

HEIGHT, LENGTH, FRAMES = 140, 360, 10
LINES, ROWS = np.arange(LENGTH), np.arange(HEIGHT)[:, None]
RIG = Rig(
    Camera((LENGTH, HEIGHT), (600.0, 600.0), (180.0, 70.0)),
    (Laser.from_baseline_angle(0.2, 1.1, "y"),),
)
BLUR = 1.1
"""1σ of the lens [px]."""


def _surface(index, slope=0.0):
    """Give where a surface is seen that steps by 0.01 px from scan line to scan line by chance."""
    steps = np.cumsum(0.01 * np.random.default_rng(7).standard_normal(LENGTH))
    return 70.0 + slope * (LINES - LENGTH / 2) + 3 * np.sin(LINES / 60) + 0.1 * index + steps


def _film(light, *, slope=0.0, blur=0.0, along=0.0, glass=1.0):
    """Film a line with its light, blurred by the lens, in shot noise that neighbours share.

    The window's glass lets so much of the light pass.
    """
    rng = np.random.default_rng(0)
    frames = []
    for index in range(FRAMES):
        off = (ROWS - _surface(index, slope)) / 0.8
        picture = glass * gaussian_filter(light * np.exp(-0.5 * off**2), blur)
        noise = gaussian_filter(rng.standard_normal(picture.shape), (0.0, along))
        noise *= np.sqrt(0.3 + 0.05 * picture) / noise.std()
        image = np.clip(np.rint(picture + noise), 0, 255).astype(np.uint8)
        frames.append(Frame(image, index, index / 25))
    return frames


def _find(frames, *, slope=0.0):
    """Give error, sigma, scan line and what was put back of each centre, and the shape learnt."""
    murk = Murk()
    background = murk.learn(frames, RIG)
    parts = [np.zeros((0, 4))]
    for stripe in murk.extract(frames, RIG, background):
        line = stripe.pixels[:, 0].astype(int)
        error = stripe.pixels[:, 1] - _surface(int(stripe.frame[0]), slope)[line]
        parts.append(np.stack([error, stripe.sigma, line, stripe.blur_shift], axis=1))
    error, sigma, line, put_back = np.concatenate(parts).T
    inner = (line >= 8) & (line < LENGTH - 8)
    assert inner.sum() > 0.9 * FRAMES * (LENGTH - 16)
    found = (one[inner] for one in (error, sigma, line.astype(int), put_back))
    return *found, background.shapes[0]


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_paint_pulls_no_slanted_stripe_and_sigma_holds(slope):
    """Light that the lens mixes in from brighter scan lines would pull by slope · blur² · 0.2.

    The share is that of 3440 errors that are akin over some ten scan lines and five frames: known
    to 4 points.
    """
    paint = 90.0 * np.exp(0.8 * np.sin(LINES / 1.5) * np.sin(LINES / 23.0))
    film = _film(paint, slope=slope, blur=BLUR)
    error, sigma, line, put_back, shape = _find(film, slope=slope)
    assert 0.60 < np.mean(np.abs(error) < sigma) < 0.80
    assert np.abs(error).mean() < 0.015
    # Over as many scan lines as tell the change of light, half of this paint's is averaged out.
    assert slope == 0.0 or BLUR**2 < shape.blur < 2.0 * BLUR**2
    # And what was put back is told.
    drawn = slope * BLUR**2 * np.gradient(np.log(gaussian_filter1d(paint, BLUR)))[line]
    assert np.sum(put_back * drawn) == pytest.approx(np.sum(drawn**2), rel=0.3)


@pytest.mark.parametrize("along", [0.0, 0.8])
def test_sigma_knows_noise_that_neighbours_share(along):
    film = _film(np.full(LENGTH, 60.0), along=along)
    error, sigma, *_ = _find(film)
    assert 0.60 < np.mean(np.abs(error) < sigma) < 0.80


def test_a_scratch_on_the_window_is_not_the_surface_though_all_frames_show_it():
    """It draws centres by a quarter of a pixel; what all frames agree on errs by 0.18 px here."""
    places, angle = np.array([60, 130, 200, 280]), 1.0
    across = (LINES - places[:, None, None]) * np.sin(angle) - (ROWS - 70) * np.cos(angle)
    glass = np.prod(1 - 0.7 * np.exp(-0.5 * (across / 1.5) ** 2), axis=0)
    error, sigma, line, *_ = _find(_film(np.full(LENGTH, 110.0), blur=BLUR, glass=glass))
    near = np.abs(line[:, None] - places).min(axis=1) <= 8
    assert np.sqrt(np.mean(error[near] ** 2)) < 0.12
    assert 0.60 < np.mean(np.abs(error[~near]) < sigma[~near]) < 0.80


def test_beyond_the_end_of_a_bar_the_lens_s_light_is_no_surface():
    """Bars of 14 scan lines with holes of 8: past its end, no line has half of a bar's light."""
    bars = np.where(LINES % 22 < 14, 120.0, 0.0)
    frames, murk = _film(bars, blur=BLUR), Murk()
    found = list(murk.extract(frames, RIG, murk.learn(frames, RIG)))
    lines = np.concatenate([stripe.pixels[:, 0].astype(int) for stripe in found])
    assert np.mean(bars[lines] > 0) > 0.99
    assert len(lines) > 0.95 * FRAMES * np.sum(bars > 0)
