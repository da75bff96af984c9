"""Where a scan comes from: what is written down so that a report can say it."""

import json
import os
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from murkscan.survey.origin import name_recording, tell_origin, when_written
from murkscan.survey.recorded import commands_of, when_began
from murkscan.types.frame_times import FrameTimes

RIG = """
[calibration.camera]
date = 2026-05-01
verdict = "Good: all of it."
before = {camera = 1}
[calibration.covariance]
parameters = ["a"]
"""


def test_the_record_of_a_calibration_is_kept_without_its_bulk(tmp_path):
    file = tmp_path / "rig.toml"
    file.write_text(RIG)
    origin = tell_origin(file, ["scan", "my dive"])
    assert json.loads(json.dumps(origin)) == {
        "command": ["scan", "my dive"],
        "rig_file": str(file),
        "calibration": {"camera": {"date": "2026-05-01", "verdict": "Good: all of it."}},
    }
    assert tell_origin(None, ()) == {}


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("dives/hull.mkv", "hull.mkv"),
        ("dives/monday", "monday"),
        ("dives/monday/frames", "monday"),
        ("./monday/frames", "monday"),
        ("frames", "frames"),
        ("../frames", "frames"),
        ("/frames", "frames"),
    ],
)
def test_a_folder_of_frames_is_named_by_what_it_belongs_to(path, name):
    assert name_recording(Path(path)) == name


def test_a_recording_is_as_old_as_its_last_file(tmp_path):
    for name, age in (("a.png", 1000), ("b.png", 5000)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (age, age))
    assert datetime.fromisoformat(when_written(tmp_path)).timestamp() == 5000
    assert datetime.fromisoformat(when_written(tmp_path / "a.png")).timestamp() == 1000
    assert when_written(tmp_path / "none.mkv") is None


@pytest.mark.parametrize(
    ("motion", "flags"),
    [
        ({"type": "ConstantSpeed", "speed": -0.1, "along": "y"}, "--speed-mm-s -100 --along y"),
        ({"type": "ConstantStep", "step": 0.0025, "along": "x"}, "--step-mm 2.5 --along x"),
        (
            {"type": "PoseLog", "name": "my log.csv", "start_time": 5.0, "time_offset": 0.1},
            "--poses 'my log.csv' --start-time 5.0 --time-offset-s 0.1",
        ),
    ],
)
def test_stages_that_were_run_one_by_one_are_lines_that_do_the_same(motion, flags):
    lines = commands_of("my out", ("extract", "my dive.mkv", "--out", "my out"), motion)
    assert lines[0] == "murkscan extract 'my dive.mkv' --out 'my out'"
    assert f"murkscan motion 'my out' {flags}" in lines
    assert lines[-1] == "murkscan report 'my out'"
    assert commands_of("out", (), motion) == []
    assert commands_of("out", ("scan", "a"), motion) == ["murkscan scan a"]


def test_only_a_clock_that_counts_from_1970_tells_when_a_recording_began():
    frames = FrameTimes(np.zeros(1, np.uint32), np.array([2.0]))
    moment = when_began(frames, {"start_time": 1.75e9, "time_offset": 0.5})
    assert moment.timestamp() == pytest.approx(1.75e9 + 2.5)
    assert when_began(frames, {"start_time": 12.0, "time_offset": 0.0}) is None
    assert when_began(frames, {}) is None
