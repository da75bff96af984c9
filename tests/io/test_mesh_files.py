import numpy as np
import pytest
import trimesh

from murkscan.errors import FormatError, InputError
from murkscan.io.mesh_files import load_mesh, save_mesh
from murkscan.types.mesh import Mesh


def pyramid():
    """Its tip points at the camera (- z), 2 m right of, 3 m below and 4 m before it."""
    corners = np.array([[0, 0, 1], [0, 2, 1], [1, 2, 1], [1, 0, 1], [0.5, 1, 0]])
    return Mesh(
        corners + np.array([2.0, 3.0, 4.0]), np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    )


def signed_volume(mesh):
    """Of the cones from the mesh's middle: negative where it is wound the other way round."""
    a, b, c = (mesh.vertices[corner] - mesh.vertices.mean(axis=0) for corner in mesh.faces.T)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize("suffix", [".ply", ".stl", ".glb"])
def test_a_mesh_comes_back_as_it_was(tmp_path, suffix):
    mesh = pyramid()
    save_mesh(tmp_path / f"mesh{suffix}", mesh)
    back = load_mesh(tmp_path / f"mesh{suffix}")
    assert (len(back.vertices), len(back.faces)) == (5, 4)
    # STL and GLB keep single precision: 4 m to 2e-7 of it.
    tolerance = 0.0 if suffix == ".ply" else 1e-6
    ours, theirs = (np.unique(m.vertices.round(5), axis=0) for m in (mesh, back))
    np.testing.assert_allclose(theirs, ours, atol=tolerance)
    assert signed_volume(back) == pytest.approx(signed_volume(mesh), rel=1e-5)


def test_a_ply_keeps_the_last_digit_of_a_position_at_sea(tmp_path):
    mesh = Mesh(pyramid().vertices + np.array([512345.678901, 4.9e6, 0.0]), pyramid().faces)
    save_mesh(tmp_path / "mesh.ply", mesh)
    np.testing.assert_array_equal(load_mesh(tmp_path / "mesh.ply").vertices, mesh.vertices)


def test_a_glb_stands_upright_and_faces_the_viewer(tmp_path):
    save_mesh(tmp_path / "mesh.glb", pyramid())
    seen = trimesh.load_mesh(tmp_path / "mesh.glb")
    tip = seen.vertices[np.argmax(seen.vertices[:, 2])]
    # Right stays right, our down is its negative up, our near is its near.
    np.testing.assert_allclose(tip, [2.5, -4.0, -4.0], atol=1e-6)


@pytest.mark.parametrize("suffix", [".ply", ".stl", ".glb"])
@pytest.mark.parametrize("keep", [0, 10, 100, -5])
def test_a_damaged_file_is_refused_with_its_name(tmp_path, suffix, keep):
    path = tmp_path / f"mesh{suffix}"
    save_mesh(path, pyramid())
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(FormatError, match=f"mesh{suffix}"):
        load_mesh(path)


def test_another_format_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"mesh\.docx is no mesh format"):
        save_mesh(tmp_path / "mesh.docx", pyramid())


def test_a_mesh_without_triangles_is_not_written(tmp_path):
    with pytest.raises(InputError, match="no triangles"):
        save_mesh(tmp_path / "mesh.stl", Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)))
    assert list(tmp_path.iterdir()) == []
