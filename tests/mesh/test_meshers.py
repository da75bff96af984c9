"""What every mesher promises; a new one joins the list and inherits the tests."""

import importlib.util
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from murkscan.errors import Degenerate, InputError, MissingDependency
from murkscan.mesh import GridMesh, Poisson, join_tiles

from ..scans import cylinder, holed, plane, scan_cloud, sphere, step

HAS_OPEN3D = importlib.util.find_spec("open3d") is not None
WITH_OPEN3D = pytest.mark.skipif(not HAS_OPEN3D, reason='the extra "murkscan[mesh]" is absent')
MESHERS = [
    pytest.param(GridMesh(), id="grid"),
    pytest.param(Poisson(), id="poisson", marks=WITH_OPEN3D),
]


def corners(mesh):
    return (mesh.vertices[corner] for corner in mesh.faces.T)


def face_normals(mesh):
    a, b, c = corners(mesh)
    return np.cross(b - a, c - a)


def edges(mesh):
    pairs = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)])
    return np.unique(np.sort(pairs, axis=1), axis=0, return_counts=True)


@pytest.mark.parametrize("mesher", MESHERS)
@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize("surface", [plane, sphere, cylinder])
def test_the_mesh_lies_on_the_surface_and_faces_the_camera(mesher, surface, interlaced):
    mesh = mesher.mesh(scan_cloud(surface, interlaced=interlaced))
    middle = sum(corners(mesh)) / 3
    # Within 0.1 m of the steep rim a chord of 1 mm on a radius of 40 mm sinks by 1²/(8·40) mm; the
    # octree of depth 7 has cells of 1 mm and its surface errs by a part of that.
    off = middle[:, 2] - surface(middle[:, 0], middle[:, 1])
    inner = np.hypot(middle[:, 0], middle[:, 1]) < 0.03
    assert np.percentile(np.abs(off[inner]), 99) < (2e-5 if mesher == GridMesh() else 2e-4)
    assert np.mean(face_normals(mesh)[inner, 2] < 0) > 0.999


@pytest.mark.parametrize("mesher", MESHERS)
def test_a_hole_stays_open(mesher):
    mesh = mesher.mesh(scan_cloud(holed))
    middle = sum(corners(mesh)) / 3
    # Poisson is trimmed two profiles' distance from the nearest point.
    reach = 0.0 if mesher == GridMesh() else 2.5e-3
    assert np.hypot(middle[:, 0], middle[:, 1]).min() > 0.02 - reach - 1e-3


@pytest.mark.parametrize("mesher", MESHERS)
def test_every_vertex_has_a_triangle_and_no_triangle_a_vertex_twice(mesher):
    mesh = mesher.mesh(scan_cloud(holed, spacing=2e-3, noise=2e-4))
    np.testing.assert_array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))
    assert (np.diff(np.sort(mesh.faces, axis=1), axis=1) > 0).all()


@pytest.mark.parametrize("mesher", MESHERS)
def test_the_same_cloud_gives_the_same_mesh(mesher):
    cloud = scan_cloud(sphere, spacing=2e-3, noise=2e-4)
    first, second = mesher.mesh(cloud), mesher.mesh(cloud)
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.faces, second.faces)


@pytest.mark.parametrize("mesher", MESHERS)
@pytest.mark.parametrize("frames", [0, 1])
def test_a_cloud_without_two_profiles_has_no_surface(mesher, frames):
    cloud = scan_cloud(plane)
    mesh = mesher.mesh(cloud[cloud.frame < frames])
    assert mesh.vertices.shape == (0, 3)
    assert mesh.faces.shape == (0, 3)


@pytest.mark.parametrize("mesher", MESHERS)
def test_a_point_that_is_not_finite_is_refused(mesher):
    cloud = scan_cloud(plane, spacing=0.01)
    cloud.points[3, 1] = np.inf
    with pytest.raises(InputError, match="1 of 2400 points are not finite"):
        mesher.mesh(cloud)


@pytest.mark.parametrize("interlaced", [False, True])
def test_the_grid_mesh_of_a_full_grid_is_two_triangles_a_cell(interlaced):
    cloud = scan_cloud(plane, interlaced=interlaced)
    mesh = GridMesh().mesh(cloud)
    lines = 100 if interlaced else 200
    np.testing.assert_array_equal(mesh.vertices, cloud.points)
    assert len(mesh.faces) == 2 * (lines - 1) * 119
    _, shared = edges(mesh)
    assert shared.max() == 2


def test_the_grid_mesh_is_cut_at_a_depth_jump():
    depths = GridMesh().mesh(scan_cloud(step)).vertices[:, 2]
    mesh = GridMesh().mesh(scan_cloud(step))
    assert np.ptp(depths) > 0.029
    assert np.ptp(mesh.vertices[mesh.faces][:, :, 2], axis=1).max() < 1e-9


def test_the_grid_mesh_reaches_over_the_jump_that_it_is_told_to():
    mesh = GridMesh(max_jump=0.04).mesh(scan_cloud(step))
    assert np.ptp(mesh.vertices[mesh.faces][:, :, 2], axis=1).max() == pytest.approx(0.03)


def test_the_grid_mesh_bridges_neither_a_missing_profile_nor_a_missing_scan_line():
    cloud = scan_cloud(plane)
    cloud = cloud[(cloud.frame != 60) & (cloud.scan_line != 90)]
    mesh = GridMesh().mesh(cloud)
    assert len(mesh.faces) == 2 * (59 + 58) * (89 + 108)


def test_a_missing_point_costs_half_of_each_cell_around_it():
    cloud = scan_cloud(plane)
    whole = GridMesh().mesh(cloud)
    mesh = GridMesh().mesh(cloud[~((cloud.frame == 60) & (cloud.scan_line == 90))])
    assert len(whole.faces) - len(mesh.faces) == 4
    _, shared = edges(mesh)
    assert shared.max() == 2


