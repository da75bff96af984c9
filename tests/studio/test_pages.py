"""What pages are told: commands as they are typed, rigs, plans, and jobs to their end."""

import time

import numpy as np
import pytest
from cyclopts import App

from murkscan import load_rig
from murkscan.cli.main import app
from murkscan.cli.progress import progress_bars
from murkscan.io.images import write_image
from murkscan.live import LiveFolder, LivePoints, LiveStatus
from murkscan.optics.medium import Medium
from murkscan.plan import (
    Conditions,
    attenuation_from_secchi,
    attenuation_from_visibility,
    forecast,
    place_laser,
)
from murkscan.studio.commands import FORMS
from murkscan.ui.progress_lines import ASK, read_progress

from .conftest import RIG


def flags_of(name):
    """Give the flags of a command, by the command line itself."""
    place: App = app
    for word in name.split():
        place = place[word]
    collection = place.assemble_argument_collection()
    return {flag.removeprefix("--") for argument in collection for flag in argument.names}


@pytest.mark.parametrize("name", sorted(FORMS))
def test_each_flag_of_the_studio_is_one_of_its_command(name):
    assert set(FORMS[name].flags) <= flags_of(name)


def run_to_its_end(ask, command, values):
    started = ask.post("api/jobs", json={"command": command, "values": values, "page": "test"})
    assert started.status_code == 200, started.text
    for _ in range(600):
        job = ask.get("api/folder").json()["jobs"][0]
        if job["state"] != "running":
            return job
        time.sleep(0.1)
    raise AssertionError("it never ended")


def test_a_job_is_the_command_it_says_and_one_runs_at_a_time(folder, ask):
    asked = {"out": "a board.pdf", "board": "9x6", "square-mm": 25}
    started = ask.post("api/jobs", json={"command": "calibrate board", "values": asked})
    text = started.json()["text"]
    assert text == "murkscan calibrate board 'a board.pdf' --board 9x6 --square-mm 25"
    second = ask.post("api/jobs", json={"command": "calibrate board", "values": asked})
    assert second.status_code == 400
    assert f"One thing at a time: `{text}` is at work." in second.text
    name = started.json()["name"]
    while ask.get("api/folder").json()["jobs"][0]["state"] == "running":
        time.sleep(0.1)
    assert (folder / "a board.pdf").read_bytes().startswith(b"%PDF")
    assert ask.post(f"api/jobs/{name}/stop", json={}).json()["state"] == "done"


def test_what_a_command_refuses_is_its_own_sentence(ask):
    job = run_to_its_end(ask, "calibrate board", {"out": "b.pdf", "board": "9", "square-mm": 25})
    assert job["state"] == "refused"
    assert job["sentence"].startswith("--board '9' is not a board")


def test_a_rig_is_told_part_by_part(ask):
    rig = ask.get("api/rig", params={"name": "rig.toml"}).json()
    assert [step["step"] for step in rig["steps"]] == ["camera", "port", "laser 0", "mount"]
    assert [step["is_there"] for step in rig["steps"]] == [True, False, True, False]
    assert not any(step["is_calibrated"] for step in rig["steps"])


def test_a_rig_that_is_none_is_a_sentence(folder, ask):
    (folder / "bad.toml").write_text(RIG.replace("[[laser]]", "[[lasers]]"))
    assert "lasers is unknown" in ask.get("api/rig", params={"name": "bad.toml"}).json()["fault"]
    asked = {"rig": "bad.toml", "visibility-m": 3}
    assert ask.get("api/plan", params=asked).status_code == 400


def test_a_plan_is_by_the_plan_s_own_formulas(folder, ask):
    told = ask.get("api/plan", params={"rig": "rig.toml", "visibility-m": 3, "power-mw": 30}).json()
    medium = Medium(attenuation_from_visibility(3.0))
    whole = forecast(load_rig(folder / "rig.toml"), Conditions(medium))
    # Between two of the page's distances, which are 13 % apart.
    np.testing.assert_allclose(told["reach_m"], whole.reach, rtol=0.13)
    noise = np.array(told["sigma_mm"]["noise"], float)
    known = np.interp(told["depths_m"], whole.depths, 1e3 * whole.median(whole.sigma_along))
    both = np.isfinite(noise) & np.isfinite(known)
    assert both.sum() > 5
    # Five scan lines for fifteen.
    np.testing.assert_allclose(noise[both], known[both], rtol=0.3)


