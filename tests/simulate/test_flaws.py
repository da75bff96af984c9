"""What stands still in the picture: each flaw by itself, against what it is said to be."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import FormatError, InputError
from murkscan.optics.beam import Beam
from murkscan.simulate import (
    Light,
    Overlay,
    Sensor,
    Simulator,
    Window,
    parse_scene,
    read_scene,
)
from murkscan.simulate.fixed_pattern import draw_fixed_pattern
from murkscan.simulate.sensor import expose
from murkscan.simulate.window import view_window

from ..scenes import QUIET, air_rig, standing, wall

SIZE = (720, 576)


def _view(window, seed=0):
    return view_window(window, SIZE, focal_length=554.0, axis="y", seed=seed)


def test_a_clean_window_changes_nothing():
    light = np.random.default_rng(0).random((576, 720), np.float32)
    np.testing.assert_array_equal(_view(Window()).pass_light(light), light)


@pytest.mark.parametrize("share", [0.005, 0.02, 0.1])
def test_dirt_covers_the_share_it_is_said_to(share):
    taken = 1 - _view(Window(dirt=share, blur=0.0)).transmission
    # The last spot may overshoot by itself: a hundred pixels or so.
    assert (taken > 0).mean() == pytest.approx(share, abs=2e-3)
    assert 0.3 < np.median(taken[taken > 0]) < 0.9


def test_dirt_takes_light_where_it_is_bright_and_gives_some_where_it_is_dark():
    view = _view(Window(dirt=0.05))
    light = np.zeros((576, 720), np.float32)
    light[:, :360] = 1.0
    seen = view.pass_light(light)
    dirty = view.transmission < 0.6
    assert (seen[:, :300][dirty[:, :300]] < 0.97).all()
    assert (seen[:, 362:370][dirty[:, 362:370]] > 0.05).all()
    assert seen.sum() < light.sum()


def test_a_scratch_is_long_and_thin():
    taken = 1 - _view(Window(scratches=1), seed=3).transmission
    rows, columns = np.nonzero(taken > 0.2)
    length = np.hypot(np.ptp(rows), np.ptp(columns))
    assert length > 200
    assert len(rows) < 5 * length


def test_the_ghost_stands_where_it_stood_and_is_as_high_as_said():
    scene = standing(wall(0.6), sensor=replace(QUIET, peak_grey=4e4))
    ghost = replace(scene, window=Window(ghost=900.0), light=Light(is_on=False))
    first = Simulator.of(ghost).draw_frame(0)
    assert first.frame.image.max(axis=0).min() > 800
    assert first.frame.image.max() <= 900
    assert len(first.stripe) == 0


def test_pixels_respond_as_unevenly_as_said_and_as_many_are_hot():
    pattern = draw_fixed_pattern(Sensor(response=0.01, hot_pixels=0.002), SIZE, seed=1)
    assert pattern.response.std() == pytest.approx(0.01, rel=0.01)
    assert (pattern.dark > 0).mean() == pytest.approx(0.002, rel=0.1)
    clean = draw_fixed_pattern(Sensor(), SIZE, seed=1)
    assert (clean.response == 1).all()
    assert (clean.dark == 0).all()


def test_a_row_s_noise_is_common_to_the_row_and_in_the_variance():
    sensor = Sensor(full_well=1e5, bits=16, read_noise=0.0, shot_noise=False, row_noise=30.0,
                    black_level=1000.0)  # fmt: skip
    dark = np.zeros((2000, 50), np.float32)
    image = expose(sensor, dark, np.random.default_rng(2)).astype(float)
    assert (image == image[:, :1]).all()
    # Two thousand rows tell the standard deviation to 1.6 %.
    assert image[:, 0].std() == pytest.approx(30.0, rel=0.06)
    told = np.sqrt(sensor.variance(dark)[0, 0]) * sensor.grey_per_electron
    assert told == pytest.approx(image[:, 0].std(), rel=0.06)


def test_a_streaky_fan_is_as_uneven_as_said_and_no_stronger():
    angles = np.linspace(-0.3, 0.3, 2001)
    even, streaky = (
        Beam.of(air_rig().lasers[0], Light(streaks=streaks), 1.34).power_per_angle(angles)
        for streaks in (0.0, 0.1)
    )
    ratio = streaky / even
    # Some 140 streaks tell the mean to a hundredth, the standard deviation to a twelfth.
    assert ratio.mean() == pytest.approx(1.0, abs=0.03)
    assert ratio.std() == pytest.approx(0.1, rel=0.25)


def test_what_is_written_over_the_picture_tells_nothing_of_the_surface():
    scene = standing(wall(0.6), sensor=replace(QUIET, read_noise=10.0))
    row = round(float(Simulator.of(scene).draw_frame(0).stripe.pixels[:, 1].mean()))
    over = Overlay(("HDG 273", "", "{time}"), text_height=20.0, border=7000.0)
    frame = Simulator.of(replace(scene, overlay=over)).draw_frame(0)
    assert (frame.frame.image[[0, -1]] == 7000).all()
    assert (frame.frame.image[:, [0, -1]] == 7000).all()
    assert 0 < row < 575
    edge = np.isin(np.rint(frame.stripe.pixels[:, 0]), (0, 719))
    assert np.isinf(frame.stripe.crlb[edge]).all()
    assert np.isfinite(frame.stripe.crlb[~edge]).all()


def test_the_clock_in_the_text_runs():
    over = Overlay(("{time}",))
    first, later = (over.draw(SIZE, time, 255) for time in (0.0, 61.5))
    assert not np.array_equal(np.isnan(first), np.isnan(later))
    np.testing.assert_array_equal(over.draw(SIZE, 0.02, 255), first)


def test_an_empty_sea_is_drawn_without_a_stripe():
    text = (
        "format = 1\n[water]\nattenuation_per_m = 3.0\nparticles_per_frame = 45\n"
        '[rig]\nfile = "rigs/pal.toml"\n[motion]\nframes = 2\nspeed_mm_s = 100.0\n'
    )
    _, _, folder = read_scene("plane")
    frame = Simulator.of(parse_scene(text, "sea", folder)).draw_frame(0)
    assert len(frame.stripe) == 0
    assert frame.light.lasers[0].glow.max() > 0
    with pytest.raises((InputError, FormatError), match="empty sea"):
        parse_scene(text + "[sensor]\npeak_grey = 200\n", "sea", folder)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (lambda: Window(dirt=0.9), "window.dirt_percent"),
        (lambda: Window(scratches=-1), "window.scratches"),
        (lambda: Window(ghost=-1.0), "window.ghost_grey"),
        (lambda: Overlay(("a",) * 5), "overlay.text"),
        (lambda: Overlay(border=-1.0), "overlay.border_grey"),
        (lambda: Light(streaks=2.0), "light.streaks_percent"),
        (lambda: Sensor(hot_pixels=0.9), "hot_pixels_percent must lie between 0 and 50"),
    ],
)
def test_flaws_that_cannot_be_are_refused(settings, words):
    with pytest.raises(InputError, match=words):
        settings()


def test_flaws_follow_the_seed():
    same, again, other = (_view(Window(dirt=0.02), seed=seed).transmission for seed in (0, 0, 1))
    np.testing.assert_array_equal(same, again)
    assert not np.array_equal(same, other)


def test_a_translucent_surface_makes_a_band_of_the_same_light_about_the_same_centre():
    thin, broad = (
        Simulator.of(standing(wall(0.6, translucency=translucency))).draw_light(0).lasers[0]
        for translucency in (0.0, 0.005)
    )
    column = 360
    rows = np.arange(576)
    centre, light = thin.line.positions[column], broad.stripe[:, column].astype(float)
    assert light.sum() == pytest.approx(thin.stripe[:, column].sum(), rel=0.01)
    # What spreads evenly on the slanting wall is not quite even in the picture.
    assert (light * rows).sum() / light.sum() == pytest.approx(centre, abs=0.1)
    width = np.sqrt((light * (rows - centre) ** 2).sum() / light.sum())
    # 5 mm across the sheet, which meets the wall at atan(0.6 / 0.25); 554 px a radian at 0.6 m.
    assert width == pytest.approx(0.005 / np.sin(np.arctan2(0.6, 0.25)) * 554 / 0.6, rel=0.05)
