"""What Murk promises beyond what every extractor does: it knows noise, snow, edges and gloss."""

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.extract import Murk
from murkscan.extract.neighbours import with_neighbours
from murkscan.extract.noise import learn_levels
from murkscan.types.background import Background
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

pytestmark = pytest.mark.without_types

HEIGHT, LENGTH = 160, 240
"""Pixels across the stripe and along it."""
GAIN, READ = 0.03, 0.04
"""Variance of a pixel: that of 9000 electrons in 255 grey levels, read with 9."""
RIG = Rig(
    Camera((LENGTH, HEIGHT), (600.0, 600.0), (120.0, 80.0)),
    (Laser.from_baseline_angle(0.2, 1.1, "y"),),
)
LINES = np.arange(LENGTH)


def _light(centres, peak, *, width=1.3):
    """Draw the stripe's light; NaN where a scan line has none."""
    off = (np.arange(HEIGHT)[:, None] - centres) / width
    return np.nan_to_num(peak * np.exp(-0.5 * off**2))


def _film(light, *, seed=0):
    """Keep light as a sensor does: each frame with its own shot and read noise."""
    rng = np.random.default_rng(seed)
    frames = []
    for index, one in enumerate(light):
        noise = np.sqrt(READ + GAIN * one) * rng.standard_normal(one.shape)
        image = np.clip(np.rint(one + noise), 0, 255).astype(np.uint8)
        frames.append(Frame(image, index, index / 25))
    return frames


def _glow():
    """Give a glow that is 100 times brighter where it is near than a faint stripe far away."""
    return 12.0 + 120.0 * np.exp(-np.arange(HEIGHT)[:, None] / 30.0) * np.ones(LENGTH)


def _hull(index):
    """Give where a gently bent surface is seen in a frame."""
    return 95.0 + 12.0 * np.sin(LINES / 70.0) + 0.3 * index


def _extract(frames, extractor=None):
    extractor = extractor or Murk()
    background = extractor.learn(frames, RIG)
    return list(extractor.extract(frames, RIG, background))


def test_a_faint_stripe_is_found_beneath_a_bright_glow():
    """A peak of 6 on glow of 18 to 25 has a noise of 0.85: a sixth of it, on 3 pixels or so."""
    stripes = _extract(_film([_glow() + _light(_hull(i), 6.0) for i in range(12)]))
    errors = np.concatenate(
        [s.pixels[:, 1] - _hull(i)[s.pixels[:, 0].astype(int)] for i, s in enumerate(stripes)]
    )
    assert len(errors) > 0.97 * 12 * LENGTH
    assert np.mean(np.abs(errors) < 1.5) > 0.99


def test_snow_is_no_stripe():
    """Forty bright particles a frame, each in one frame only, with and without a stripe.

    A particle right before the stripe is brighter than it, and may be taken for it; what lies
    elsewhere may not.
    """
    rng = np.random.default_rng(1)
    light, nearest = [], []
    for i in range(12):
        one, near = _glow(), np.full(len(LINES), np.inf)
        for u, v in zip(rng.uniform(0, LENGTH, 40), rng.uniform(0, HEIGHT, 40), strict=True):
            apart = (np.arange(HEIGHT)[:, None] - v) ** 2 + (LINES - u) ** 2
            one = one + rng.uniform(20, 120) * np.exp(-0.5 * apart / 1.5**2)
            near = np.minimum(near, np.hypot(LINES - u, _hull(i) - v))
        light.append(one)
        nearest.append(near)
    assert sum(len(stripe) for stripe in _extract(_film(light))) == 0
    found = _extract(_film([one + _light(_hull(i), 25.0) for i, one in enumerate(light)]))
    lines = [s.pixels[:, 0].astype(int) for s in found]
    off = np.concatenate([found[i].pixels[:, 1] - _hull(i)[line] for i, line in enumerate(lines)])
    free = np.concatenate([nearest[i][line] > 8 for i, line in enumerate(lines)])
    assert np.mean(free) > 0.7
    assert np.mean(np.abs(off[free]) < 1.5) > 0.997
    assert np.mean(np.abs(off[~free]) < 1.5) > 0.9


