"""What real pictures have beside the stripe: dirt, rims, rows with noise, bands of white."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from scipy.special import ndtr

from murkscan._kernels.plateaus import measure_plateaus
from murkscan.extract import Murk
from murkscan.extract.clutter import bound_by_stays, usual_stays
from murkscan.extract.edges import weigh_edges
from murkscan.extract.matched_filter import MatchedFilter
from murkscan.extract.scan_lines import ScanLines
from murkscan.types.background import Noise
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.rig import Rig

pytestmark = pytest.mark.without_types

HEIGHT, LENGTH = 160, 240
"""Pixels across the stripe and along it."""
RIG = Rig(
    Camera((LENGTH, HEIGHT), (600.0, 600.0), (120.0, 80.0)),
    (Laser.from_baseline_angle(0.2, 1.1, "y"),),
)
LINES = np.arange(LENGTH)
ROWS = np.arange(HEIGHT)[:, None]


def _line(centres, peak, *, width=1.3):
    return peak * np.exp(-0.5 * ((ROWS - centres) / width) ** 2)


def _film(light, *, rows=0.0, seed=0):
    """Keep light as a sensor does, with shot and read noise, and noise that a row has in common."""
    rng = np.random.default_rng(seed)
    frames = []
    for index, one in enumerate(light):
        noise = np.sqrt(0.04 + 0.03 * one) * rng.standard_normal(one.shape)
        noise += rows * rng.standard_normal((HEIGHT, 1))
        image = np.clip(np.rint(one + noise), 0, 255).astype(np.uint8)
        frames.append(Frame(image, index, index / 25))
    return frames


def _extract(frames):
    murk = Murk()
    return list(murk.extract(frames, RIG, murk.learn(frames, RIG)))


def _dirt(rng):
    """Draw hot pixels, and a ghost that is brighter than the stripe."""
    picture = _line(40.0 + 0.02 * LINES, 60.0)
    hot = rng.random(picture.shape) < 0.01
    return picture + np.where(hot, rng.uniform(40, 200, picture.shape), 0.0)


def _errors(stripes, truth):
    return np.concatenate(
        [s.pixels[:, 1] - truth(i)[s.pixels[:, 0].astype(int)] for i, s in enumerate(stripes)]
    )


def test_a_ghost_and_hot_pixels_are_no_stripe_where_the_stripe_moves():
    dirt = _dirt(np.random.default_rng(1))
    stripes = _extract(
        _film([8.0 + dirt + _line(80.0 + 0.8 * i + 0 * LINES, 40.0) for i in range(24)])
    )
    off = np.abs(_errors(stripes, lambda i: 80.0 + 0.8 * i + 0 * LINES))
    assert len(off) > 0.97 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.985


def test_a_still_stripe_that_flickers_is_found_beside_a_ghost_that_does_not():
    """Paint that passes by changes a stripe's height by a third; a ghost keeps its own."""
    rng = np.random.default_rng(2)
    dirt, paint = _dirt(rng), 1.0 + 0.35 * rng.standard_normal((24, LENGTH // 12))
    heights = np.repeat(np.clip(paint, 0.3, None), 12, axis=1)
    stripes = _extract(_film([8.0 + dirt + h * _line(100.0 + 0 * LINES, 40.0) for h in heights]))
    off = np.abs(_errors(stripes, lambda _: 100.0 + 0 * LINES))
    assert np.sum(off < 1.5) > 0.95 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.98


def test_of_two_lines_that_stand_still_in_a_scan_line_the_steadier_is_a_ghost():
    """Glow that passes behind a ghost lets it flicker, but less than paint lets the stripe."""
    rng = np.random.default_rng(2)
    paint = np.clip(1.0 + 0.35 * rng.standard_normal((24, LENGTH // 12)), 0.3, None)
    glow = 1.0 + 0.15 * rng.standard_normal((24, 1))
    ghost = np.where(LINES < 80, _line(40.0 + 0.02 * LINES, 60.0), 0.0)
    heights, stripe = np.repeat(paint, 12, axis=1), _line(100.0 + 0 * LINES, 40.0)
    light = [8.0 + g * ghost + h * stripe for g, h in zip(glow, heights, strict=True)]
    off = np.abs(_errors(_extract(_film(light)), lambda _: 100.0 + 0 * LINES))
    assert np.sum(off < 1.5) > 0.95 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.98


def _marks(rng):
    """Draw short faint pieces of lines, as an encoder's blocks make them."""
    picture = np.zeros((HEIGHT, LENGTH))
    for _ in range(60):
        row, column = rng.integers(3, HEIGHT - 3), rng.integers(0, LENGTH - 7)
        picture[row - 1 : row + 2, column : column + 7] += 3.0
    return picture


@pytest.mark.parametrize("many", [0.0, 1.0])
def test_it_is_learnt_that_clutter_stays_where_it_does(many):
    """Two thirds of the frames have the marks of one of two sets, the others their own."""
    rng = np.random.default_rng(4)
    sets = [_marks(rng), _marks(rng)]
    marks = [sets[i // 2 % 2] if i % 3 else _marks(rng) for i in range(24)]
    light = [8.0 + _line(20.0 + 4.0 * i + 0 * LINES, 60.0) + many * m for i, m in enumerate(marks)]
    stays = Murk().learn(_film(light), RIG).stays
    assert (stays[1:4] > 0.5).all() if many else (stays[1:4] < 0.1).all()


def test_what_frames_say_is_bounded_by_the_clutter_that_stays():
    said, heights = np.array([[7.2, -10.0, 0.0]]), np.full((1, 3), 5.0)
    few, many = np.full(len(usual_stays()), 1e-6), np.full(len(usual_stays()), 0.4)
    assert bound_by_stays(said, heights, few) == pytest.approx(said, abs=2e-3)
    bounded = bound_by_stays(said, heights, many)[0]
    assert bounded[0] < -np.log(0.4)
    assert bounded[1] == pytest.approx(-10.0 - np.log(0.6), abs=1e-3)
    assert bounded[2] == 0.0


def test_with_the_laser_off_dirt_is_no_stripe():
    dirt = 8.0 + _dirt(np.random.default_rng(3))
    assert sum(len(stripe) for stripe in _extract(_film([dirt] * 24))) == 0


def test_an_even_stripe_that_stands_still_in_a_clean_picture_is_found():
    stripes = _extract(_film([8.0 + _line(100.0 + 0 * LINES, 40.0)] * 24))
    assert sum(len(stripe) for stripe in stripes) == 24 * LENGTH


def test_a_wide_stripe_that_moves_by_less_than_its_width_is_not_fixed():
    """Some of it is lit in all frames, as a bed's stripe is on a stage that sinks a little."""
    near = LINES >= 160
    truth = [np.where(near, 98.0 + 5.0 * (i > 11), 60.0 + 2.0 * i) for i in range(24)]
    peak, width = np.where(near, 500.0, 150.0), np.where(near, 2.5, 1.6)
    light = [np.minimum(8.0 + _line(one, peak, width=width), 255.0) for one in truth]
    off = np.abs(_errors(_extract(_film(light)), lambda i: truth[i]))
    assert np.sum(off < 0.5) > 0.97 * 24 * LENGTH


def test_a_band_of_white_is_found_beside_glare():
    column = np.full(60, 20.0)
    column[20:30], column[[30, 31]], column[5:20] = 255.0, (180.0, 60.0), 170.0
    law = np.array([1.0, 0.0, 0.0, 1.0, 250.0])
    middle, sigma, _, _ = measure_plateaus(
        column[:, None], np.zeros(1, int), np.array([25.0]), law
    )[0]
    assert abs(middle - 24.8) < 1.0
    assert sigma < 1.0


@pytest.mark.parametrize("many", [1, 12])
def test_a_bright_rim_of_the_picture_is_no_stripe(many):
    light = [8.0 + _line(80.0 + 0.5 * i + 0 * LINES, 40.0) for i in range(many)]
    for one in light:
        one[[0, -1]] = 150.0
        one[:, [0, -1]] = 150.0
    stripes = _extract(_film(light))
    off = np.abs(_errors(stripes, lambda i: 80.0 + 0.5 * i + 0 * LINES))
    assert len(off) == many * (LENGTH - 2)
    assert off.max() < 1.5


def test_noise_that_rows_have_in_common_is_no_stripe_and_hides_none():
    assert sum(len(s) for s in _extract(_film([8.0 + 0 * ROWS + 0.0 * LINES] * 12, rows=1.0))) == 0
    hull = [90.0 + 12.0 * np.sin(LINES / 40.0) + 0.5 * i for i in range(12)]
    stripes = _extract(_film([8.0 + _line(one, 12.0) for one in hull], rows=1.0))
    off = np.abs(_errors(stripes, lambda i: hull[i]))
    assert len(off) > 0.97 * 12 * LENGTH
    assert np.mean(off < 1.5) > 0.99


@pytest.mark.parametrize("width", [4.0, 8.0])
def test_a_band_of_white_is_found_by_both_its_edges(width):
    """The peak is four times what the sensor holds; light on one side adds a slope."""
    truth = [80.0 + 0.05 * LINES + 0.31 * i for i in range(12)]
    light = [8.0 + 0.05 * ROWS + _line(one, 1000.0, width=width) for one in truth]
    stripes = _extract(_film([np.minimum(one, 255.0) for one in light]))
    off = _errors(stripes, lambda i: truth[i])
    assert len(off) > 0.97 * 12 * LENGTH
    # Both flanks are one in a thousand steeper than what the slope adds.
    assert abs(off.mean()) < 0.05
    assert np.abs(off).max() < 0.5
    assert all((stripe.signal <= 255).all() for stripe in stripes)


def _blurred(thin):
    """Give light of a line as a lens does that blurs it alike along and across."""
    return gaussian_filter(thin, 1.3) * 1.3 * np.sqrt(2 * np.pi)


@pytest.mark.parametrize("slope", [0.0, 0.7])
def test_beyond_its_ends_a_stripe_s_blur_is_no_surface(slope):
    """Pieces of 12 lines with gaps as long: blur reaches five lines into each gap."""
    lit = LINES // 12 % 2 == 0
    wall = replace(RIG, lasers=(Laser.from_sheet(Plane(_unit(-slope, 1.0, -0.5), 0.2)),))
    light = []
    for i in range(8):
        thin = np.zeros((HEIGHT, LENGTH))
        centres = (
            60.0 + 0.5 * i - slope * (LINES - 120) * 0.25 if slope else 60.0 + 0.5 * i + 0 * LINES
        )
        for k in np.flatnonzero(lit):
            row = int(centres[k])
            share = centres[k] - row
            thin[row, k], thin[row + 1, k] = 100.0 * (1 - share), 100.0 * share
        light.append(8.0 + _blurred(thin))
    frames = _film(light)
    murk = Murk()
    stripes = list(murk.extract(frames, wall, murk.learn(frames, wall)))
    found = np.concatenate([s.pixels[:, 0].astype(int) for s in stripes])
    ends = np.minimum(LINES % 12, 11 - LINES % 12)
    assert np.mean(lit[found]) > 0.95
    assert np.sum(~lit[found] & (ends[found] >= 1)) == 0
    assert np.sum(lit[found]) > 0.95 * 8 * lit.sum()


def test_beside_a_stripe_that_stands_along_the_rows_their_noise_is_none():
    """Where rows are freed of their noise, the still stripe must not leave a ditch in its gaps."""
    gap = (LINES > 100) & (LINES < 140)
    glow = 20.0 * np.exp(-0.5 * ((ROWS - 80.0) / 12.0) ** 2)
    light = [8.0 + glow + np.where(gap, 0.0, _line(80.0 + 0 * LINES, 100.0))] * 12
    found = np.concatenate([s.pixels[:, 0].astype(int) for s in _extract(_film(light, rows=1.0))])
    assert np.sum(gap[found]) < 0.01 * len(found)
    assert np.sum(~gap[found]) > 0.98 * 12 * (~gap).sum()


def _unit(*vector):
    return np.array(vector) / np.linalg.norm(vector)


SHEETS = {
    "beside": (Plane(_unit(0.0, 0.9, -0.44), 0.19), Plane(_unit(0.0, 0.9, -0.52), 0.19)),
    "crossed": (Plane(_unit(0.0, 0.9, -0.44), 0.19), Plane(_unit(0.3, 0.9, -0.44), 0.19)),
}


@pytest.mark.parametrize("sheets", SHEETS)
def test_each_of_two_lasers_has_its_own_stripe(sheets):
    """The wall comes nearer, and has relief."""
    rig = replace(RIG, lasers=tuple(Laser(sheet, "y") for sheet in SHEETS[sheets]))
    (fx, fy), (cx, cy) = RIG.camera.focal_length, RIG.camera.principal_point
    truth = np.empty((12, 2, LENGTH))
    for i in range(12):
        z = 0.42 + 0.03 * np.sin(0.1 * i) + 0.004 * np.sin(LINES / 9.0 + i)
        for number, sheet in enumerate(SHEETS[sheets]):
            x = (LINES - cx) / fx * z
            y = -(sheet.distance + sheet.normal[0] * x + sheet.normal[2] * z) / sheet.normal[1]
            truth[i, number] = cy + fy * y / z
    frames = _film([8.0 + np.maximum(*(_line(one, 60.0) for one in pair)) for pair in truth])
    apart = np.abs(truth[:, 0] - truth[:, 1]) > 6.0
    murk = Murk()
    for number in (0, 1):
        stripes = murk.extract(frames, rig, murk.learn(frames, rig, laser=number), laser=number)
        right = count = 0
        for i, stripe in enumerate(stripes):
            line = stripe.pixels[:, 0].astype(int)
            clear = apart[i, line]
            off = np.abs(stripe.pixels[clear, 1] - truth[i, number, line[clear]])
            right, count = right + np.sum(off < 1.5), count + len(off)
        assert right > 0.99 * count
        assert right > 0.97 * apart.sum()


def test_round_white_spots_are_no_stripe_and_hide_none_beside():
    """Bubbles out of focus drift past: white discs of 8 to 30 px with a halo."""
    rng = np.random.default_rng(4)
    places = rng.uniform((0, 10), (45, LENGTH - 10), (12, 2))
    sizes = rng.uniform(4, 15, 12)
    light = []
    for i in range(12):
        one = 8.0 + _line(115.0 + 0.5 * i + 0 * LINES, 40.0)
        for (row, column), size in zip(places, sizes, strict=True):
            away = np.hypot(ROWS - row - 2.5 * i, LINES - column)
            one += 400.0 / (1.0 + np.exp(np.clip((away - size) / 0.8, -30, 30)))
        light.append(np.minimum(one, 255.0))
    off = np.abs(_errors(_extract(_film(light)), lambda i: 115.0 + 0.5 * i + 0 * LINES))
    assert np.sum(off < 1.5) > 0.93 * 12 * LENGTH
    assert np.mean(off < 1.5) > 0.97


def test_a_faint_stripe_on_a_lit_textured_wall_keeps_its_width():
    """The wall passes by under a lamp; the stripe has a tenth of its light."""
    rng = np.random.default_rng(5)
    paint = gaussian_filter(rng.standard_normal((HEIGHT + 200, LENGTH)), 9.0)
    paint = 120.0 * (1.0 + 0.05 * paint / paint.std())
    light = [
        paint[3 * i : 3 * i + HEIGHT] + _line(80.0 + 0.4 * i + 0 * LINES, 12.0) for i in range(24)
    ]
    frames = _film(light)
    murk = Murk()
    learnt = murk.learn(frames, RIG)
    assert learnt.shapes[0].width * learnt.shapes[0].binning == pytest.approx(1.3, rel=0.25)
    stripes = list(murk.extract(frames, RIG, learnt))
    off = np.abs(_errors(stripes, lambda i: 80.0 + 0.4 * i + 0 * LINES))
    assert np.sum(off < 1.5) > 0.9 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.97


def test_faint_lines_that_pass_beside_a_still_stripe_do_not_make_it_a_flaw_of_the_picture():
    """In a lamp's light paint has edges everywhere; a stripe that keeps still is far brighter."""
    rng = np.random.default_rng(11)
    paint = np.repeat(1.0 + 0.2 * rng.standard_normal((24, LENGTH // 12)), 12, axis=1)
    edges = [_line(40.0 + 1.5 * i + 0 * LINES, 14.0) for i in range(24)]
    still = _line(110.0 + 0 * LINES, 120.0)
    light = [60.0 + edge + height * still for edge, height in zip(edges, paint, strict=True)]
    off = np.concatenate([s.pixels[:, 1] - 110.0 for s in _extract(_film(light))])
    assert np.sum(np.abs(off) < 1.5) > 0.97 * 24 * LENGTH


@pytest.mark.parametrize("blur", [0.4, 1.3])
def test_an_edge_of_what_is_lit_is_no_stripe(blur):
    """A wall that daylight meets below a shadow passes, and half of it shows the stripe."""
    light = []
    for i in range(24):
        lit = 70.0 * (80.0 + 1.5 * i + 0.1 * LINES < ROWS)
        stripe = _line(50.0 + 1.5 * i + 0 * LINES, 25.0) * (LINES < LENGTH // 2)
        light.append(20.0 + gaussian_filter(lit, blur) + stripe)
    off = np.abs(_errors(_extract(_film(light)), lambda i: 50.0 + 1.5 * i + 0 * LINES))
    assert np.sum(off < 1.5) > 0.95 * 24 * LENGTH // 2
    assert np.mean(off < 1.5) > 0.98


def _weigh(picture, places):
    """Weigh what lies at places, one a scan line, as ridges of 10 standard deviations."""
    frame = Frame(np.rint(picture).astype(np.uint8), 0, 0.0)
    noise = Noise(1.0, 0.0, 255.0, 1.0)
    lines = ScanLines.of(frame, "y", noise=noise)
    return weigh_edges(lines, MatchedFilter.of(1.3, noise), LINES, places, np.full(LENGTH, 10.0))


@pytest.mark.parametrize("width", [0.9, 1.3, 1.8])
def test_stripes_and_edges_are_told_apart_by_the_filter_that_found_them(width):
    """Wherever in its pixel it lies, whichever side is bright, on whatever slope."""
    noise = 2.0 * np.random.default_rng(2).standard_normal((HEIGHT, LENGTH))
    places = 80.0 + LINES / LENGTH
    away = ROWS - places
    slope = 60.0 + 0.2 * away
    stripe = _weigh(slope + _line(places, 40.0, width=width) + noise, places)
    assert np.median(stripe) == 0.0
    assert np.mean(stripe > -1.0) > 0.95
    for side in (-1, 1):
        # Filters for ridges answer an edge most a stripe's width from it, on its bright side.
        edge = _weigh(slope + 40.0 * ndtr(side * away / 0.7) + noise, places + side * 1.3)
        assert np.mean(edge < -3.0) > 0.95


def test_light_beside_an_edge_is_a_stripe():
    """Where the sheet meets an object's silhouette, both are there."""
    places = 80.0 + 0 * LINES
    edge = 20.0 * ndtr((ROWS - places - 4.0) / 0.7)
    assert (_weigh(60.0 + edge + _line(places, 60.0), places) == 0.0).all()
