"""Measures of a whole scan, as the command takes them."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.io.mesh_files import load_mesh, save_mesh
from murkscan.project import CLOUD, CloudResult, Project
from murkscan.types.cloud_part import CloudPart
from murkscan.types.mesh import Mesh

from ..projects import finish


@pytest.fixture(scope="module")
def scanned(hull, tmp_path_factory):
    """Give a scan of some frames that show the hull."""
    folder = tmp_path_factory.mktemp("measured")
    (folder / "frames").mkdir()
    for i in range(50, 62):
        shutil.copy(hull / "frames" / f"{i:06d}.png", folder / "frames")
    out = folder / "out"
    rig, step = ("--rig", str(hull / "rig.toml")), ("--step-mm", "7.7")
    assert run(["extract", str(folder / "frames"), *rig, "--out", str(out)]) == 0
    assert run(["triangulate", str(out)]) == 0
    assert run(["motion", str(out), *step]) == 0
    assert run(["cloud", str(out)]) == 0
    assert run(["mesh", str(out)]) == 0
    return out


def middle(scanned) -> str:
    points = Project(scanned).load_cloud().points
    nearest = points[np.argmin(np.linalg.norm(points - np.median(points, axis=0), axis=1))]
    return ",".join(f"{part:.6f}" for part in nearest)


def measure(scanned, *arguments) -> int:
    return run(["measure", str(scanned), *arguments])


def read(scanned, name) -> dict:
    return json.loads((scanned / "measure" / f"{name}.json").read_text("utf-8"))


def test_a_measure_is_printed_and_written_with_units_and_interval(scanned, capsys):
    assert measure(scanned, "plane", "--near-m", middle(scanned), "--within-mm", "30") == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "±95%" in said
    assert "The rig file states no covariance" in said
    found = read(scanned, "plane")
    assert found["kind"] == "plane"
    low, high = found["quantities"]["distance_m"]["interval_95"]
    assert low < found["quantities"]["distance_m"]["value"] < high
    assert found["quantities"]["distance_m"]["sigma_common"] > 0  # the step is known to 1 %


def test_a_plane_through_a_hull_says_that_it_is_none(scanned, capsys):
    assert measure(scanned, "plane", "--name", "whole") == 0
    (said,) = read(scanned, "whole")["remarks"]
    assert "lie" in said
    assert said in capsys.readouterr().out


def test_out_and_what_may_come_in_either_order(scanned):
    part = ("--near-m", middle(scanned), "--within-mm", "30", "--name", "other")
    assert run(["measure", "plane", str(scanned), *part]) == 0
    assert (scanned / "measure" / "other.json").exists()


def test_an_acceptance_test_says_with_what_and_how_fast_it_was_scanned(scanned, tmp_path):
    (tmp_path / "plate.toml").write_text(
        f'format = 1\nname = "P"\n[[plate]]\nname = "P"\nnear_m = [{middle(scanned)}]\n'
        "within_mm = 900",
        "utf-8",
    )
    assert run(["accept", str(scanned), "--test", str(tmp_path / "plate.toml")]) == 0
    told = json.loads((scanned / "accept" / "accept.json").read_text("utf-8"))["scanned"]
    assert set(told) == {"recording", "rig", "water", "speed", "scanned"}
    assert "rig.toml" in told["rig"]
    assert "mm" in told["speed"]


def test_a_section_is_drawn_in_every_format(scanned):
    arguments = ("--point-m", middle(scanned), "--normal", "0,1,0", "--formats", "svg,csv,dxf")
    assert measure(scanned, "section", *arguments) == 0
    folder = scanned / "measure"
    assert (folder / "section.svg").read_text("utf-8").startswith("<svg")
    rows = (folder / "section.csv").read_text("utf-8").splitlines()
    assert rows[0].startswith("line,x_mm,y_mm,sigma_mm")
    assert len(rows) - 1 == read(scanned, "section")["details"]["corners"]
    import ezdxf

    drawing = ezdxf.readfile(folder / "section.dxf")
    assert sum(len(line) for line in drawing.modelspace()) == len(rows) - 1


def test_a_scan_beside_its_own_surface_shifted_by_a_millimetre_deviates_by_it(scanned, tmp_path):
    surface = load_mesh(scanned / "mesh" / "mesh.ply")
    behind = surface.vertices + np.array([0.0, 0.0, 1e-3])
    save_mesh(tmp_path / "behind.ply", Mesh(behind, surface.faces))
    reference = ("--reference", str(tmp_path / "behind.ply"), "--as-given")
    assert measure(scanned, "deviation", *reference) == 0
    mean = read(scanned, "deviation")["quantities"]["mean_m"]["value"]
    assert 0.3e-3 < mean < 1.05e-3  # the shift is along z, the distance across a sloping hull
    made = {file.name for file in (scanned / "measure").glob("deviation*")}
    assert made == {
        "deviation.json", "deviation.ply", "deviation.csv", "deviation-front.png",
        "deviation-isometric.png", "deviation-histogram.png", "deviation.stage.json",
    }  # fmt: skip


def test_a_search_for_dents_says_what_it_could_have_found(scanned, capsys):
    part = ("--near-m", middle(scanned), "--within-mm", "40")
    assert measure(scanned, "dents", *part, "--largest-mm", "60") == 0
    assert "the scan scatters by" in capsys.readouterr().out
    assert read(scanned, "dents")["quantities"]["threshold_m"]["value"] > 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("volume",), "encloses no volume"),
        (("sphere", "--near-m", "9,9,9", "--within-mm", "5"), "holds 0 of"),
        (("sphere", "--near-m", "9,9,9"), "--within-mm together"),
        (("distance", "--from-m", "9,9,9", "--to-m", "0,0,0"), "within 10 mm"),
        (("distance", "--from-m", "nan,0,0", "--to-m", "0,0,0"), "not X,Y,Z"),
        (("section", "--point-m", "0,0,90", "--normal", "0,0,1"), "does not meet"),
        (("section", "--point-m", "0,0,1", "--normal", "0,0,0"), "no direction"),
        (("distance", "--from-m", "1e300,0,0", "--to-m", "0,0,0"), "no place on Earth"),
        (("section", "--point-m", "0,0,90", "--normal", "0,0,1e300"), "does not meet"),
        (("section", "--point-m", "0,0,90", "--normal", "0,0,1e-320"), "does not meet"),
        (("dents", "--largest-mm", "nan"), "--largest-mm must be above 0"),
        (("dents", "--largest-mm", "5"), "below --smallest-mm 20"),
        (("dents", "--least-depth-mm", "inf"), "--least-depth-mm must be"),
        (("deviation", "--reference", "here", "--as-given", "--reach-mm", "inf"), "--reach-mm"),
        (("plane", "--name", "../away"), "no name"),
        (("deviation", "--reference", "nowhere.ply"), "nowhere.ply"),
        (("colour",), "colour"),
    ],
)
def test_a_wrong_measure_is_one_sentence_and_leaves_nothing(scanned, capfd, arguments, says):
    def listing():
        return {file.name: file.stat().st_mtime_ns for file in (scanned / "measure").glob("*")}

    arguments = [str(scanned / "mesh/mesh.ply") if word == "here" else word for word in arguments]
    before = listing()
    assert measure(scanned, *arguments) == 2
    said = capfd.readouterr().err
    assert says in said
    assert "Traceback" not in said
    assert listing() == before


def keep(project, which, *, change=lambda cloud: cloud):
    """Take all points out of a scan's cloud but some, as the cloud stage takes outliers out."""
    parts = [project.load_cloud_part(part) for part in project.find_cloud_parts()]

    def save():
        for number, part in enumerate(parts):
            out = np.where(part.stays & which(part.cloud), 0, 1).astype(np.uint8)
            project.save_cloud_part(number, CloudPart(change(part.cloud), out, ("other",)))
        project.export_cloud(frames=False)

    stays = sum(int((part.stays & which(part.cloud)).sum()) for part in parts)
    finish(project, CLOUD, CloudResult(stays, outliers=0), make=save)


