"""A scan laid on control points, as the command does it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.cloud import merge_profiles
from murkscan.io.cloud_files import load_cloud_file
from murkscan.project import CLOUD, CloudResult, Project, load_georeference

from ..projects import SCAN, finish, save_cloud
from ..scans import plane, scan

ORIGIN = np.array([432100.0, 5412345.0, -12.0])
TURN = Rotation.from_euler("xyz", [95, 3, 40], degrees=True).as_matrix()
ON_MODEL = np.array(
    [[0.0, 0.0, 0.5], [2.0, 0.1, 0.6], [1.9, 1.5, 0.4], [0.1, 1.4, 0.7], [1.0, 0.8, 1.2]]
)
HEAD = "name,easting_m,northing_m,height_m,sigma_mm,x_m,y_m,z_m\n"


def on_ground(points, scale):
    return ORIGIN + points @ TURN.T * [scale, scale, 1.0]


def table(places, points=ON_MODEL, sigma=2):
    rows = zip(places, points, strict=True)
    lines = [
        ",".join(map(repr, [f"P{n}", *place.tolist(), sigma, *point.tolist()])).replace("'", "")
        for n, (place, point) in enumerate(rows)
    ]
    return HEAD + "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    profile, trajectory = scan(plane, spacing=8e-3)
    cloud = merge_profiles(profile, trajectory, axes=("x",))
    project = Project(tmp_path_factory.mktemp("placed") / "out")
    project.save_scan(SCAN)
    finish(project, CLOUD, CloudResult(len(cloud), 0), make=lambda: save_cloud(project, cloud))
    return project


def lay(project, text, crs="EPSG:25832+7837"):
    file = project.root.parent / "control.csv"
    file.write_text(text, "utf-8")
    return run(["georeference", str(project.root), "--control", str(file), "--crs", crs])


def scale():
    from murkscan.io.grid import find_grid

    return find_grid("EPSG:25832+7837", ORIGIN).scale


def test_what_is_exported_lies_in_the_grid_and_names_it(scanned, tmp_path, capsys):
    laspy, pye57 = pytest.importorskip("laspy"), pytest.importorskip("pye57")
    from murkscan.survey.export import export_cloud

    assert lay(scanned, table(on_ground(ON_MODEL, scale()))) == 0
    assert "EPSG:25832+7837 (ETRS89 / UTM zone 32N + DHHN2016 height)" in capsys.readouterr().out
    cloud, place = scanned.load_cloud(), load_georeference(scanned)
    assert place.scale == pytest.approx(0.99966, abs=1e-5)  # 68 km from the zone's middle
    for suffix in ("laz", "e57", "ply", "csv"):
        export_cloud(scanned, tmp_path / f"cloud.{suffix}")
        placed = load_cloud_file(tmp_path / f"cloud.{suffix}")
        # LAZ counts in steps of 0.01 mm.
        away = placed.points - on_ground(cloud.points, scale())
        assert np.abs(away).max() < 2e-5
        back = place.place_back(placed.points)
        assert np.abs(back - cloud.points).max() < 1e-4
        assert (placed.sigma_common > 5e-4).all()
    with laspy.open(tmp_path / "cloud.laz") as file:
        assert file.header.parse_crs().to_epsg() is None  # a compound one without a number
        assert file.header.parse_crs().name.startswith("ETRS89 / UTM zone 32N")
        assert file.header.global_encoding.wkt
    with pye57.E57(str(tmp_path / "cloud.e57")) as file:
        assert file.root["coordinateMetadata"].value().startswith("COMPD_CS[")


def test_a_cloud_made_anew_has_to_be_laid_again(scanned):
    assert lay(scanned, table(on_ground(ON_MODEL, scale()))) == 0
    file = scanned.root / "georeference/stage.json"
    text = file.read_text("utf-8")
    file.write_text(text.replace(scanned.finished(CLOUD).digest, "0" * 16), "utf-8")
    from murkscan.errors import MissingResult

    with pytest.raises(MissingResult, match="earlier cloud"):
        load_georeference(scanned)
    file.write_text(text, "utf-8")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda p: (p[:2], ON_MODEL[:2]), "3 points or more"),
        (lambda p: (p[[0, 0, 0]] + np.arange(3)[:, None], np.ones((3, 1)) * [0, 0, 1.0]
                    + np.arange(3)[:, None]), "on a line"),
        (lambda p: (p, 1e3 * ON_MODEL), "not in metres"),
        (lambda p: (p, 1.2 * ON_MODEL), "times as far apart"),
        (lambda p: (p[[1, 2, 3, 4, 0]], ON_MODEL), "check which place on the model"),
    ],
)  # fmt: skip
def test_points_that_determine_nothing_are_one_sentence(scanned, capsys, change, words):
    assert lay(scanned, table(*change(on_ground(ON_MODEL, scale())))) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "crs", "words"),
    [
        (table(ORIGIN + ON_MODEL), "EPSG:99999", "no coordinate system"),
        (table(ORIGIN + ON_MODEL), "EPSG:4326", "no plane in metres"),
        (table((ORIGIN + ON_MODEL)[:, [1, 0, 2]]), "EPSG:25832", "exchange the two columns"),
        (table(ORIGIN + ON_MODEL, sigma=3000), "EPSG:25832", "another unit"),
        (table(ORIGIN + ON_MODEL).replace("sigma_mm", "sigma"), "EPSG:25832", "unit must be said"),
        (table(ORIGIN + ON_MODEL).replace(",-11.5,", ",deep,"), "EPSG:25832", "line 2"),
        (table(ORIGIN + ON_MODEL, sigma=0), "EPSG:25832", "not above 0"),
    ],
)
def test_a_table_or_a_system_that_is_none_is_one_sentence(scanned, capsys, text, crs, words):
    assert lay(scanned, text, crs) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
