"""What a dive shows is read back as it was written, and an earlier dive's preview goes."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import FormatError
from murkscan.live import GapMap, LiveFolder, LivePoints, LiveStatus
from murkscan.live.status import Recorded, ScanProgress, StandOff


@pytest.fixture
def folder(tmp_path):
    return LiveFolder(tmp_path / "live")


def points_of(count):
    numbers = np.arange(count)
    places = np.arange(3 * count, dtype=np.float32).reshape(count, 3)
    return LivePoints(places, numbers.astype(np.float32), numbers.astype(np.uint32))


def gap_map(state):
    return GapMap(
        state.astype(np.uint8), ("no_stripe", "too_fast"), 0.005, (0.1, -0.2),
        np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), 0.3, 0.1,
    )  # fmt: skip


def test_a_status_comes_back_as_it_was(folder):
    status = LiveStatus(
        state="live",
        recorded=Recorded(12, 0.48, 999, "capture/dive.part.mkv", 1),
        stand_off=StandOff(0.5, 0.3, 0.9, "good"),
        warnings=("The stripe is lost.",),
        scan=ScanProgress("extract", 3, None, None),
    )
    folder.save_status(status)
    assert folder.load_status() == status
    folder.save_status(replace(status, state="lost"))
    assert folder.load_status().state == "lost"


def test_keys_say_their_units(folder):
    folder.save_status(LiveStatus())
    text = (folder.root / "status.json").read_text()
    for key in ("latency_s", "value_mm_s", "attenuation_per_m", "free_bytes", "covered_m2"):
        assert f'"{key}"' in text


def test_points_and_gaps_come_back_as_they_were(folder):
    points = points_of(2)
    folder.save_points(3, points)
    assert folder.find_points() == [3]
    np.testing.assert_array_equal(folder.load_points(3).points, points.points)
    assert folder.load_gaps() is None
    folder.save_gaps(gap_map(np.array([[0, 1, 255], [2, 0, 0]])))
    found = folder.load_gaps()
    np.testing.assert_array_equal(found.state, [[0, 1, 255], [2, 0, 0]])
    assert (found.cell, found.corner, found.causes[1]) == (0.005, (0.1, -0.2), "too_fast")
    assert found.share == pytest.approx(0.75)


def test_a_new_dive_begins_with_an_empty_preview_and_leaves_other_files(folder):
    folder.save_status(LiveStatus())
    folder.save_points(0, points_of(0))
    (folder.root / "notes.txt").write_text("mine")
    folder.clear()
    assert {file.name for file in folder.root.rglob("*") if file.is_file()} == {"notes.txt"}


def test_what_the_map_is_drawn_up_from_comes_back(folder):
    assert folder.load_cells() is None
    folder.save_cells({"along": np.array([3, 4]), "covered_m2": np.array([0.5, 0.25])})
    found = folder.load_cells()
    assert found["along"].tolist() == [3, 4]
    assert found["covered_m2"].tolist() == [0.5, 0.25]
    folder.clear()
    assert folder.load_cells() is None


def test_a_damaged_map_is_told_by_its_name(folder):
    folder.save_gaps(gap_map(np.zeros((1, 1))))
    (folder.root / "gaps.json").write_text('{"shape": [1, 1]}')
    with pytest.raises(FormatError, match=r"gaps\.json"):
        folder.load_gaps()
