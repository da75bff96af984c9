"""Paint across the sheet pulls centres: that is learnt, taken back, and told how surely."""

from dataclasses import replace

import numpy as np
import pytest
import tomlkit

from murkscan import Murk
from murkscan.simulate import parse_scene, read_scene, simulate_frames
from murkscan.triangulate import RaySheet, learn_paint_pulls, triangulate, undo_paint_pull
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig
from murkscan.types.stripe import Stripe
from murkscan.types.true_stripe import TrueStripe

from ..scenes import air_rig

FRAMES, LINES = 64, 400
PULL, NOISE, LIGHT_NOISE = 0.1, 0.02, 0.002
CORNER, SIZE = (840, 490), (240, 90)
"""First column and row, and the size, of the part of the picture that shows a simulated wall."""


def paint(seed: int) -> np.ndarray:
    """Draw the logarithm of reflectance of a wall with patches, by frame and scan line."""
    random = np.random.default_rng(seed)
    log = np.zeros((FRAMES + 2, LINES))
    ahead, line = np.mgrid[: FRAMES + 2, :LINES]
    for _ in range(60):
        at, long, wide = random.uniform(0, FRAMES), random.uniform(3, 8), random.uniform(8, 30)
        edge = np.hypot((ahead - at) / long, (line - random.uniform(0, LINES)) / wide) - 1
        log += random.uniform(-1, 1) / (1 + np.exp(np.clip(4 * edge, -50, 50)))
    return log


def scan_wall(seed=0, *, contrast=1.0, pull=PULL, step=1, axis="y") -> tuple[Stripe, np.ndarray]:
    """Make the stripes of a painted wall with waves; also by how much each centre is truly pulled.

    With a step of 2 the odd lines are of odd frames, as fields that take turns have their rows.
    """
    random = np.random.default_rng(1000 + seed)
    log = contrast * paint(seed)
    change = np.gradient(log, axis=0)[1:-1]
    frame, line = (index.ravel() for index in np.mgrid[:FRAMES, :LINES])
    shift = pull * change.ravel()
    position = 200 + 3 * np.sin(frame / 20) + 0.5 * np.sin(line / 30) + shift
    position = position + random.normal(0, NOISE, len(position))
    pixels = np.stack([line, position] if axis == "y" else [position, line], axis=1).astype(float)
    light = np.exp(log[1:-1].ravel() + random.normal(0, LIGHT_NOISE, len(frame)))
    one, number = np.ones(len(frame), np.float32), np.zeros(len(frame), np.uint8)
    stripe = Stripe(
        frame.astype(np.uint32), frame / 25, pixels, NOISE * one, (100 * light).astype(np.float32),
        one, number, number, width=NOISE / LIGHT_NOISE * one,
    )  # fmt: skip
    shown = (line + frame) % step == 0
    return stripe[shown], shift[shown]


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("pull", [PULL, -PULL])
def test_points_beside_edges_of_paint_are_off_by_less_than_half(pull, axis, step):
    stripe, shift = scan_wall(pull=pull, step=step, axis=axis)
    rig = air_rig(axis=axis)
    given = stripe.pixels.copy()
    put_back = undo_paint_pull(stripe, learn_paint_pulls([stripe], rig), rig)
    true = given.copy()
    true[:, "xy".index(axis)] -= shift
    points, back, truth = (
        triangulate(replace(stripe, pixels=pixels), rig, RaySheet()).points[:, 2]
        for pixels in (given, put_back.pixels, true)
    )
    inner = (stripe.frame >= step) & (stripe.frame < FRAMES - step)
    edge = inner & (np.abs(shift) > 0.01)
    assert np.count_nonzero(edge) > 500
    off = np.abs(back - truth)[edge].mean() / np.abs(points - truth)[edge].mean()
    assert off < (0.2 if step == 1 else 0.5)  # fields of a kind are two frames apart: less sharp
    np.testing.assert_array_equal(stripe.pixels, given)


def test_a_wall_without_paint_is_left_as_it_is():
    stripe, _ = scan_wall(contrast=0.0)
    assert learn_paint_pulls([stripe], air_rig()) == ()
    assert undo_paint_pull(stripe, (), air_rig()).pixels.tobytes() == stripe.pixels.tobytes()


def test_paint_that_does_not_pull_is_not_taken_for_some_that_does():
    learnt = [learn_paint_pulls([scan_wall(seed, pull=0.0)[0]], air_rig()) for seed in range(10)]
    assert sum(map(len, learnt)) <= 1  # one in 400 is; two of 10 are one time in 4000


