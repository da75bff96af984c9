"""Where a scan comes from: what is written down so that a report can say it."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from murkscan.project import (
    CLOUD,
    EXTRACT,
    MESH,
    MOTION,
    TRIANGULATE,
    VIEW,
    CloudResult,
    ExtractResult,
    MeshResult,
    MotionResult,
    Project,
    TriangulateResult,
    ViewResult,
)
from murkscan.project.origin import name_recording, read_calibration, when_written
from murkscan.survey.recorded import list_commands, when_began
from murkscan.types.frame_times import FrameTimes

from ..projects import finish

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
    record = read_calibration(file)
    assert json.loads(json.dumps(record)) == {
        "camera": {"date": "2026-05-01", "verdict": "Good: all of it."}
    }


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
    assert when_written(tmp_path).timestamp() == 5000
    assert when_written(tmp_path / "a.png").timestamp() == 1000
    assert when_written(tmp_path / "none.mkv") is None


def test_what_was_typed_for_each_stage_is_listed_once_and_in_order(tmp_path):
    def stage_by(words, kind, result):
        finish(Project(tmp_path, words), kind, result)

    stage_by(
        ("extract", "my dive.mkv", "--out", "my out"), EXTRACT, ExtractResult((0,), 1, 0, 0, 1)
    )
    for kind, result in (
        (TRIANGULATE, TriangulateResult(1, 0)),
        (MOTION, MotionResult(1)),
        (CLOUD, CloudResult(1, 0)),
    ):
        stage_by(("scan", "x"), kind, result)
    stage_by((), MESH, MeshResult(0, 0))
    stage_by(("view", "my out"), VIEW, ViewResult((), 0))
    assert list_commands(Project(tmp_path, ("report", "my out"))) == [
        "murkscan extract 'my dive.mkv' --out 'my out'",
        "murkscan scan x",
        "murkscan view 'my out'",
        "murkscan report 'my out'",
    ]


def test_only_a_clock_that_counts_from_1970_tells_when_a_recording_began():
    frames = FrameTimes(np.zeros(1, np.uint32), np.array([2.0]))
    assert when_began(frames, 1.75e9 + 0.5).timestamp() == pytest.approx(1.75e9 + 2.5)
    assert when_began(frames, 12.0) is None
    assert when_began(frames, 0.0) is None
