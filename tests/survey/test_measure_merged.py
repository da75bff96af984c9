"""Every measure of a cloud that was merged from two passes."""

import json
from dataclasses import replace

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.io.ply import save_cloud
from murkscan.types.mesh import Mesh

from ..scans import scan_cloud

NEAR = ("--near-m", "0,0,0.47", "--within-mm", "25")
MEASURES = {
    "distance": ("--from-m", "-0.04,-0.04,0.5", "--to-m", "0.04,0.04,0.5"),
    "section": ("--point-m", "0,0,0.47", "--normal", "0,1,0"),
    "area": NEAR,
    "volume": ("--point-m", "0,0,0.5", "--normal", "0,0,-1"),
    "plane": ("--near-m", "-0.045,-0.045,0.5", "--within-mm", "15"),
    "sphere": NEAR,
    "cylinder": ("--box-m", "0.034,-0.055,0.45,0.058,0.055,0.55"),
    "step": (
        "--first-m",
        "-0.045,-0.045,0.5",
        "--second-m",
        "0.045,0.045,0.5",
        "--within-mm",
        "12",
    ),
    "deviation": ("--reference", "wall.ply", "--as-given"),
    "dents": ("--reference", "wall.ply", "--as-given", "--largest-mm", "80"),
}


def ball_on_wall(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A cap of 50 mm radius that stands 30 mm before a wall, which is bent about x."""
    with np.errstate(invalid="ignore"):
        cap = 0.52 - np.sqrt(0.05**2 - x * x - y * y)
    return np.fmin(cap, 0.5 + y * y)


@pytest.fixture(scope="module")
def merged(tmp_path_factory):
    """Merge two passes, of which the second lies a millimetre off."""
    from murkscan.io.mesh_files import save_mesh

    folder = tmp_path_factory.mktemp("merged")
    first = scan_cloud(ball_on_wall, spacing=2e-3, noise=1e-4)
    other = scan_cloud(ball_on_wall, spacing=2.1e-3, noise=1e-4)
    off = np.array([4e-4, -3e-4, 1e-3])
    save_cloud(folder / "first.ply", first)
    save_cloud(folder / "second.ply", replace(other, points=other.points + off))
    corners = np.array([[-1.0, -1, 0.5], [1, -1, 0.5], [1, 1, 0.5], [-1, 1, 0.5]])
    save_mesh(folder / "wall.ply", Mesh(corners, np.array([[0, 2, 1], [0, 3, 2]])))
    passes = [str(folder / f"{name}.ply") for name in ("first", "second")]
    assert run(["merge", *passes, "--out", str(folder / "both")]) == 0
    assert run(["mesh", str(folder / "both")]) == 0
    return folder / "both"


def measured(merged, what: str) -> dict:
    given = [text.replace("wall.ply", str(merged.parent / "wall.ply")) for text in MEASURES[what]]
    assert run(["measure", str(merged), what, *given]) == 0
    return json.loads((merged / "measure" / f"{what}.json").read_text("utf-8"))


@pytest.mark.parametrize("what", MEASURES)
def test_every_measure_is_taken_and_has_an_interval(merged, what, capsys):
    for quantity in measured(merged, what)["quantities"].values():
        low, high = quantity["interval_95"]
        assert low <= quantity["value"] <= high
    if what not in ("deviation", "dents"):
        assert "Of ../first.ply, ../second.ply no rig" in capsys.readouterr().out


def test_the_report_tells_of_each_pass_and_of_their_disagreement(merged):
    assert run(["view", str(merged)]) == 0
    assert run(["report", str(merged)]) == 0
    told = json.loads((merged / "report" / "report.json").read_text("utf-8"))
    assert [one["path"] for one in told["merged"]] == ["../first.ply", "../second.ply"]
    assert told["merged"][0]["shift_mm"] is None
    # It lay (0.4, -0.3, 1) mm off; the ball shows all three directions, the wall the last one best.
    assert told["merged"][1]["shift_mm"] == pytest.approx([-0.4, 0.3, -1.0], abs=0.1)
    (pair,) = told["disagreement"]
    assert pair["passes"] == [0, 1]
    assert pair["share"] > 0.7
    assert abs(pair["mean_mm"]) < pair["rms_mm"] < pair["within_95_percent_mm"] < 0.2
    page = (merged / "report" / "index.html").read_text("utf-8")
    for words in ("../first.ply", "stays where it is", "Disagreement of the passes"):
        assert words in page
    assert run(["check", str(merged)]) == 0


def test_the_radius_of_a_ball_seen_by_both_passes_lies_in_its_interval(merged):
    low, high = measured(merged, "sphere")["quantities"]["radius_m"]["interval_95"]
    assert low < 0.05 < high
    assert high - low < 1e-3


def test_the_place_of_a_ball_is_no_better_known_than_the_alignment(merged):
    note = json.loads((merged / "cloud" / "stage.json").read_text("utf-8"))
    alignment = note["result"]["passes"][1]["alignment"]
    shift = np.sqrt(np.diag(alignment["covariance_of_turn_and_shift"]))[5]
    common = measured(merged, "sphere")["quantities"]["z_m"]["sigma_common"]
    # One of two passes moves, so the ball by about half of it; the turn adds a little.
    assert 0.3 * shift < common < shift
