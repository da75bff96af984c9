"""What a scan has and misses: areas that are known, and causes that were made."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.report import (
    CAUSES,
    CellSums,
    GrowingCoverage,
    Reach,
    SurfaceDirections,
    SwathLayout,
    map_coverage,
)
from murkscan.types.frame_times import FrameTimes
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

STEP, PITCH, LINES, FRAMES = 0.001, 0.001, 100, 200
"""A wall at half a metre: a point every millimetre both ways."""
WHOLE = STEP * (FRAMES - 1) * PITCH * LINES
"""Area between its first and its last profile [m²]."""
BRIGHT = Reach(np.array([0.4, 1.0]), np.array([100.0, 80.0]), least=2.0)
"""Light enough at every range of these scans."""


def _scan(kept=None, *, frames=FRAMES, depth=0.5, axis="y", posterior=1.0):
    """Points of all frames and scan lines, or of those that `kept(frame, line)` says."""
    frame, line = (
        g.ravel() for g in np.meshgrid(np.arange(frames), np.arange(LINES), indexing="ij")
    )
    if kept is not None:
        which = kept(frame, line)
        frame, line = frame[which], line[which]
    z = np.broadcast_to(depth(frame, line) if callable(depth) else depth, frame.shape).astype(float)
    across, beside = PITCH * line, np.zeros(len(frame))
    pixels = np.stack([line, np.full(len(frame), 50)], axis=1).astype(float)
    x, y, pixels = (across, beside, pixels) if axis == "y" else (beside, across, pixels[:, ::-1])
    n = len(frame)
    return Profile(
        frame.astype(np.uint32), frame * 0.04, np.zeros(n, np.uint8), pixels.copy(),
        np.stack([x, y, z], axis=1), np.full(n, 1e-4, np.float32), np.ones(n, np.float32),
        np.full(n, posterior, np.float32), np.zeros(n, np.uint8),
    )  # fmt: skip


def _trajectory(steps=None, axis="y", turn=None):
    way = np.arange(FRAMES) * STEP if steps is None else np.concatenate([[0], np.cumsum(steps)])
    positions = np.zeros((FRAMES, 3))
    positions[:, "xy".index(axis)] = way
    turn = turn or Rotation.identity()
    quaternions = np.tile(turn.as_quat(scalar_first=True), (FRAMES, 1))
    return Trajectory(np.arange(FRAMES) * 0.04, turn.apply(positions), quaternions)


def _layout(*, read=None, trajectory=None, axis="y", fields=1):
    read = np.arange(FRAMES) if read is None else read
    trajectory = trajectory or _trajectory(axis=axis)
    frames = FrameTimes(read.astype(np.uint32), read * 0.04)
    directions = SurfaceDirections.from_trajectory(trajectory, axis)
    return SwathLayout(frames, trajectory, axis, (LINES, LINES), fields, directions)


def _cover(profiles, **laid):
    layout = _layout(**laid)
    profiles = profiles if isinstance(profiles, list) else [profiles]
    return map_coverage(profiles, {0: layout}, reach=BRIGHT, wanted=PITCH, spacing=STEP)


def _grow(profile, layout, *, cell):
    growing = GrowingCoverage(wanted=PITCH, cell=cell, most=10**9)
    growing.add([profile], layout, BRIGHT)
    return growing.as_map()


def _only(coverage):
    """The one cause that anything is missing by, and its area."""
    missing = {cause: area for cause, area in coverage.missing.items() if area > 0}
    assert len(missing) == 1
    return missing.popitem()


def test_a_whole_wall_is_covered_and_its_area_is_right():
    coverage = _cover(_scan())
    # Depth times pitch is exact on a wall, so only rounding is left.
    assert coverage.covered == pytest.approx(WHOLE, rel=1e-9)
    assert not any(coverage.missing.values())
    assert coverage.points.sum() == FRAMES * LINES


def test_frames_without_a_stripe_leave_a_gap_of_their_own():
    coverage = _cover(_scan(lambda frame, line: (frame < 80) | (frame >= 120)))
    cause, area = _only(coverage)
    assert cause == "no_stripe"
    # From frame 79 to frame 120.
    assert area == pytest.approx(41 * STEP * PITCH * LINES)
    assert coverage.mapped == pytest.approx(WHOLE)


def test_frames_that_could_not_be_read_are_told_from_those_without_a_stripe():
    lost = (np.arange(FRAMES) < 80) | (np.arange(FRAMES) >= 120)
    read = np.flatnonzero(lost)
    assert _only(_cover(_scan(lambda frame, line: lost[frame]), read=read))[0] == "unreadable"


def test_a_hurried_stretch_was_too_fast():
    steps = np.full(FRAMES - 1, STEP)
    steps[50:60] = 5 * STEP
    cause, area = _only(_cover(_scan(), trajectory=_trajectory(steps)))
    assert cause == "too_fast"
    assert area == pytest.approx(10 * 5 * STEP * PITCH * LINES)


def test_a_spacing_below_twice_the_wanted_is_no_gap():
    trajectory = _trajectory(np.full(FRAMES - 1, 1.9 * STEP))
    assert not any(_cover(_scan(), trajectory=trajectory).missing.values())


def test_a_patch_from_which_no_light_came_back_is_one():
    def kept(frame, line):
        return (abs(frame - 100) > 20) | (abs(line - 50) > 10)

    cause, area = _only(_cover(_scan(kept)))
    assert cause == "too_dark"
    # 21 scan lines, from the last frame before the patch to the first after it.
    assert area == pytest.approx(21 * PITCH * 42 * STEP)


def test_a_band_that_no_frame_shows_is_missing_too():
    cause, area = _only(_cover(_scan(lambda frame, line: abs(line - 50) > 10)))
    assert cause == "too_dark"
    assert area == pytest.approx(21 * PITCH * (FRAMES - 1) * STEP)


def test_scan_lines_missing_beside_a_jump_in_depth_are_hidden():
    def depth(frame, line):
        return np.where(line < 50, 0.5, 0.6)

    cause, area = _only(_cover(_scan(lambda frame, line: abs(line - 50) > 5, depth=depth)))
    assert cause == "occluded"
    # Filled from 0.5 to 0.6 m, so that lines are up to a fifth wider than on the near wall.
    assert 11 * PITCH * (FRAMES - 1) * STEP < area < 1.2 * 11 * PITCH * (FRAMES - 1) * STEP


def test_frames_missing_beside_a_jump_along_the_motion_are_hidden():
    def depth(frame, line):
        return np.where(frame < 100, 0.5, 0.7)

    # Half of the scan lines still see the step, so the frames themselves are lit.
    def kept(frame, line):
        return (line < 50) | (abs(frame - 100) > 8)

    coverage = _cover(_scan(kept, depth=depth))
    assert coverage.missing["occluded"] > 40 * PITCH * 17 * STEP
    assert coverage.missing["no_stripe"] == coverage.missing["unreadable"] == 0


def test_what_lies_outside_of_the_profiles_is_not_counted():
    half = _cover(_scan(lambda frame, line: line < 50))
    assert half.mapped == pytest.approx(WHOLE / 2)
    assert not any(half.missing.values())


def test_doubtful_points_cover_nothing():
    assert _cover(_scan(posterior=0.4)) is None


@pytest.mark.parametrize("profiles", [[], [_scan(frames=1)], [_scan(frames=0)]])
def test_without_neighbours_there_is_no_map(profiles):
    assert _cover(profiles) is None


def test_parts_cover_what_the_whole_covers():
    def kept(frame, line):
        return (abs(frame - 64) > 9) | (abs(line - 50) > 10)

    whole = _scan(kept)
    parts = [whole[(whole.frame >= a) & (whole.frame < a + 64)] for a in range(0, FRAMES, 64)]
    np.testing.assert_allclose(_cover(parts).areas, _cover(whole).areas, atol=1e-15)


def test_a_turned_world_changes_nothing():
    turn = Rotation.from_euler("xyz", [0.4, -0.8, 2.0])
    steps = np.full(FRAMES - 1, STEP)
    steps[50:60] = 5 * STEP
    level = _cover(_scan(), trajectory=_trajectory(steps))
    turned = _cover(_scan(), trajectory=_trajectory(steps, turn=turn))
    np.testing.assert_allclose(turned.total, level.total, rtol=1e-9)


def test_fields_of_which_each_has_every_second_row_cover_a_wall():
    profile = _scan(lambda frame, line: line % 2 == frame % 2, axis="x")
    coverage = _cover(profile, axis="x", fields=2)
    assert not any(coverage.missing.values())
    assert coverage.covered == pytest.approx(WHOLE, rel=1e-9)


def test_the_map_shows_the_gap_where_it_is():
    coverage = _cover(_scan(lambda frame, line: (frame < 80) | (frame >= 120)))
    columns = np.flatnonzero((coverage.state() == 1 + CAUSES.index("no_stripe")).any(axis=0))
    place = coverage.corner[0] + coverage.cell * (columns + 0.5)
    # Cells are three spacings wide: the outermost may lie half in the gap.
    assert place.min() == pytest.approx(0.079, abs=coverage.cell)
    assert place.max() == pytest.approx(0.120, abs=coverage.cell)


def test_scan_lines_that_are_farther_apart_than_cells_leave_no_cell_between_them_unknown():
    found = _grow(_scan(), _layout(), cell=0.4 * PITCH)
    assert (found.state() == 0).all()


def test_a_gap_in_which_the_vehicle_drifts_aside_leans_with_it():
    trajectory = _trajectory()
    trajectory.positions[:, 0] = np.clip(np.arange(FRAMES) - 80, 0, 40) * 0.5 * STEP
    dive = _scan(lambda frame, line: (frame < 80) | (frame >= 120))
    found = _grow(dive, _layout(trajectory=trajectory), cell=2 * PITCH)
    is_gap = found.state() == 1 + CAUSES.index("no_stripe")
    columns = np.flatnonzero(is_gap.any(axis=0))[:20]  # before its last profile, which slants
    edge = is_gap[:, columns].argmax(axis=0)
    # 20 mm aside over the gap's 41 mm, seen from the whole way, which goes 20 mm aside over 199.
    lean = np.tan(np.arctan(20 / 41) - np.arctan(20 / 199))
    assert np.polyfit(columns, edge, 1)[0] == pytest.approx(lean, abs=0.05)


def test_a_map_that_grows_is_that_of_the_whole_scan():
    profile, layout = _scan(lambda frame, line: (frame < 80) | (frame >= 120)), _layout()
    growing = GrowingCoverage(wanted=PITCH, cell=0.005, most=10**9)
    for first in range(0, FRAMES, 50):
        part = profile[(profile.frame >= first) & (profile.frame < first + 50)]
        growing.add([part] if len(part) else [], layout, BRIGHT)
        growing.as_map()
    whole, found = _cover(profile), growing.as_map()
    np.testing.assert_allclose(found.total, whole.total, rtol=1e-9)
    assert found.points.sum() == whole.points.sum()


def test_a_map_goes_on_where_an_earlier_run_ended():
    layout = _layout()
    profile = _scan()
    first, later = (GrowingCoverage(wanted=PITCH, cell=0.005, most=10**6) for _ in range(2))
    first.add([profile[profile.frame < 120]], layout, BRIGHT)
    first.as_map()
    sums, cell = first.sums
    columns = sums.as_columns()
    later.go_on(CellSums.from_columns(columns), cell)
    later.add([profile[profile.frame >= 119]], layout, BRIGHT)
    found = later.as_map()
    assert found.covered == pytest.approx(WHOLE, rel=1e-9)
    assert not any(found.missing.values())


def test_a_map_that_grows_too_large_is_coarsened_and_loses_no_area():
    fine, coarse = (GrowingCoverage(wanted=PITCH, cell=0.002, most=most) for most in (10**9, 500))
    layout = _layout()
    for growing in (fine, coarse):
        growing.add([_scan()], layout, BRIGHT)
    maps = [growing.as_map() for growing in (fine, coarse)]
    assert (maps[0].cell, maps[1].cell) == (0.002, 0.008)
    assert maps[1].covered == pytest.approx(maps[0].covered, rel=1e-9)
    assert (maps[1].points > 0).sum() <= 500
