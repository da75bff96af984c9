"""The report: numbers that are right, and a page that says just those."""

import json
import math
from dataclasses import replace
from datetime import UTC, datetime
from html.parser import HTMLParser

import numpy as np
import pytest

from murkscan.report import (
    Quantiles,
    Recorded,
    Shown,
    as_html,
    as_json,
    frame_statistics,
    make_timeline,
    spacing_across,
    spacing_along,
    summarise,
    with_coverage,
)
from murkscan.types.camera import Camera
from murkscan.types.cloud import PointCloud
from murkscan.types.frame_times import FrameTimes
from murkscan.types.laser import Fan, Laser
from murkscan.types.port import DomePort, FlatPort, Layer
from murkscan.types.profile import Profile
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory
from murkscan.types.water import Water

STEP, PITCH = 0.004, 0.001
"""Way from frame to frame, and distance of points on a stripe [m]."""
RIG = Rig(
    Camera(size=(40, 30), focal_length=(50.0, 50.0), principal_point=(19.5, 14.5)),
    (Laser.from_baseline_angle(0.1, 1.2, "y"),),
)


def _profile(frames, *, columns=20, branches=1):
    """A level surface at 0.5 m; in frame k all points have signal 10 k + column."""
    frame, column, branch = (
        grid.ravel() for grid in np.meshgrid(frames, range(columns), range(branches), indexing="ij")
    )
    n = len(frame)
    points = np.stack([PITCH * column, np.zeros(n), 0.5 + 0.1 * branch], axis=1)
    return Profile(
        frame=frame.astype(np.uint32),
        time=frame * 0.04,
        laser=np.zeros(n, np.uint8),
        pixels=np.stack([column.astype(float), np.full(n, 12.3)], axis=1),
        points=points,
        sigma=np.full(n, 1e-4, np.float32),
        signal=(10 * frame + column - 5.0 * branch).astype(np.float32),
        posterior=np.ones(n, np.float32),
        branch=branch.astype(np.uint8),
    )


def _trajectory(num_frames):
    times = np.arange(num_frames) * 0.04
    positions = np.stack([0 * times, STEP * np.arange(num_frames), 0 * times], axis=1)
    return Trajectory(times, positions, np.tile([1.0, 0, 0, 0], (num_frames, 1)))


def _times(num_frames):
    return FrameTimes(np.arange(num_frames, dtype=np.uint32), np.arange(num_frames) * 0.04)


def _cloud(profile, trajectory):
    n = len(profile)
    return PointCloud(
        points=trajectory.transform(profile.points, profile.time),
        normals=np.zeros((n, 3), np.float32),
        signal=profile.signal,
        posterior=profile.posterior,
        sigma=profile.sigma,
        sigma_common=np.zeros(n, np.float32),
        frame=profile.frame.astype(np.int32),
        scan_line=profile.pixels[:, 0].astype(np.int32),
        laser=profile.laser,
        branch=profile.branch,
    )


def _summary(lit=range(2, 8), **changes):
    profile, trajectory = _profile(lit), _trajectory(10)
    given = {
        "frames": _times(10),
        "trajectory": trajectory,
        "cloud": _cloud(profile, trajectory),
        "num_outliers": 3,
        "mesh_size": (5, 2),
        "settings": {"motion": {"choice": "ConstantSpeed", "speed": 0.1, "along": None}},
        "versions": {"murkscan": "0.1.0"},
        "durations": {"extract": 1.25},
        "pictures": [Shown("../view/isometric.png", "isometric")],
    }
    recorded = changes.pop(
        "recorded", Recorded("dive.mkv", (40, 30), skips=[(4, 1, "4.png broke")])
    )
    return summarise(recorded, changes.pop("rig", RIG), [profile], **(given | changes))


def _dark_summary():
    return _summary([], cloud=None, mesh_size=(0, 0), num_outliers=0, pictures=[])


def _text(page):
    parts = []
    parser = HTMLParser()
    parser.handle_data = parts.append
    parser.feed(page)
    return " ".join(" ".join(parts).split())


def test_spread_is_that_of_the_numbers_and_passes_over_what_is_none():
    spread = Quantiles.from_values(np.array([*np.arange(101.0), math.nan, math.inf]))
    assert spread == Quantiles(0.0, 5.0, 50.0, 95.0, 100.0)
    assert Quantiles.from_values(np.zeros(0)) == Quantiles(None, None, None, None, None)


def test_spacing_is_that_of_neighbours_only():
    profile = _profile([0, 1, 4])
    without_a_column = profile[profile.pixels[:, 0] != 7]
    along = spacing_along(without_a_column, "y")
    np.testing.assert_allclose(along, PITCH, rtol=1e-9)
    assert len(along) == 3 * 17
    across = spacing_across(without_a_column, _trajectory(5), "y")
    # Frames 1 and 4 are no neighbours.
    np.testing.assert_allclose(across, STEP, rtol=1e-9)
    assert len(across) == 19


def test_spacing_follows_the_strongest_branch():
    along = spacing_along(_profile([0], branches=2), "y")
    np.testing.assert_allclose(along, PITCH, rtol=1e-9)
    assert len(along) == 19