def test_two_branches_make_two_surfaces():
    cloud = scan_cloud(plane, spacing=2e-3)
    behind = replace(cloud, points=cloud.points + np.array([0.0, 0.0, 0.1]))
    names = cloud.__dataclass_fields__
    both = type(cloud)(*(np.concatenate([getattr(c, n) for c in (cloud, behind)]) for n in names))
    mesh = GridMesh().mesh(both)
    assert len(mesh.faces) == 2 * len(GridMesh().mesh(cloud).faces)
    assert np.ptp(mesh.vertices[mesh.faces][:, :, 2], axis=1).max() < 0.01


def test_noise_does_not_tear_the_grid_mesh():
    # Noise as large as the distance between scan lines still leaves 99 % of the triangles.
    whole = GridMesh().mesh(scan_cloud(plane))
    noisy = GridMesh().mesh(scan_cloud(plane, noise=6e-4))
    assert len(noisy.faces) > 0.99 * len(whole.faces)


def unnumbered(cloud, *, with_normals=True):
    """Give the cloud as it comes from another program's file."""
    zero = np.zeros_like(cloud.frame)
    normals = cloud.normals if with_normals else np.zeros_like(cloud.normals)
    return replace(cloud, frame=zero, scan_line=zero, sigma=0 * cloud.sigma, normals=normals)


def test_the_grid_mesh_of_points_without_a_grid_is_refused_with_the_cure():
    with pytest.raises(InputError, match="--mesher poisson"):
        GridMesh().mesh(unnumbered(scan_cloud(plane, spacing=2e-3)))


@WITH_OPEN3D
@pytest.mark.parametrize("with_normals", [True, False])
def test_poisson_makes_a_surface_of_points_without_a_grid(with_normals):
    cloud = scan_cloud(holed, spacing=2e-3, noise=1e-4)
    mesh = Poisson().mesh(unnumbered(cloud, with_normals=with_normals))
    middle = sum(corners(mesh)) / 3
    inner = np.abs(middle[:, :2]).max(axis=1) < 0.04
    # The noise is 0.1 mm, and cells of a millimetre hold one or two points.
    assert np.std(middle[inner, 2] - 0.5) < 1e-4
    assert np.mean(face_normals(mesh)[inner, 2] < 0) > 0.999
    # Trimmed beyond the disc of thirty points: 30 of 2 x 0.6 mm² each, 3.4 mm.
    assert np.hypot(middle[:, 0], middle[:, 1]).min() > 0.02 - 3.4e-3 - 1e-3


@WITH_OPEN3D
def test_the_depth_that_poisson_takes_is_no_worse_than_the_points():
    cloud = scan_cloud(sphere, noise=1e-4)
    mesh = Poisson().mesh(cloud)
    away = np.linalg.norm(mesh.vertices - np.array([0.0, 0.0, 0.5]), axis=1)
    inner = np.hypot(*mesh.vertices[:, :2].T) < 0.03
    assert np.sqrt(np.mean((away[inner] - 0.05) ** 2)) < 1e-4


@WITH_OPEN3D
@pytest.mark.parametrize("with_normals", [True, False])
def test_poisson_makes_no_surface_of_a_line(with_normals):
    cloud = unnumbered(scan_cloud(plane), with_normals=with_normals)
    share = np.linspace(0, 1, len(cloud))[:, None]
    # Coordinates in single precision, as many files have them, leave the line by 1e-7 of it.
    on_line = (share * [1.0, 2.0, 0.3]).astype(np.float32).astype(float)
    with pytest.raises(Degenerate, match="one line"):
        Poisson().mesh(replace(cloud, points=on_line))


@pytest.mark.parametrize("mesher", MESHERS)
def test_a_point_off_this_earth_is_refused(mesher):
    cloud = scan_cloud(plane)
    cloud.points[5, 0] = 1e300
    with pytest.raises(InputError, match="1e\\+300 m from its origin"):
        mesher.mesh(cloud)


def test_settings_without_sense_are_refused():
    with pytest.raises(InputError, match="max_jump"):
        GridMesh(max_jump=0.0)
    with pytest.raises(InputError, match="depth"):
        Poisson(depth=40)


@pytest.mark.skipif(HAS_OPEN3D, reason='the extra "murkscan[mesh]" is there')
def test_poisson_names_the_extra_that_it_needs():
    with pytest.raises(MissingDependency, match=r'pip install "murkscan\[mesh\]"'):
        Poisson().mesh(scan_cloud(plane, spacing=0.01))


def test_tiles_make_the_surface_that_the_whole_makes():
    """Each sees twelve profiles beside its own: points are evened out over eight.

    What is a jump is given: a tile tells it from its own points, which lie farther apart at the
    rim of the sphere.
    """
    cloud, mesher = scan_cloud(sphere, noise=1e-4), GridMesh(max_jump=0.01)
    whole = mesher.mesh(cloud)
    edges = np.searchsorted(cloud.frame, [0, 37, 80, 120])

    def tile(low, high):
        first = np.searchsorted(cloud.frame, cloud.frame[low] - 12)
        last = np.searchsorted(cloud.frame, cloud.frame[high - 1] + 13)
        return mesher.mesh_tile(cloud[first:last], slice(low - first, high - first))

    joined = join_tiles([tile(low, high) for low, high in pairwise(edges.tolist())])
    np.testing.assert_array_equal(joined.points, whole.points)
    np.testing.assert_allclose(joined.vertices, whole.vertices, atol=1e-12)
    corners = [np.unique(np.sort(mesh.faces, axis=1), axis=0) for mesh in (joined, whole)]
    np.testing.assert_array_equal(*corners)
