"""murkscan dive lists what a file holds, and a scan of it says what it needs."""

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("mcap", reason="the extra [dive] is not installed")
sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))

from dive_files import Dive, encode_h264, write_blueos

from murkscan.cli.main import run
from murkscan.io.rig_toml import save_rig
from murkscan.types.trajectory import Trajectory

from ..scenes import air_rig


@pytest.fixture(scope="module")
def dive(tmp_path_factory):
    """A short dive that knows its attitude and depth alone."""
    folder = tmp_path_factory.mktemp("dive")
    pictures = [np.full((64, 96), 20 + k, np.uint8) for k in range(20)]
    times = np.arange(-0.2, 1.2, 0.1)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    way = Trajectory(times, np.zeros((len(times), 3)), still)
    write_blueos(
        folder / "dive.mcap",
        Dive(encode_h264(pictures, 25.0), np.arange(20) / 25, way),
        position=False,
    )
    save_rig(folder / "rig.toml", air_rig())
    return folder


def test_a_listing_names_topics_and_the_command_that_scans(dive, capsys):
    assert run(["dive", str(dive / "dive.mcap")]) == 0
    said = capsys.readouterr().out
    assert "mavlink/1/1/ATTITUDE" in said
    assert "pictures: h264" in said
    assert "--speed-mm-s V" in said


def test_a_scan_without_a_speed_asks_for_it_before_anything_is_written(dive, capsys):
    out = dive / "out"
    words = ["scan", str(dive / "dive.mcap"), "--rig", str(dive / "rig.toml"), "--out", str(out)]
    for more in ([], ["--no-navigation"]):
        assert run([*words, *more]) == 2
        assert "--speed-mm-s" in capsys.readouterr().err
    assert run([*words, "--speed-mm-s", "100", "--topic", "other"]) == 2
    assert "video/UDP Stream/stream" in capsys.readouterr().err
    assert not out.exists()


def test_what_is_no_dive_is_one_sentence(tmp_path, capsys):
    (tmp_path / "a.mcap").write_bytes(b"no MCAP at all")
    for path in ("a.mcap", "missing.bag"):
        assert run(["dive", str(tmp_path / path)]) == 2
        assert path in capsys.readouterr().err