@pytest.mark.parametrize("overlap", [10, 20])
def test_an_occlusion_shows_both_surfaces(overlap):
    """The far surface goes on behind the near one's edge for some scan lines."""
    near = np.where(LINES < 120, 60.0 + 0.05 * LINES, np.nan)
    is_far = 120 - overlap <= LINES
    far = np.where(is_far, 100.0 + 0.05 * LINES, np.nan)
    (stripe,) = _extract(_film([8.0 + _light(near, 90.0) + _light(far, 60.0)]))
    both = np.unique(stripe.pixels[stripe.branch == 1, 0])
    assert set(both) <= set(LINES[is_far & (LINES < 120)])
    assert len(both) >= 0.9 * overlap


def test_a_reflection_beside_the_stripe_is_left_out():
    """A line that runs beside the stripe all along, a third as bright, is no surface."""
    light = [8.0 + _light(_hull(i), 90.0) + _light(_hull(i) - 35.0, 30.0) for i in range(6)]
    stripes = _extract(_film(light))
    for i, stripe in enumerate(stripes):
        off = stripe.pixels[:, 1] - _hull(i)[stripe.pixels[:, 0].astype(int)]
        assert np.abs(off).max() < 1.5
        assert len(stripe) == LENGTH


def test_a_step_in_depth_stays_where_it_is():
    """Neighbours are not joined over a jump: the first centre behind it is on the other side."""
    step = np.where(LINES < 120, 60.0, 80.0)
    stripes = _extract(_film([8.0 + _light(step, 40.0) for _ in range(6)]))
    for stripe in stripes:
        off = stripe.pixels[:, 1] - step[stripe.pixels[:, 0].astype(int)]
        assert np.abs(off).max() < 1.0


@pytest.mark.parametrize("peak", [12.0, 60.0, 180.0])
def test_sigma_holds_two_thirds_of_the_errors_on_a_rough_surface(peak):
    """Surfaces are taken to be rough by 0.04 px from scan line to scan line; this one is so.

    Its steps of 0.033 px a line put each line 0.04 px off the line between its neighbours'. Chance
    moves 4800 errors by 1 point, their kinship with neighbours by 3, the guess of a law by more.
    """
    steps = 0.033 * np.random.default_rng(3).standard_normal(LENGTH)
    centres = [_hull(i) + np.cumsum(steps) for i in range(20)]
    within = [
        np.abs(s.pixels[:, 1] - centre[s.pixels[:, 0].astype(int)]) < s.sigma
        for s, centre in zip(
            _extract(_film([8.0 + _light(centre, peak) for centre in centres])),
            centres,
            strict=True,
        )
    ]
    assert np.concatenate(within).mean() == pytest.approx(0.683, abs=0.05)


def test_the_bend_of_a_ball_is_not_taken_for_scatter():
    """A stripe that bends as over a ball of 40 mm at 0.8 m, by 0.0056 px a line², scatters no more.

    Its second differences over three lines are 0.1 px, eight times what the noise of a peak of 180
    explains; that noise is known to a tenth or so, and rounding adds to it.
    """
    ball = 60.0 + 0.0056 * (LINES - LENGTH / 2) ** 2
    film = _film([8.0 + _light(ball + 0.3 * i, 180.0) for i in range(12)])
    shape = Murk().learn(film, RIG).shapes[0]
    assert shape is not None
    assert shape.floor < 0.01


def test_a_chunk_gives_what_the_whole_would():
    frames = _film([_glow() + _light(_hull(i), 8.0) for i in range(40)])
    murk = Murk()
    background = murk.learn(frames, RIG)
    whole = list(murk.extract(frames, RIG, background))[18:22]
    halo = murk.look_ahead
    part = list(murk.extract(frames[18 - halo : 22 + halo], RIG, background))[halo:-halo]
    for one, other in zip(whole, part, strict=True):
        np.testing.assert_array_equal(one.pixels, other.pixels)
        np.testing.assert_array_equal(one.posterior, other.posterior)


def test_the_noise_of_each_level_is_learnt():
    """To a tenth: some thousand differences a level know their variance to 2 to 6 %."""
    light = np.linspace(10.0, 200.0, HEIGHT)[:, None] * np.ones(LENGTH)
    noise = learn_levels([frame.image for frame in _film([light] * 6)])
    assert noise.gain == pytest.approx(GAIN, rel=0.1)
    assert noise.white == 255