def test_the_pull_is_as_sure_as_is_told():
    learnt = [learn_paint_pulls([scan_wall(seed)[0]], air_rig())[0] for seed in range(20)]
    off = [(pull.shift - PULL) / pull.sigma for pull in learnt]
    # A deviation of 20 is known to 16 %.
    assert 0.7 < np.sqrt(np.mean(np.square(off))) < 1.4


def test_pieces_say_and_give_what_the_whole_does():
    stripe, _ = scan_wall()
    rig, cut = air_rig(), stripe.frame < FRAMES // 2
    whole = undo_paint_pull(stripe, learn_paint_pulls([stripe], rig), rig)
    (pull,) = learn_paint_pulls(iter([stripe[cut], stripe[~cut]]), rig)
    assert pull.shift == pytest.approx(PULL, abs=4 * pull.sigma)
    pulls = learn_paint_pulls([stripe], rig)
    first = undo_paint_pull(stripe[cut], pulls, rig, beside=stripe[~cut])
    second = undo_paint_pull(stripe[~cut], pulls, rig, beside=stripe[cut])
    joined = Stripe.concatenate([first, second])
    np.testing.assert_array_equal(joined.pixels, whole.pixels)
    np.testing.assert_array_equal(joined.sigma, whole.sigma)


def test_each_laser_has_a_pull_of_its_own():
    near, far = scan_wall()[0], scan_wall(1, pull=0.05)[0]
    rig = air_rig()
    two = Rig(rig.camera, (rig.lasers[0], Laser.from_baseline_angle(-0.25, 2.0, "y")))
    both = Stripe.concatenate([near, replace(far, laser=far.laser + 1)])
    pulls = learn_paint_pulls([both], two)
    assert [pull.laser for pull in pulls] == [0, 1]
    for pull, true in zip(pulls, (PULL, 0.05), strict=True):
        assert pull.shift == pytest.approx(true, abs=4 * pull.sigma)


def test_nothing_and_a_single_frame_say_nothing():
    stripe, _ = scan_wall()
    for little in (stripe[:0], stripe[stripe.frame == 3]):
        assert learn_paint_pulls([little], air_rig()) == ()
        pulls = learn_paint_pulls([stripe], air_rig())
        assert (undo_paint_pull(little, pulls, air_rig()).pixels == little.pixels).all()


def grown_wall() -> tuple[Stripe, np.ndarray, Rig]:
    """Film a grown-over wall through murk, 2 mm a frame; also each centre's true place [px]."""
    text, label, folder = read_scene("plane-c1.5-hd")
    document = tomlkit.parse(text)
    document["object"].update(surface={"texture": "growth"}, rotation_deg=[0.0, 0.0, 0.0])
    document["motion"].update(frames=48, frame_rate_hz=50.0, speed_mm_s=100.0)
    scene = parse_scene(tomlkit.dumps(document), label, folder)
    u, v = scene.rig.camera.principal_point
    middle = (u - CORNER[0], v - CORNER[1])
    camera = replace(scene.rig.camera, size=SIZE, principal_point=middle)
    scene = replace(scene, rig=replace(scene.rig, camera=camera))
    made = list(simulate_frames(scene, 0, len(scene)))
    frames, murk = [one.frame for one in made], Murk()
    found = murk.extract(frames, scene.rig, murk.learn(frames, scene.rig))
    stripe, true = Stripe.concatenate(list(found)), TrueStripe.concatenate([m.stripe for m in made])
    place = np.full((len(scene), SIZE[0]), np.nan)
    place[true.frame, np.rint(true.pixels[:, 0]).astype(int)] = true.pixels[:, 1]
    return stripe, place[stripe.frame, np.rint(stripe.pixels[:, 0]).astype(int)], scene.rig


def test_growth_on_a_simulated_wall_pulls_by_less_than_half_of_before():
    stripe, true, rig = grown_wall()
    pulls = learn_paint_pulls([stripe], rig)
    assert len(pulls) == 1
    back = undo_paint_pull(stripe, pulls, rig)
    off, left = (one.pixels[:, 1] - true for one in (stripe, back))
    put = stripe.pixels[:, 1] - back.pixels[:, 1]
    sure = np.isfinite(off) & (np.abs(off - np.nanmedian(off)) < 0.3)
    pulled = sure & (np.abs(put) > 0.01)
    assert np.count_nonzero(pulled) > 200

    def bias(errors):
        return abs(np.mean(((errors - np.nanmedian(errors[sure])) * np.sign(put))[pulled]))

    assert bias(left) < 0.5 * bias(off)
    rest = ((left - np.nanmedian(left[sure])) / back.sigma)[pulled]
    assert 0.5 < 1.4826 * np.median(np.abs(rest)) < 1.5