def test_a_laser_is_planned_as_if_it_sat_elsewhere_and_where_it_would_better(folder, ask):
    asked = {"rig": "rig.toml", "secchi-m": 4.3}
    here = ask.get("api/plan", params=asked).json()
    moved = ask.get("api/plan", params={**asked, "baseline-mm": 450, "angle-deg": 75}).json()
    assert (here["baseline_mm"], here["angle_deg"]) == pytest.approx((300.0, 65.0))
    assert (moved["baseline_mm"], moved["angle_deg"]) == pytest.approx((450.0, 75.0))
    best = ask.get("api/plan/best", params=asked).json()
    assert 50 <= best["baseline_mm"] <= best["longest_mm"] == pytest.approx(600.0)
    conditions = Conditions(Medium(attenuation_from_secchi(4.3)))
    placed = place_laser(
        load_rig(folder / "rig.toml"), conditions, near=best["near_m"], far=best["far_m"],
        longest=0.6,
    )  # fmt: skip
    assert best["baseline_mm"] == pytest.approx(1e3 * placed.baseline)
    assert best["sigma_mm"] == pytest.approx(1e3 * placed.sigma)
    assert ask.get("api/plan", params={**asked, "angle-deg": 190}).status_code == 400


@pytest.mark.parametrize("water", [{}, {"visibility-m": "far"}, {"visibility-m": "-1"}])
def test_a_plan_without_its_water_is_a_sentence(ask, water):
    answer = ask.get("api/plan", params={"rig": "rig.toml", **water})
    assert answer.status_code == 400
    assert answer.text.endswith((".", "'far'."))


def test_boards_are_found_in_a_folder_as_photographs_come(folder, ask):
    photos = folder / "boards"
    photos.mkdir()
    squares = np.kron(np.indices((7, 10)).sum(axis=0) % 2, np.ones((30, 30)))
    board = np.pad(190 * squares + 40, 60, constant_values=230).astype(np.uint8)
    write_image(photos / "a.png", board)
    write_image(photos / "b.png", np.full(board.shape, 90, np.uint8))
    for _ in range(300):
        told = ask.get("api/boards", params={"folder": "boards", "board": "9x6"}).json()
        if told["so_far"]:
            break
        time.sleep(0.1)
    first, second = told["photos"]
    assert (first["reason"], len(first["corners"])) == ("", 54)
    assert second["reason"] == "shows no chessboard"
    assert "Need at least 4 views" in told["so_far"]["verdict"]
    assert told["so_far"]["precisions"] == []
    assert ask.get("api/boards", params={"folder": "boards", "board": "9"}).status_code == 400


def test_a_dive_is_shown_as_its_files_say(folder, ask):
    nothing = ask.get("api/dive", params={"name": "dive"}).json()
    assert (nothing["status"], nothing["parts"]) == (None, 0)
    live = LiveFolder(folder / "dive" / "live")
    live.save_status(LiveStatus(state="live", warnings=("The stripe is lost.",)))
    rows = np.arange(24, dtype=np.float32).reshape(6, 4)
    for part, some in enumerate((rows[:2], rows[2:])):
        frame = np.zeros(len(some), np.uint32)
        live.save_points(part, LivePoints(some[:, :3], some[:, 3], frame))
    told = ask.get("api/dive", params={"name": "dive"}).json()
    assert told["status"]["warnings"] == ["The stripe is lost."]
    assert told["parts"] == 2
    assert "dive" in ask.get("api/folder").json()["found"]["dives"]
    for first, expected in ((0, rows), (1, rows[2:]), (2, rows[:0])):
        answer = ask.get("api/points", params={"name": "dive", "first": first})
        assert answer.headers["x-next"] == "2"
        np.testing.assert_array_equal(np.frombuffer(answer.content, "<f4"), expected.ravel())
    for wrong in ("-1", "x", "9" * 30):
        assert ask.get("api/points", params={"name": "dive", "first": wrong}).status_code == 400


def test_a_board_has_the_size_it_says():
    from murkscan.calibrate import Chessboard
    from murkscan.calibrate.board.printed import print_board

    drawn = print_board(Chessboard(9, 6, 25e-3), kind="svg").decode()
    # Points of 1/72 inch: 12 squares wide.
    assert f'width="{12 * 25 / 25.4 * 72:.6f}pt"'[:14] in drawn


def test_a_command_tells_a_program_how_far_it_is_in_lines(capfd, monkeypatch):
    monkeypatch.setenv(ASK, "lines")
    with progress_bars() as progress:
        progress("extract", 3, 10)
    line = capfd.readouterr().err
    assert read_progress(line) == ("extract", 3, 10)
    assert read_progress("murkscan: no") is None


def test_records_of_calibrations_are_no_rigs_to_work_with(folder, ask):
    for name in ("rig.toml", "calibrate/records/20261130T120000Z-camera.toml"):
        (folder / "quay" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "quay" / name).write_text("format = 1\n[camera]\n", "utf-8")
    rigs = ask.get("api/folder").json()["found"]["rigs"]
    assert [name for name in rigs if name.startswith("quay")] == ["quay/rig.toml"]