def test_saturation_is_told_from_the_pictures():
    light = 20.0 + _light(_hull(0), 400.0)
    frames = [
        Frame(np.minimum(frame.image, 235), frame.index, frame.time) for frame in _film([light] * 3)
    ]
    assert learn_levels([frame.image for frame in frames]).white == 235


def test_a_background_of_another_extractor_is_refused():
    frame = _film([_glow()])[0]
    with pytest.raises(InputError, match="learn"):
        list(Murk().extract([frame], RIG, Background(noise=1.0)))


@pytest.mark.parametrize("missing", [[], [3], [3, 4, 5, 6, 7, 8]])
def test_neighbours_are_those_within_reach(missing):
    numbered = [_film([np.zeros((2, 2))])[0] for _ in range(12)]
    frames = [
        Frame(frame.image, index, 0.0)
        for index, frame in enumerate(numbered)
        if index not in missing
    ]
    for own, near in zip(frames, with_neighbours(frames, 2), strict=True):
        assert near[0] is own
        assert {own.index + distance for distance in near} == {
            frame.index for frame in frames if abs(frame.index - own.index) <= 2
        }


def _scene(num_frames=12, *, lift=0.0):
    """Glow before a stripe that wanders slowly, and dark water behind it."""
    rows = np.arange(HEIGHT)[:, None]
    return [
        lift + np.where(rows < _hull(i), _glow(), 5.0) + _light(_hull(i), 60.0)
        for i in range(num_frames)
    ]


def _remarks(light):
    return " ".join(Murk().learn(_film(light), RIG).remarks)


def test_a_good_recording_gives_no_cause_for_remarks():
    assert _remarks(_scene()) == ""


