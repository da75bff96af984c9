"""What a merged cloud says of its passes' places, and how far off they are."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.geometry.alignment import align_clouds
from murkscan.geometry.surface_points import nearest_in_cloud
from murkscan.io.ply import save_cloud
from murkscan.io.rig_toml import as_tables
from murkscan.optics import intersect_rays_with_sheet, perturb_rig
from murkscan.optics.merged_errors import MergedErrors
from murkscan.optics.uncertainty import error_modes
from murkscan.optics.view import back_project
from murkscan.optics.view import project as to_pixels
from murkscan.project import (
    EXTRACT,
    MOTION,
    TRIANGULATE,
    ExtractResult,
    MotionResult,
    PartNote,
    Project,
    TriangulateResult,
)
from murkscan.project.passes import PassSource, look_at, number_passes
from murkscan.survey.cloud import build_cloud
from murkscan.survey.merge import merge_passes
from murkscan.survey.sample import load_sample
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.stripe import Stripe

from ..geometry.test_alignment import sample, waves
from ..projects import SCAN, finish
from ..scans import BASELINE, COTANGENT, FOCAL_LENGTH, scan

SEEDS = 30


@pytest.fixture(scope="module")
def merged(tmp_path_factory):
    """Merge three strips in a chain, in place but for noise, which alignment takes for errors."""
    errors, sigmas, shares = [], [], []
    for seed in range(SEEDS):
        folder = tmp_path_factory.mktemp("chain")
        random = np.random.default_rng(seed)
        # Each is 0.6 m long; 0.15 m of it lies on the one before.
        strips = [sample(waves, random, aside=aside, count=5000) for aside in (0.0, 0.45, 0.9)]
        paths = [folder / f"{number}.ply" for number in range(3)]
        for path, strip in zip(paths, strips, strict=True):
            save_cloud(path, strip)
        told = merge_passes(paths, folder / "out").passes
        project = Project(folder / "out")
        cloud = project.load_cloud()
        shifts = load_sample(project).shifts
        assert shifts is not None
        ends = [5000 * n + int(np.argmax(strip.points[:, 0])) for n, strip in enumerate(strips)]
        truth = [strip.points[end % 5000] for strip, end in zip(strips, ends, strict=True)]
        errors.append(cloud.points[ends] - truth)
        sigmas.append(np.linalg.norm(shifts(np.array(ends)), axis=2))
        shares.append([one.laid_on for one in told])
    return np.array(errors), np.array(sigmas), shares


def test_each_strip_of_a_chain_is_laid_on_the_one_before(merged):
    for first, second, third in merged[2]:
        assert first == ()
        assert second == (1.0,)
        assert third == pytest.approx([0.0, 1.0], abs=0.01)


@pytest.mark.parametrize("strip", [1, 2])
def test_the_stated_place_of_a_strip_s_far_end_holds_its_error(merged, strip):
    errors, sigmas = (part[:, strip] for part in merged[:2])
    # 90 coordinates, of which those of a strip hang together; without the error of the strip before
    # the third holds 81 %.
    assert np.mean(np.abs(errors) < 1.96 * sigmas) >= 0.85
    # Nor by stating too much: alignment states a fifth more than it errs here, and the root mean
    # square of 30 errors is good to 13 %.
    assert np.sqrt(np.mean(sigmas**2) / np.mean(errors**2)) < 1.2 * (1 + 2 * 0.13)


def test_the_first_strip_has_no_error(merged):
    errors, sigmas, _ = merged
    assert np.abs(errors[:, 0]).max() < 1e-9
    assert sigmas[:, 0].max() == 0


# The rig of `scans`, of which a tilt of the sheet and a focal length are not known well.
RIG = Rig(
    Camera((1000, 200), (FOCAL_LENGTH, FOCAL_LENGTH), (499.5, 99.5)),
    (Laser.from_baseline_angle(-BASELINE, np.pi - np.arctan(1 / COTANGENT), "x"),),
    covariance=RigCovariance(
        ("laser[0].normal[0]", "camera.focal_length[1]"), np.diag([2e-3**2, 2.0**2])
    ),
)
BACK = Pose(np.diag([-1.0, -1.0, 1.0]), np.zeros(3))
"""The second pass goes the other way: the camera is turned by half a turn about its axis."""


def hills(x, y):
    return 0.5 + 0.008 * np.sin(60 * x) * np.cos(50 * y)


def scanned(root, rig, *, spacing, back, is_adrift=False):
    """A pass over hills, that a rig saw which is not quite the one that it is taken for."""
    surface = (lambda x, y: hills(-x, -y)) if back else hills
    profile, trajectory = scan(surface, spacing=spacing)
    profile = replace(profile, pixels=to_pixels(RIG.camera, profile.points))
    rays = back_project(rig.camera, profile.pixels)
    profile = replace(profile, points=intersect_rays_with_sheet(rays, rig.lasers[0]))
    frames, times = np.unique(profile.frame), np.unique(profile.time)
    poses = trajectory.at(times).carry(BACK if back else Pose.identity())
    if is_adrift:  # all of its log along x
        errors = np.zeros((len(times), 6, 1))
        errors[:, 0] = 1e-3
        poses = replace(poses, errors=errors)
    project, note = Project(root), PartNote(tuple(frames.tolist()), tuple(times.tolist()), (), ())
    project.save_scan(replace(SCAN, rig=as_tables(RIG)))
    extract = finish(
        project, EXTRACT, ExtractResult((0,), len(frames), 0, 0, len(profile)),
        make=lambda: project.save_stripe_part(0, Stripe.empty(), note),
    )  # fmt: skip
    inputs, result = {"extract": extract.digest}, TriangulateResult(len(profile), dropped=0)
    finish(
        project, TRIANGULATE, result, inputs=inputs,
        make=lambda: project.save_profile_part(0, profile),
    )  # fmt: skip
    moved = MotionResult(len(frames))
    finish(project, MOTION, moved, inputs=inputs, make=lambda: project.save_trajectory(poses))
    build_cloud(project, RIG, rules=(), frames=False)
    return root


def both_ways(folder, rig):
    passes = [
        scanned(folder / name, rig, spacing=spacing, back=name == "b")
        for name, spacing in (("a", 2e-3), ("b", 2.1e-3))
    ]
    merge_passes(passes, folder / "out")
    return Project(folder / "out")


@pytest.mark.parametrize("number", [0, 1])
def test_merged_points_move_with_an_error_of_their_rig_as_is_stated(tmp_path, number):
    """A tilt of the sheet moves two opposite passes apart, and alignment brings them together."""
    as_it_is = both_ways(tmp_path / "true", RIG)
    mode = error_modes(RIG.covariance)[:, number]
    off = both_ways(tmp_path / "off", perturb_rig(RIG, RIG.covariance.names, mode))
    stated = load_sample(as_it_is)
    moved = off.load_cloud().points - stated.cloud.points
    expected = stated.shifts(np.arange(len(moved)))[:, :, number]
    # By 0.8 %, since ICP pairs other points then. Were the alignment taken to stay, by 138 % for
    # the tilt.
    assert np.sqrt(np.mean((moved - expected) ** 2) / np.mean(moved**2)) < 0.03


def test_an_error_of_a_pass_s_poses_that_alignment_sees_is_answered(tmp_path):
    """A second pass whose log is shifted and turned as a whole ends where it would anyway."""
    passes = [scanned(tmp_path / "a", RIG, spacing=2e-3, back=False)]
    passes.append(scanned(tmp_path / "b", RIG, spacing=2.1e-3, back=True))
    sources = [PassSource(path) for path in passes]
    records = [one.as_record(tmp_path / "out") for one in sources]
    first, second = number_passes([*map(look_at, sources, records)])
    seen = [one.see(Pose.identity()) for one in (first, second)]
    whole = np.zeros((len(seen[1].trajectory.times), 6, 2))
    whole[:, 0, 0], whole[:, 3, 1] = 1e-3, 1e-3  # a shift along x [m], a turn about x [rad]
    # A turn about each camera's own place is one of the world with a shift that follows.
    whole[:, :3, 1] = np.cross([1e-3, 0, 0], seen[1].trajectory.positions)
    seen[1] = replace(seen[1], trajectory=replace(seen[1].trajectory, errors=whole))
    errors = MergedErrors.of_passes(seen)
    clouds = [one.sample() for one in (first, second)]
    alignment = align_clouds(clouds[1], clouds[0])
    at = alignment.pairs.points
    ours, theirs = (cloud[nearest_in_cloud(cloud, at)] for cloud in clouds[::-1])
    one, zero = np.ones(len(at), int), np.zeros(len(at), int)
    apart = errors.shifts(one, ours) - errors.shifts(zero, theirs)
    laid = errors.lay(1, alignment.centre, np.zeros((6, 6)), alignment.answer(apart))
    poses = slice(2, 4)  # behind the two errors of the rig
    before = errors.shifts(one, ours)[:, :, poses]
    after = laid.shifts(one, ours)[:, :, poses]
    assert np.abs(before).max() > 5e-4
    # Points lie a millimetre from the pairs that stand for them; a thousandth of that is turned.
    assert np.abs(after).max() < 2e-6


def test_points_that_turn_from_camera_or_light_do_not_tell_where_a_pass_lies(tmp_path):
    source = PassSource(scanned(tmp_path / "a", RIG, spacing=2e-3, back=False))
    (one,) = number_passes([look_at(source, source.as_record(tmp_path / "out"))])
    errors, cloud = MergedErrors.of_passes([one.see(Pose.identity()), None]), one.sample()
    count = len(cloud)
    assert errors.is_facing(np.zeros(count, int), cloud).all()
    # Turned by 70 degrees from the view along z, to the sides: across the light and along it.
    aside, down = np.sin(np.radians(70)), np.cos(np.radians(70))
    for normal in ((0.0, aside, -down), (aside, 0.0, -down), (-aside, 0.0, -down)):
        turned = replace(cloud, normals=np.tile(np.array(normal, np.float32), (count, 1)))
        facing = errors.is_facing(np.zeros(count, int), turned)
        assert facing.mean() < 0.02
        # Nothing is known of how the other pass was seen.
        assert errors.is_facing(np.ones(count, int), turned).all()


def test_a_pass_goes_along_with_the_error_of_the_log_that_it_is_laid_on(tmp_path):
    passes = [
        scanned(tmp_path / "a", RIG, spacing=2e-3, back=False, is_adrift=True),
        scanned(tmp_path / "b", RIG, spacing=2.1e-3, back=True, is_adrift=True),
    ]
    told = merge_passes(passes, tmp_path / "out").passes
    assert [one.pose_errors for one in told] == [1, 1]
    merged = load_sample(Project(tmp_path / "out"))
    shifts = merged.shifts(np.arange(len(merged)))
    # Behind the two errors of the rig come those of the first log and of the second.
    np.testing.assert_allclose(shifts[:, :, 2], np.tile([1e-3, 0, 0], (len(merged), 1)), atol=1e-6)
    second = merged.cloud.frame >= told[1].frames[0]
    assert np.abs(shifts[second, :, 3]).max() < 1e-6
