"""Control points that markers give: seen in the pictures, placed where the line crossed them."""

import json
import os
import shutil

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.errors import NotEnoughData
from murkscan.measure import MarkerSight, MarkerView, place_marker
from murkscan.optics import project
from murkscan.types.trajectory import Trajectory

from ..marked_wall import scan_marked_wall
from ..scenes import air_rig

ORIGIN = np.array([432100.0, 5412345.0, -12.0])
TURN = Rotation.from_euler("xyz", [95, 3, 40], degrees=True).as_matrix()
HEAD = "name,easting_m,northing_m,height_m,sigma_mm,marker,x_m,y_m,z_m\n"


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    middles = [(-0.15, -0.04), (0.15, -0.04), (0.0, 0.05), (0.3, 0.05)]
    folder = tmp_path_factory.mktemp("marked")
    return scan_marked_wall(folder, middles, length=0.26, size=(240, 192))


def lay(wall, rows, *words):
    file = wall.out.parent / "control.csv"
    file.write_text(HEAD + "".join(f"{row}\n" for row in rows), "utf-8")
    crs = ("--crs", "EPSG:25832+7837")
    return run(["georeference", str(wall.out), "--control", str(file), *crs, *words])


def on_ground(points):
    from murkscan.io.grid import find_grid

    scale = find_grid("EPSG:25832+7837", ORIGIN).scale
    return ORIGIN + points @ TURN.T * [scale, scale, 1.0]


def rows_of(wall):
    places = on_ground(wall.markers).tolist()
    return [f"P{n},{','.join(map(str, place))},2,{n},,," for n, place in enumerate(places)]


def test_markers_tell_where_control_points_lie(wall, capsys):
    rows = rows_of(wall)
    # One of the points is picked on the page, beside the markers.
    rows[3] = rows[3].replace(",3,,,", f",,{','.join(map(str, wall.markers[3].tolist()))}")
    assert lay(wall, rows) == 0
    assert "Markers on the model" in capsys.readouterr().out
    told = json.loads((wall.out / "georeference/stage.json").read_text("utf-8"))["result"]
    assert [one["marker"] for one in told["markers"]] == [0, 1, 2]
    for one, truth in zip(told["markers"], wall.markers, strict=False):
        # A pixel is 3.2 mm; edges are found to a tenth of one.
        assert np.linalg.norm(np.array(one["place_m"]) - truth) < 3.5e-4
    assert told["points"][0]["sigma_m"] > 2e-3
    assert told["rms_m"] < 3.5e-4


@pytest.mark.parametrize(
    ("row", "words", "said"),
    [
        ("P9,1,2,3,2,9,,,", (), "Marker 9 of 4X4_50 is in none of the"),
        ("P9,1,2,3,2,nine,,,", (), "'nine' for marker in line 6"),
        ("P9,1,2,3,2,,,,", (), "'' for x_m in line 6"),
        ("P9,1,2,3,2,9,,,", ("--markers", "4X4"), "no dictionary of markers '4X4'"),
    ],
)
def test_what_is_no_marker_is_one_sentence(wall, capsys, row, words, said):
    assert lay(wall, [*rows_of(wall), row], *words) == 2
    assert said in capsys.readouterr().err.splitlines()[-1]


def test_another_recording_is_refused(wall, capsys):
    other = shutil.copytree(wall.out.parent / "film/frames", wall.out.parent / "other")
    os.utime(other / "000003.png", (1e9, 1e9))
    assert lay(wall, rows_of(wall), "--recording", str(other)) == 2
    assert "is not the recording that was scanned" in capsys.readouterr().err


def sight(random, noise):
    """Views of a marker of 90 mm, 0.6 m ahead, from a camera that goes by; corners are noisy."""
    rig, times = air_rig(), np.arange(40) / 10
    way = Trajectory(
        times, np.stack([0 * times, 0.1 * times - 0.2, 0 * times], axis=1),
        np.tile([1.0, 0, 0, 0], (40, 1)),
    )  # fmt: skip
    square = 0.045 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) + [0, 0, 0.6]
    true = project(rig.camera, way.to_camera(np.tile(square, (40, 1)), np.repeat(times, 4)))
    seen = true.reshape(40, 4, 2) + noise * random.standard_normal((40, 4, 2))
    views = [MarkerView(k, t, seen[k]) for k, t in enumerate(times.tolist())]
    return MarkerSight(tuple(views), way, rig)


def crossing(random, noise):
    """What the line leaves on it: profiles of five frames, each off as a whole."""
    frame, number = (grid.ravel() for grid in np.mgrid[18:23, -10:11])
    z = 0.6 + noise * random.standard_normal(23)[frame]
    return np.stack([0.004 * number, 0.01 * (frame - 20), z], axis=1), frame


def test_a_place_states_how_far_it_is_off():
    random, ratios = np.random.default_rng(0), []
    for _ in range(60):
        found = place_marker(sight(random, 0.3), *crossing(random, 5e-5))
        ratios.append((found.place - [0, 0, 0.6]) / found.sigma)
    # 180 numbers, not all of one size: their root mean square is known to a tenth.
    assert 0.7 < np.sqrt(np.mean(np.square(ratios))) < 1.4


def test_a_marker_that_the_line_has_hardly_crossed_is_not_placed():
    random = np.random.default_rng(0)
    points, frames = crossing(random, 0.0)
    with pytest.raises(NotEnoughData, match="5 points"):
        place_marker(sight(random, 0.1), points[:5], frames[:5])
