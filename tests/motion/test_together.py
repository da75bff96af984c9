"""Passes side by side over one plate, corrected together: one knows its way, the other does not."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.motion.adjust import Seams
from murkscan.motion.correction_words import tell_correction_of_pass
from murkscan.motion.together import LaidPass, correct_together
from murkscan.types.measured import Measured
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings
from murkscan.types.pose import Pose
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

from .adjust.test_adjust import SPEED, STAND_OFF, swing

DURATION, RATE, LINES = 5.0, 20.0, (160, 147)
ASIDE = 0.15
"""From one pass to the next [m]; each is 0.3 m wide."""


def log_of(times, sigma):
    """Give the log of a vehicle that keeps its speed; sigma is that of its velocity [m/s]."""
    nothing = np.zeros((len(times), 3))
    return Navigation(
        NavigationAccuracy(
            velocity_noise=sigma, attitude_noise=1e-3, depth_noise=1e-3, position_noise=1e-3
        ),
        attitude=Readings(times, nothing),
        velocity=Readings(times, np.tile([SPEED, 0, 0], (len(times), 1))),
        depth=Readings(times, np.zeros((len(times), 1))),
        position=Readings(times[:1], np.zeros((1, 3))),
    )


def bumps(x, y, height):
    """Give how high growth stands that goes together over a centimetre [m]."""
    waves = np.random.default_rng(7).normal(size=(40, 3)) * [90.0, 90.0, 3.0]
    phases = np.multiply.outer(waves[:, 0], x) + np.multiply.outer(waves[:, 1], y)
    return height / 4 * np.sin(phases + waves[:, 2:]).sum(axis=0)


def sheet(depth):
    """Give where the sheet is at a depth: its laser sits 0.2 m behind the camera [m]."""
    return depth / 3 - 0.2


def see(number, height, ahead):
    """Give what a pass saw of the plate from where it was."""
    across = np.linspace(-0.15, 0.15, LINES[number])
    count = len(ahead) * len(across)
    x, y = (part.ravel() for part in np.meshgrid(ahead, across, indexing="ij"))
    depth = np.full(count, STAND_OFF)
    for _ in range(4):
        depth = STAND_OFF - bumps(x + sheet(depth), y + number * ASIDE, height)
    noise = 2e-5 * np.random.default_rng(number).normal(size=count)
    ones = np.ones(count, np.float32)
    frame, line = np.divmod(np.arange(count), len(across))
    return Profile(
        frame=frame.astype(np.uint32),
        time=frame / RATE,
        laser=np.zeros(count, np.uint8),
        pixels=np.stack([np.zeros(count), line], axis=1).astype(float),
        points=np.stack([sheet(depth + noise), y, depth + noise], axis=1),
        sigma=ones * np.float32(2e-5),
        signal=ones,
        posterior=ones,
        branch=np.zeros(count, np.uint8),
    )


def passes(height=1e-3, *, is_placed=True, aside=ASIDE):
    """Give two passes: the first keeps its way to 0.1 mm/s, the second swings by 6 mm."""
    times = np.arange(int(DURATION * RATE)) / RATE
    made = []
    for number, (sigma, off) in enumerate(((1e-4, 0 * times), (1e-2, swing(times)))):
        places = np.stack([SPEED * times, np.full(len(times), number * aside), 0 * times], axis=1)
        level = np.tile([1.0, 0, 0, 0], (len(times), 1))
        log = log_of(times, sigma)
        if number:
            log = replace(log, position=Readings(times[:1], np.array([[0.0, aside, 0.0]])))
        if not is_placed:
            log = Navigation(NavigationAccuracy(speed=1e-2 + 0.1 * number), speed=SPEED)
            places = places - places[0]
        laid = Pose.identity() if is_placed else Pose(np.eye(3), np.array([0, number * aside, 0]))
        made.append(
            LaidPass(
                Measured(log, Pose.identity(), is_placed=is_placed),
                [see(number, height, SPEED * times + off)],
                ("x",),
                Trajectory(times, places, level),
                laid,
            )
        )
    return made


def off_course(found):
    """Give how far a pass is from where it swung, but for its ends [m]."""
    way = found.trajectory
    return (way.positions[:, 0] - SPEED * way.times - swing(way.times))[8:-8]


@pytest.fixture(scope="module")
def together():
    return correct_together(passes())


def test_a_pass_is_bent_to_what_its_neighbour_knows(together):
    first, second = together
    assert np.std(swing(second.trajectory.times)) > 4e-3
    assert np.std(off_course(second)) < 0.2e-3
    # The first one's log knows its way better than the second can tell it, but for its place.
    assert np.ptp(first.trajectory.positions[:, 0] - SPEED * first.trajectory.times) < 0.2e-3
    assert second.num_tiles > 5
    assert second.is_sound
    assert second.seams.after < 0.5 * second.seams.before
    torn = replace(second, seams=Seams(before=1e-3, after=2e-3))
    assert not torn.is_sound


def test_what_both_have_wrong_together_is_one_error(together):
    first, second = (one.trajectory for one in together)
    middle = len(first.times) // 2
    own, apart = (
        np.linalg.norm(errors[middle, :3], axis=1)
        for errors in (first.errors, first.errors - second.errors)
    )
    # Each is known to 1 mm only, since their logs begin so; to one another they lie far better.
    assert np.all(apart[:2] < 0.5 * own[:2])


def test_a_corrected_pass_says_how_far_and_how_sure(together):
    words = tell_correction_of_pass(together[1])
    assert words[0].startswith("corrected along its way from what the passes saw")
    assert "length of the way" in words[1]
    assert not together[1].is_astray
    lost = tell_correction_of_pass(replace(together[1], astray=3.2))
    assert lost[:-1] == words
    assert lost[-1].startswith("over 3.2 s of it, bumps do not lie on those that other passes saw")


def test_passes_that_know_only_about_how_fast_they_are_lie_in_the_first_camera_s_world():
    first, second = correct_together(passes(is_placed=False))
    np.testing.assert_allclose(first.trajectory.positions[0], 0, atol=1e-12)
    assert np.abs(first.trajectory.errors[0]).max() < 1e-12
    # Nothing tells which of them swings, but both saw the same between them, at times of their own.
    times = second.trajectory.times[10:-10]
    same = times + swing(times) / SPEED
    ours, theirs = (
        one.trajectory.transform(np.tile([0.0, side * ASIDE / 2, STAND_OFF], (len(at), 1)), at)
        for one, side, at in ((first, 1, same), (second, -1, times))
    )
    assert np.abs(ours - theirs).max() < 0.5e-3
    # What both may have wrong alike is stated, and no more than the log alone says.
    length = next(one for one in second.sureness if one.name == "length of the way")
    assert 0.2 * length.logged < length.found < length.logged


def test_a_plain_plate_bends_nothing_along_itself():
    _, second = correct_together(passes(0.0))
    way = second.trajectory
    off = way.positions[:, 0] - SPEED * way.times
    # White noise of 10 mm/s at 20 Hz adds up to 10 mm/s · √(0.05 s · 5 s) = 5 mm; 64 draws know it
    # to 9 %. Noise of 20 µm must not seem to know any of that.
    sigma = np.linalg.norm(way.errors[-1, 0] - way.errors[0, 0])
    assert sigma == pytest.approx(5e-3, rel=0.35)
    assert np.abs(off).max() < 0.2 * 5e-3
    assert not second.num_tiles
    assert "too plain" in " ".join(tell_correction_of_pass(second))


def test_passes_that_lie_beside_one_another_show_nothing():
    assert correct_together(passes(aside=0.5)) is None
