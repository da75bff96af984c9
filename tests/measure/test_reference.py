"""Laying a drawing on a scan of a small part of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from murkscan import Degenerate, FormatError, InputError, Mesh, NotEnoughData, PointCloud
from murkscan.io.mesh_files import save_mesh
from murkscan.measure.reference import begin_at, lay_on
from murkscan.survey.deviation import load_reference
from murkscan.types.pose import Pose
from murkscan.ui.values import read_pose


def _blade(x, y):
    return 0.05 * np.sin(6 * x) * np.cos(5 * y) + 0.1 * x * y


def _sheet(surface, half, count) -> Mesh:
    x, y = (part.ravel() for part in np.meshgrid(*[np.linspace(-half, half, count)] * 2))
    first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    a, b, c, d = first, first + 1, first + count, first + count + 1
    faces = np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)])
    return Mesh(np.stack([x, y, surface(x, y)], axis=1), faces)


def _join(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


@pytest.fixture(scope="module")
def drawing(tmp_path_factory) -> Path:
    """A blade 12 mm thick, and far more of the ship than was scanned."""
    front, back = _sheet(_blade, 0.7, 141), _sheet(lambda x, y: _blade(x, y) + 0.012, 0.7, 141)
    back = replace(back, faces=back.faces[:, ::-1])
    hull = Mesh(np.array([[-90.0, -9, 3], [90, -9, 3], [0, 9, 4]]), np.array([[0, 1, 2]]))
    path = tmp_path_factory.mktemp("ship") / "ship.ply"
    save_mesh(path, _join(front, back, hull))
    return path


def _scan(shift: np.ndarray) -> PointCloud:
    """Scan the front, seen from below; the log is off by a shift [m]."""
    random = np.random.default_rng(0)
    x, y = (part.ravel() for part in np.meshgrid(*[np.linspace(-0.4, 0.4, 201)] * 2))
    z = _blade(x, y) + random.normal(0, 1e-4, len(x))
    slopes = [0.3 * np.cos(6 * x) * np.cos(5 * y) + 0.1 * y]
    slopes += [-0.25 * np.sin(6 * x) * np.sin(5 * y) + 0.1 * x]
    normals = np.stack([*slopes, -np.ones(len(x))], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    ones, count = np.ones(len(x), np.float32), np.arange(len(x))
    return PointCloud(
        np.stack([x, y, z], axis=1) + shift, normals.astype(np.float32), ones, ones, ones * 1e-4,
        ones * 1e-4, (count // 201).astype(np.int32), (count % 201).astype(np.int32),
        *np.zeros((2, len(x)), np.uint8),
    )  # fmt: skip


def test_a_drawing_of_thin_plates_is_laid_on_the_side_that_was_scanned(drawing):
    """Within a quarter of a millimetre where it was off by twenty: the drawing's triangles alone
    leave the curved blade by a tenth."""
    shift = np.array([0.012, -0.008, 0.014])
    reference = lay_on(load_reference(drawing), _scan(shift))
    assert reference.alignment is not None
    moved = reference.alignment.target_from_source.inverse()
    assert np.linalg.norm(moved @ np.zeros((1, 3)) - shift) < 2.5e-4
    assert reference.alignment.rms < 2e-4


def test_triangles_piled_up_in_one_place_are_refused(tmp_path):
    """Each of them would be the nearest to each point."""
    faces = "f " + "1 2 3 " * 1001 + "\n"
    (tmp_path / "pile.obj").write_text("v 0 0 1\nv 1 0 1\nv 0 1 1\n" + faces)
    with pytest.raises(FormatError, match=r"pile\.obj has [\d,]+ triangles in one place"):
        load_reference(tmp_path / "pile.obj")


def test_a_scan_is_in_metres_whatever_unit_is_asked_for(tmp_path):
    with pytest.raises(InputError, match="which is in metres; leave out the unit mm"):
        load_reference(tmp_path, unit="mm")


def test_a_drawing_elsewhere_is_refused(drawing):
    with pytest.raises(Degenerate, match="do not overlap"):
        lay_on(load_reference(drawing), _scan(np.array([0.0, 0.0, -30.0])))


@pytest.mark.parametrize("unit", ["mm", "in", "cm"])
def test_a_drawing_in_the_wrong_unit_is_refused_with_both_sizes_and_the_flag(tmp_path, unit):
    save_mesh(tmp_path / "blade.ply", _sheet(_blade, 0.5, 101))
    with pytest.raises(
        (Degenerate, NotEnoughData), match=r"blade\.ply .* the scan 1\.1\d m.*--unit"
    ):
        lay_on(load_reference(tmp_path / "blade.ply", unit=unit), _scan(np.zeros(3)))


def test_a_drawing_that_lies_elsewhere_and_turned_is_given_a_start(drawing):
    elsewhere = Pose.from_quaternion(np.array([[1.0, 0.0, 0.0, 1.0]]), np.array([6.0, 0.0, -2.0]))
    reference = load_reference(drawing)
    moved = begin_at(reference, elsewhere.inverse())
    with pytest.raises(Degenerate, match="--start"):
        lay_on(moved, _scan(np.zeros(3)))
    about = read_pose("--start", "6.004,0.003,-2.003,1,0,0,1")
    laid = lay_on(begin_at(moved, about), _scan(np.zeros(3)))
    # The blade; the hull's three corners are 90 m away.
    away = laid.mesh.vertices[:-3] - reference.mesh.vertices[:-3]
    assert np.abs(away).max() < 1e-3


@pytest.mark.parametrize("text", ["1,2", "1,2,3,0,0,0,0", "a,b,c", "1,2,3,4", "nan,0,0"])
def test_a_start_that_is_none_is_refused(text):
    with pytest.raises(InputError, match="QW"):
        read_pose("--start", text)