def test_the_skirt_of_a_nearer_surface_is_not_taken_for_another_exposure():
    """Its light adds to the glow before it, which is brightest near the stripe."""
    rows = np.arange(HEIGHT)[:, None]
    bright = _glow() > np.quantile(_glow()[: HEIGHT // 2], 0.4)
    skirt = 0.5 * np.where(bright & (rows < _hull(0)), _glow(), 0.0)
    light = [one + skirt * (number % 4 == 2) for number, one in enumerate(_scene())]
    assert _remarks(light) == ""


@pytest.mark.parametrize(
    ("light", "word"),
    [
        ([np.full((HEIGHT, LENGTH), 9.0)] * 6, "laser"),
        (_scene(1), "one frame"),
        (_scene(lift=70.0), "lamps"),
        ([*_scene()[:8], *[np.full((HEIGHT, LENGTH), 2.0)] * 4], "4 of the 12 frames"),
        ([*_scene()[:6], *(2.0 * one for one in _scene()[6:])], "exposure"),
        ([*_scene()[:6], *(np.roll(one, 40, axis=1)[::-1] for one in _scene()[6:])], "mount"),
    ],
    ids=["no stripe", "one frame", "lamp on", "black", "auto-exposure", "moved"],
)
def test_a_bad_recording_says_what_is_wrong(light, word):
    assert word in _remarks(light)


@pytest.mark.parametrize("level", [0, 255])
def test_frames_without_any_picture_are_survived(level):
    frames = [Frame(np.full((HEIGHT, LENGTH), level, np.uint8), i, i / 25) for i in range(5)]
    assert sum(len(stripe) for stripe in _extract(frames)) == 0


@pytest.mark.parametrize("axis", ["x", "y"])
def test_fields_of_a_picture_with_an_odd_number_of_rows_are_searched(axis):
    """The first field has a row more than the second."""
    whole = 8.0 + _light(_hull(0), 80.0, width=2.6)
    if axis == "x":
        whole = whole.T
    picture = np.pad(whole, ((0, 1 - len(whole) % 2), (0, 0)), mode="edge")
    frames = [
        Frame(np.rint(picture[i % 2 :: 2]).astype(np.uint8), i, i / 50, i % 2, 2) for i in range(8)
    ]
    laser = Laser.from_baseline_angle(0.2, 1.1, axis)
    rig = Rig(Camera((picture.shape[1], len(picture)), (600.0, 600.0), (120.0, 80.0)), (laser,))
    murk = Murk()
    stripes = list(murk.extract(frames, rig, murk.learn(frames, rig)))
    assert all(len(stripe) > 0.9 * LENGTH / (2 if axis == "x" else 1) for stripe in stripes)


@pytest.mark.parametrize("shape", [(5, 240), (20, 240), (160, 1), (160, 7), (160, 20)])
def test_pictures_smaller_than_the_filter_are_survived(shape):
    rng = np.random.default_rng(0)
    frames = [Frame(rng.integers(0, 255, shape).astype(np.uint8), i, i / 25) for i in range(3)]
    rig = Rig(Camera(shape[::-1], (600.0, 600.0), (0.0, 0.0)), RIG.lasers)
    murk = Murk()
    assert len(list(murk.extract(frames, rig, murk.learn(frames, rig)))) == 3


@pytest.mark.parametrize("speed", [0.0, 0.7, 0.9, 1.2, 1.4, 1.7, 3.0])
def test_short_pieces_beside_a_long_stripe_are_found_however_fast_it_moves(speed):
    """Other frames speak against what moved on; a long stripe that moved as well says why."""

    def centre(index):
        at = np.full(LENGTH, np.nan)
        at[:120] = 60.0
        for piece in range(4):
            at[130 + 27 * piece : 150 + 27 * piece] = 90.0 - 8 * piece
        return at + speed * index

    frames = _film([8.0 + _light(centre(index), 60.0) for index in range(12)])
    for index, stripe in enumerate(_extract(frames)[:-1]):
        off = stripe.pixels[:, 1] - centre(index)[stripe.pixels[:, 0].astype(int)]
        assert np.sum(np.abs(off) < 1.5) > 0.95 * 200


def test_the_black_of_a_codec_is_not_white():
    assert learn_levels([np.full((HEIGHT, LENGTH), 16, np.uint8)] * 3).white == 255


def test_a_stripe_that_no_scan_line_shows_is_found_by_many_together():
    """A peak of 2.6 standard deviations of a pixel's noise scores four in a line, as noise does."""
    peak = 2.6 * float(np.sqrt(READ + GAIN * 20.0))
    frames = _film([20.0 + _light(_hull(0.1 * i), peak) for i in range(24)])
    murk = Murk()
    background = murk.learn(frames, RIG)
    assert background.search.least < murk.min_score
    assert murk.learn_soon(frames, RIG).search.least == murk.min_score
    stripes = list(murk.extract(frames, RIG, background))
    off = np.concatenate(
        [s.pixels[:, 1] - _hull(0.1 * i)[s.pixels[:, 0].astype(int)] for i, s in enumerate(stripes)]
    )
    assert np.sum(np.abs(off) < 3.0) > 0.95 * 24 * LENGTH
    assert np.mean(np.abs(off) < 3.0) > 0.95
    bright = _film([20.0 + _light(_hull(i), 40.0) for i in range(12)])
    assert murk.learn(bright, RIG).search.least == murk.min_score


@pytest.mark.parametrize("peak", [15.0, 60.0, 180.0])
def test_a_previews_centres_are_right_within_what_it_states(peak):
    """And the same as the scan's, whose height they have."""
    frames = _film([10.0 + _light(_hull(i), peak) for i in range(12)])
    murk = Murk()
    background = murk.learn_soon(frames, RIG)
    soon = murk.extract_soon(frames, RIG, background)
    shares = []
    for i, (found, exact) in enumerate(
        zip(soon, murk.extract(frames, RIG, background), strict=True)
    ):
        lines = found.pixels[:, 0].astype(int)
        assert len(np.setxor1d(lines, exact.pixels[:, 0])) < 0.03 * LENGTH
        shares.append(np.mean(np.abs(found.pixels[:, 1] - _hull(i)[lines]) < found.sigma))
        assert 0.8 < np.median(found.signal) / np.median(exact.signal) < 1.2
    assert 0.5 < np.mean(shares) < 0.95


def test_short_faint_remnants_in_all_of_a_recording_are_no_stripe():
    """Twelve smears of 12 lines a frame, at places of their own, three times the noise."""
    rng = np.random.default_rng(3)
    light = []
    for _ in range(16):
        one = np.full((HEIGHT, LENGTH), 20.0)
        for u, v in zip(
            rng.integers(0, LENGTH - 12, 12), rng.uniform(9, HEIGHT - 9, 12), strict=True
        ):
            one += np.where((u <= LINES) & (u + 12 > LINES), _light(v + 0 * LINES, 3.0), 0.0)
        light.append(one)
    assert sum(len(stripe) for stripe in _extract(_film(light))) == 0
