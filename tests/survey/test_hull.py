"""A scan laid on three points of a ship: places, sections and the page tell frames and sides."""

import csv
import json

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.project import MESH, MeshResult, Project, load_georeference
from murkscan.survey.shown import load_model, load_surface
from murkscan.types.hull import HullFrame
from murkscan.types.mesh import Mesh

from ..projects import finish

SPACING, KEEL, BOW = 0.6, 2.0, 25.2
"""Distance of the frames; height of the model's y = 0; frame 42 at the model's x = 0 [m]."""
HEAD = "name,frame,height_m,from_centreline_m,side,sigma_mm,x_m,y_m,z_m\n"
ON_MODEL = np.array([[0.0, 0.0, 1.0], [0.9, 0.1, 1.2], [0.2, -0.8, 1.1]])


def frame_of(points):
    """The camera looks to port at a starboard side: x runs forward, y down, z to port."""
    return (BOW + points[:, 0]) / SPACING, KEEL - points[:, 1], 6.0 - points[:, 2]


def table(points=ON_MODEL, side="starboard", sigma=3):
    rows = zip(*frame_of(points), points, strict=True)
    lines = [
        f"P{n},{frame},{height},{off},{side},{sigma},{','.join(map(str, point.tolist()))}"
        for n, (frame, height, off, point) in enumerate(rows)
    ]
    return HEAD + "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def side(tmp_path_factory):
    """A scan of a ship's starboard side, 1 m wide, that recedes by 0.2 m a metre."""
    u, v = (grid.ravel() for grid in np.mgrid[0:41, 0:31])
    points = np.stack([u / 40, v / 30 - 0.8, 1 + 0.2 * u / 40], axis=1)
    normals = np.tile(np.array([0.2, 0, -1]) / 1.0198, (len(points), 1))
    folder = tmp_path_factory.mktemp("ship")
    np.savetxt(folder / "side.xyz", np.concatenate([points, normals], axis=1), "%.7f")
    assert run(["merge", str(folder / "side.xyz"), "--out", str(folder / "out")]) == 0
    corner = (u[:, None] * 31 + v[:, None])[(u < 40) & (v < 30)]
    faces = (corner[:, None] + np.array([[0, 31, 1], [1, 31, 32]])).reshape(-1, 3)
    project = Project(folder / "out")
    finish(
        project,
        MESH,
        MeshResult(len(points), len(faces)),
        make=lambda: project.save_mesh(Mesh(points, faces, points=np.arange(len(points)))),
    )
    return project


def lay(project, text, *flags):
    file = project.root.parent / "hull.csv"
    file.write_text(text, "utf-8")
    return run(["georeference", str(project.root), "--hull", str(file), *flags])


def lay_on_frames(project, text=None):
    return lay(project, text or table(), "--frame-spacing-mm", "600")


def test_three_points_tell_frame_height_and_side(side, capsys):
    assert lay_on_frames(side) == 0
    said = capsys.readouterr()
    assert "inside" not in said.out + said.err
    place = load_georeference(side)
    points = np.array([[0.3, -0.5, 1.06], [0.9, 0.0, 1.18]])
    for told, frame, height, off in zip(place.tell(points), *frame_of(points), strict=True):
        assert told == [
            pytest.approx(frame, abs=1e-3), pytest.approx(height, abs=1e-3), "starboard",
            pytest.approx(off, abs=1e-3),
        ]  # fmt: skip
    assert place.describe(np.array([0.3, -0.5, 1.06])) == (
        "frame 42.50, 2.500 m above the keel, 4.940 m to starboard"
    )


def test_measures_and_sections_tell_them(side, capsys):
    assert lay_on_frames(side) == 0
    ends = ("--from-m", "0.3,-0.5,1.06", "--to-m", "0.9,0,1.18")
    assert run(["measure", str(side.root), "distance", *ends]) == 0
    assert "from: frame 42.50, 2.500 m above the keel" in capsys.readouterr().out
    details = json.loads((side.root / "measure/distance.json").read_text("utf-8"))["details"]
    assert details["places"]["to"]["frame"] == pytest.approx(43.5, abs=0.04)  # the nearest point
    assert details["places"]["to"]["side"] == "starboard"
    assert run(["measure", str(side.root), "section", "--at-frame", "43"]) == 0
    with (side.root / "measure/section.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {round(float(row["frame"]), 2) for row in rows} == {43.0}
    x = np.array([float(row["x_mm"]) for row in rows])
    up = np.array([float(row["above_keel_m"]) for row in rows])
    y = np.array([float(row["y_mm"]) for row in rows])
    # On the drawing y is up, from the same middle, and starboard is to the right.
    assert np.ptp(1e3 * up - y) < 0.11  # rounded to 0.1 mm
    off = np.array([float(row["from_centreline_m"]) for row in rows])
    assert np.ptp(1e3 * off - x) < 0.11
    assert np.ptp(up) > 0.9


def test_the_page_tells_them(side):
    assert lay_on_frames(side) == 0
    from murkscan.view.viewer_page import _about_place

    about = _about_place(load_model(side, load_surface(side), most=1000).place)
    assert about["hull"] == {"spacing": 0.6, "framesFrom": "stern", "heightsAbove": "keel"}
    aft = np.array(about["rotation"]) @ [0.3, -0.5, 1.06] + about["translation"]
    assert -aft[0] / 0.6 == pytest.approx(42.5, abs=1e-3)


def test_the_distance_from_the_bow_is_told_without_frames(side):
    frame, height, off = frame_of(ON_MODEL)
    lines = [
        f"P{n},{120 - SPACING * f},{h},{o},S,3,{','.join(map(str, p))}"
        for n, (f, h, o, p) in enumerate(zip(frame, height, off, ON_MODEL.tolist(), strict=True))
    ]
    text = HEAD.replace("frame", "from_bow_m") + "\n".join(lines) + "\n"
    assert lay(side, text, "--heights-above", "waterline") == 0
    told = load_georeference(side).describe(np.array([0.3, -0.5, 1.06]))
    assert told == "94.500 m from the bow, 2.500 m above the waterline, 4.940 m to starboard"
    assert run(["measure", str(side.root), "section", "--from-bow-m", "94.2"]) == 0


def test_points_told_for_the_other_side_are_noticed(side, capsys):
    assert lay_on_frames(side, table(side="port")) == 0  # three points lie on a plane: both fit
    assert "from inside" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("text", "flags", "words"),
    [
        (table(), (), "lacks the column from_bow_m"),
        (table(), ("--frame-spacing-mm", "0"), "above 0"),
        (table(), ("--frame-spacing-mm", "700"), "as far apart as on the model"),
        (table(side="left"), ("--frame-spacing-mm", "600"), "write port, starboard"),
        (table(), ("--frame-spacing-mm", "600", "--crs", "EPSG:25832"), "Give --control and --crs"),
        (table(ON_MODEL * [1, 0, 0]), ("--frame-spacing-mm", "600"), "on a line"),
    ],
)
def test_what_tells_no_place_on_a_ship_is_one_sentence(side, capsys, text, flags, words):
    assert lay(side, text, *flags) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1


def test_frames_are_counted_from_either_end():
    stern, bow = HullFrame(0.5, "stern"), HullFrame(0.5, "bow")
    assert stern.station_of(stern.aft_of(12.5)) == bow.station_of(bow.aft_of(12.5)) == 12.5
    assert stern.aft_of(12.5) == -bow.aft_of(12.5) == -6.25
    assert bow.tell((6.0, -0.25, 1.0)) == (12.0, 1.0, "port", 0.25)