def _fields(frames):
    """The same surface, the stripe along columns, in the fields of interlaced video."""
    profile = _profile(frames)
    rows = profile.pixels[:, 0].astype(int)
    fields = profile[rows % 2 == profile.frame % 2]
    return replace(fields, pixels=np.ascontiguousarray(fields.pixels[:, ::-1]))


def test_fields_are_neighbours_of_the_next_field_with_the_same_rows():
    across = spacing_across(_fields(range(4)), _trajectory(4), "x")
    np.testing.assert_allclose(across, 2 * STEP, rtol=1e-9)
    assert len(across) == 20


def test_neighbours_on_the_stripe_of_a_field_are_two_rows_apart():
    # Frames counted from far on: a stored part in the middle of a recording.
    along = spacing_along(_fields(range(1000, 1004)), "x")
    np.testing.assert_allclose(along, 2 * PITCH, rtol=1e-9)
    assert len(along) == 4 * 9


def test_an_empty_part_has_no_spacing():
    empty = _profile([])
    assert len(spacing_along(empty, "x")) == 0
    assert len(spacing_across(empty, _trajectory(2), "x")) == 0


def test_statistics_of_a_frame_are_those_of_its_points():
    statistics = frame_statistics(_profile([3, 5], columns=21))
    np.testing.assert_array_equal(statistics.frame, [3, 5])
    np.testing.assert_array_equal(statistics.points, [21, 21])
    np.testing.assert_allclose(statistics.signal, [[31, 40, 49], [51, 60, 69]])
    np.testing.assert_allclose(statistics.depth, 0.5)


def test_a_timeline_counts_every_frame_once_however_many_there_are():
    number = np.arange(0, 1000, 3)
    timeline = make_timeline(
        _times(1000), [frame_statistics(_profile(part)) for part in np.array_split(number, 4)]
    )
    assert len(timeline.time) == 400
    assert timeline.frames.sum() == 1000
    assert timeline.empty.sum() == 1000 - len(number)
    assert (timeline.points * timeline.frames).sum() == pytest.approx(20 * len(number))
    assert np.all(np.diff(timeline.time) > 0)
    # Steps of two or three frames, of which one at most has points: its own median is the step's.
    has_points = np.isfinite(timeline.signal[:, 1])
    np.testing.assert_allclose(np.diff(timeline.signal[has_points, 1]), 30)


def test_the_summary_counts_frames_and_points():
    content = as_json(_summary())
    assert content["frames"]["read"] == 10
    assert content["frames"]["without_stripe"] == 4
    assert content["frames"]["skipped"] == 1
    assert content["frames"]["skips"] == [{"frame": 4, "frames": 1, "reason": "4.png broke"}]
    assert content["points"] == {"on_profiles": 120, "outliers": 3, "in_cloud": 120}
    assert content["mesh"] == {"vertices": 5, "faces": 2, "origin_m": [0.0, 0.0, 0.0]}
    assert content["spacing_along_stripe_mm"]["median"] == pytest.approx(1.0)
    assert content["spacing_along_motion_mm"]["percent_95"] == pytest.approx(4.0)
    assert content["depth_mm"]["largest"] == pytest.approx(500)
    assert content["size_mm"] == pytest.approx([19, 20, 0])
    assert content["timeline"]["points_per_frame"] == [0, 0, 20, 20, 20, 20, 20, 20, 0, 0]
    assert content["timeline"]["signal_grey_levels_median"][0] is None


def test_parts_of_a_scan_give_what_the_whole_gives():
    whole, parts = _summary(), [_profile([2, 3, 4]), _profile([5, 6, 7])]
    divided = summarise(
        whole.recorded, RIG, iter(parts), frames=_times(10), settings={}, versions={}
    )
    assert divided.signal == whole.signal
    assert divided.num_points == whole.num_points
    np.testing.assert_array_equal(divided.timeline.points, whole.timeline.points)


@pytest.mark.parametrize("summary", [_summary(), _dark_summary()], ids=["lit", "dark"])
def test_the_content_is_json_without_nan(summary):
    content = as_json(summary)
    assert json.loads(json.dumps(content, allow_nan=False)) == content


def test_the_page_shows_the_same_numbers():
    text = _text(as_html(_summary()))
    for words in (
        "found in 6 of 10 frames and gave 120 points",
        "1 frame was skipped",
        "4.png broke",
        "motion · speed 0.1",
        "murkscan 0.1.0",
        "ConstantSpeed",
        "extract 1.2 s",
        "isometric",
        "500 to 500 mm",
        "baseline 100.00 mm along y",
    ):
        assert words in text


def test_a_recording_without_a_stripe_is_said_to_have_none():
    page = as_html(_dark_summary())
    assert "There is no stripe in this recording: none of its 10 frames shows one" in _text(page)
    assert "<svg" not in page
    assert as_json(_dark_summary())["points"]["on_profiles"] == 0
    assert as_json(_dark_summary())["frames"]["without_stripe"] == 10