def is_first(cloud):
    """Tell which points are of the first frame."""
    return cloud.frame == cloud.frame.min()


def test_a_scan_without_points_is_refused(scanned, tmp_path):
    from murkscan.errors import NotEnoughData
    from murkscan.measure import measure_plane
    from murkscan.survey.measure import measure_points

    shutil.copytree(scanned, tmp_path / "empty")
    project = Project(tmp_path / "empty")
    keep(project, lambda cloud: np.zeros(len(cloud), bool))
    with pytest.raises(NotEnoughData, match="no points"):
        measure_points(project, measure_plane)


@pytest.mark.parametrize(
    "what",
    [
        ("area",),
        ("volume",),
        ("section", "--point-m", "0,0,1", "--normal", "0,0,1"),
        ("dents",),
        ("deviation", "--reference", "here", "--as-given"),
    ],
)
def test_a_scan_without_a_surface_says_so_and_why(scanned, tmp_path, capfd, what):
    shutil.copytree(scanned, tmp_path / "single")
    project = Project(tmp_path / "single")
    keep(project, is_first)
    assert run(["mesh", str(tmp_path / "single"), "--colour", "none"]) == 0
    here = str(scanned / "mesh/mesh.ply")
    assert measure(tmp_path / "single", *(here if word == "here" else word for word in what)) == 2
    said = " ".join(capfd.readouterr().err.split())
    assert "has no triangles: its cloud has no two neighbouring profiles" in said


def test_a_single_profile_has_no_dent_to_find(scanned, tmp_path):
    from murkscan.errors import EstimationError
    from murkscan.survey.deviation import search_dents

    shutil.copytree(scanned, tmp_path / "single")
    project = Project(tmp_path / "single")
    # As the cloud stage has a single profile: no neighbours, no normals.
    keep(project, is_first, change=lambda c: replace(c, normals=np.zeros_like(c.normals)))
    assert run(["mesh", str(tmp_path / "single"), "--colour", "none"]) == 0
    with pytest.raises(EstimationError):
        search_dents(project, smallest=0.02, largest=0.15)


def test_measurements_have_checksums_and_what_belonged_to_one_before_goes(scanned, capsys):
    at = middle(scanned)
    folder = scanned / "measure"
    cut = ("--point-m", at, "--normal", "0,1,0", "--name", "keel")
    assert measure(scanned, "section", *cut, "--formats", "dxf,csv") == 0
    (folder / "keel-notes.txt").write_text("mine")
    assert measure(scanned, "section", *cut, "--formats", "svg") == 0
    made = {file.name for file in folder.glob("keel*")}
    assert made == {"keel.json", "keel.svg", "keel.stage.json", "keel-notes.txt"}
    assert run(["check", str(scanned)]) == 0
    with (folder / "keel.svg").open("a") as file:
        file.write(" ")
    capsys.readouterr()
    assert run(["check", str(scanned)]) == 2
    assert "changed: measure/keel.svg" in capsys.readouterr().out
    assert measure(scanned, "section", *cut, "--formats", "svg") == 0
    assert run(["check", str(scanned)]) == 0
