"""Scans whose log does not cover them: what is left out, and what is said."""

import json

import numpy as np
import pytest

import murkscan as ms
from murkscan.cli.main import run


@pytest.fixture
def typed(fault):
    """Give the words of a scan of the recorded stairs, as far as its log."""
    recording = fault("recording")
    rig, frames = str(recording / "rig.toml"), str(recording / "frames")
    return ["scan", frames, "--rig", rig, "--extractor", "gray-gravity"]


@pytest.mark.parametrize(
    ("name", "missing", "words"),
    [
        ("late.csv", range(2), "2 of 60 frames lie outside the log"),
        ("gap.csv", range(20, 45), "25 of 60 frames lie in holes of the log"),
    ],
)
def test_frames_without_a_pose_are_left_out_and_told(
    fault, typed, tmp_path, capsys, name, missing, words
):
    out = tmp_path / "out"
    assert run([*typed, "--poses", str(fault(f"poses/{name}")), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert words in said
    assert "times in seconds" in said
    frames = np.unique(ms.Project(out).load_cloud().frame)
    np.testing.assert_array_equal(frames, np.setdiff1d(np.arange(60), missing))
    report = json.loads((out / "report" / "report.json").read_text())
    assert any(words in remark for remark in report["recording"]["remarks"])


def test_a_log_of_another_time_is_refused_before_anything_is_extracted(
    fault, typed, tmp_path, capsys
):
    log = str(fault("poses/rov_nav.csv"))
    assert run([*typed, "--poses", log, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "from 0.000 to 2.360 s by its clock" in said
    assert "from 1625140800.000" in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("flag", ["--gap-s=1", "--log-time=ns", "--log-axes=enu"])
def test_what_is_said_of_a_log_needs_one(typed, tmp_path, capsys, flag):
    assert run([*typed, "--speed-mm-s", "100", flag, "--out", str(tmp_path / "out")]) == 2
    assert "goes with --poses" in capsys.readouterr().err