def test_a_recording_of_one_frame_has_a_report():
    summary = _summary([0], frames=_times(1), cloud=None, mesh_size=(0, 0))
    summary = _covered(summary, [0], 1)
    text = _text(as_html(summary))
    assert "found in 1 of 1 frames" in text
    assert "There is no map" in text
    assert as_json(summary)["coverage"] is None
    assert as_json(summary)["speed"] is None


def _covered(summary, lit, num_frames=10):
    return with_coverage(
        summary, [_profile(lit)], frames=_times(num_frames), trajectory=_trajectory(num_frames)
    )


def test_a_recording_without_a_stripe_has_no_map():
    assert as_json(_covered(_dark_summary(), []))["coverage"] is None


def test_the_map_and_the_speed_are_the_same_on_the_page_and_in_the_file():
    summary = _covered(_summary([0, 1, 2, 3, 6, 7, 8, 9], wanted=2 * STEP), range(10))
    content, page = as_json(summary), as_html(summary)
    area = content["coverage"]["area_m2"]
    # Nine steps of 4 mm, twenty scan lines of 1 mm.
    assert area["all"] == pytest.approx(9 * STEP * 20 * PITCH)
    assert area["covered"] == pytest.approx(area["all"])
    assert len(content["coverage"]["map"]["rows_across"]) == len(
        content["coverage"]["map"]["points"]
    )
    assert content["speed"]["highest_speed_mm_s"] == pytest.approx(2e3 * STEP * 25)
    text = _text(page)
    assert "highest speed for the wanted spacing 200 mm/s" in text
    assert "a spacing of 8 mm, which was asked for" in text
    assert "covered 0.0007200 100.0" in text
    assert "Slow enough: profiles lie 0.5 times the wanted spacing apart" in text
    assert json.loads(json.dumps(content, allow_nan=False)) == content


def test_without_a_wanted_spacing_the_scan_is_its_own_measure():
    """Profiles four times as far apart as points along them are no gap, and no one's mistake."""
    summary = _covered(_summary(range(10)), range(10))
    area = as_json(summary)["coverage"]["area_m2"]
    assert area["covered"] == pytest.approx(area["all"])
    text = _text(as_html(summary))
    assert "4 times as far apart as the points along them" in text
    assert "highest speed for a grid as dense both ways 25 mm/s" in text


def test_too_fast_a_motion_is_told_with_its_cure():
    text = _text(as_html(_summary(wanted=STEP / 2)))
    assert "profiles lie 2 times as far apart as wanted. Move at 50 mm/s or less" in text


def test_a_rig_without_a_record_is_not_called_calibrated():
    for calibration, words in (({}, "holds no record of a calibration"), (None, "not known here")):
        recorded = Recorded("dive.mkv", (40, 30), calibration=calibration)
        assert words in _text(as_html(_summary(recorded=recorded)))


def test_an_old_calibration_is_told():
    step = {"date": "2024-01-01", "verdict": "Good: all of it."}
    written = datetime(2026, 1, 1, tzinfo=UTC)
    recorded = Recorded("dive.mkv", (40, 30), calibration={"camera": step}, written=written)
    text = _text(as_html(_summary(recorded=recorded)))
    assert "More than a year lies between the recording and the calibration of camera" in text
    assert "2024-01-01, 731 days before the recording" in text


def test_a_hostile_name_stays_text():
    hostile = "<script>alert(1)</script>"
    recorded = Recorded(
        hostile,
        (40, 30),
        skips=[(0, 1, hostile)],
        remarks=[hostile],
        path=hostile,
        rig_file=hostile,
        calibration={hostile: {"date": hostile, "verdict": hostile}},
        commands=[hostile],
    )
    pictures = [Shown(f"../view/{hostile}.png", hostile, is_frame=True)]
    page = as_html(_summary(recorded=recorded, settings={hostile: hostile}, pictures=pictures))
    assert "<script" not in page
    # Title, subtitle, remark, skip, path, rig's file, a step's name and verdict, the command, a
    # setting and its value, a caption; and the step's name in the sentence above its table.
    assert _text(page).count(hostile) >= 12


def test_rigs_under_water_are_described():
    window = FlatPort(np.array([0.0, 0.0, 1.0]), 0.03, (Layer(0.008, 1.49),))
    fan = Fan.spread(
        np.array([0.0, -0.25, 0.0]),
        np.array([0.0, 0.4, 0.9]),
        np.array([1.0, 0.0, 0.0]),
        0.4,
        window,
    )
    dome = DomePort(np.zeros(3), 0.05, 0.005, 1.5)
    rig = Rig(replace(RIG.camera, port=dome), (Laser.from_sheet(fan),), water=Water())
    text = _text(as_html(_summary(rig=rig)))
    assert "a dome of inner radius 50 mm, 5 mm of index 1.5" in text
    assert "nearest plane of a sheet bent by a flat port at 30 mm, 8 mm of index 1.49" in text
    # Quan and Fry's index at 20 degrees and 35 PSU for 532 nm.
    assert "20 °C, 35 PSU, 0 m deep: index 1.34151" in text
