"""Several passes over one object make one surface."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.geometry.overlap import has_another_sheet
from murkscan.measure import Sample, measure_area, measure_volume
from murkscan.mesh import GridMesh, Poisson
from murkscan.types.cloud import PointCloud
from murkscan.types.mesh import Mesh
from murkscan.types.plane import Plane

from ..scans import cylinder, plane, scan_cloud
from .test_meshers import MESHERS, WITH_OPEN3D, unnumbered


def passes(surface, *, beside=0.06, off=2e-4):
    """Give a pass, and one that began elsewhere and lies a little behind it."""
    first = scan_cloud(lambda x, y: surface(x, y), noise=5e-5)
    other = scan_cloud(lambda x, y: surface(x + beside, y), noise=5e-5)
    frame = (other.frame + 1200).astype(np.int32)
    return [first, replace(other, points=other.points + np.array([beside, 0.0, off]), frame=frame)]


def area(mesh):
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def all_of(mesh):
    return np.arange(len(mesh.faces))


@pytest.mark.parametrize("mesher", MESHERS)
@pytest.mark.parametrize("surface", [plane, cylinder])
def test_where_passes_overlap_there_is_one_sheet(mesher, surface):
    both = passes(surface)
    mesh = mesher.mesh_passes(both)
    # The seam's triangles overlap by half of themselves.
    assert has_another_sheet(mesh, all_of(mesh)).mean() < 0.02
    one = mesher.mesh(both[0])
    assert area(mesh) > 1.2 * area(one)


@WITH_OPEN3D
@pytest.mark.parametrize("over", [False, True])
def test_poisson_joins_a_scan_and_the_points_of_another_program(over):
    first, other = passes(plane)
    other = replace(unnumbered(other, with_normals=False), frame=other.frame * 0 + 1200)
    both = [first, other]
    if over:
        # From the other side of the world, where the smallest z is the wall's back.
        turn = np.diag([1.0, -1.0, -1.0]).astype(np.float32)
        both = [replace(c, points=c.points @ turn, normals=c.normals @ turn) for c in both]
    mesher = Poisson(depth=6)
    mesh = mesher.mesh_passes(both)
    assert has_another_sheet(mesh, all_of(mesh)).mean() < 0.02
    # The second pass begins 60 mm after the first, of 119 mm, and the rims are uneven.
    assert area(mesh) > 1.4 * area(mesher.mesh(both[0]))
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    towards = np.cross(b - a, c - a)[:, 2]
    assert np.mean(towards > 0 if over else towards < 0) > 0.99


def test_the_grid_mesh_leaves_no_points_of_another_program_out_in_silence():
    first, other = passes(plane)
    with pytest.raises(InputError, match="--mesher poisson"):
        GridMesh().mesh(PointCloud.concatenate([first, unnumbered(other)]))


def test_the_area_of_two_passes_is_that_of_what_they_saw_together():
    both = passes(lambda x, y: 0.5 + 0 * x)
    mesh = GridMesh().mesh_passes(both)
    sample = Sample.from_cloud(PointCloud.concatenate(both))
    single = measure_area(GridMesh().mesh(both[0]), Sample.from_cloud(both[0])).quantities[0]
    together = measure_area(mesh, sample).quantities[0]
    # 120 profiles 1 mm apart cover 119 mm, and the second pass begins 60 mm later. At the seam half
    # a triangle of 1 mm may be there twice, or not at all.
    assert together.value == pytest.approx(179 / 119 * single.value, rel=0.5 / 179)


def test_the_first_pass_stays_as_it_is():
    first, other = passes(cylinder)
    joined, one = GridMesh().mesh_passes([first, other]), GridMesh().mesh(first)
    np.testing.assert_array_equal(joined.vertices[: len(one.vertices)], one.vertices)
    np.testing.assert_array_equal(joined.faces[: len(one.faces)], one.faces)


def test_a_second_surface_behind_the_first_stays():
    first, _ = passes(plane)
    behind = replace(first, points=first.points + np.array([0.0, 0.0, 0.02]))
    mesh = GridMesh().mesh_passes([first, behind])
    assert len(mesh.faces) == 2 * len(GridMesh().mesh(first).faces)


def test_the_other_side_of_a_plate_stays():
    first, _ = passes(plane)
    # Half a turn about y, and half a millimetre behind.
    turn = np.diag([-1.0, 1.0, -1.0])
    back = replace(
        first,
        points=(first.points - [0, 0, 0.5]) @ turn + [0, 0, 0.5],
        normals=(first.normals @ turn).astype(np.float32),
    )
    mesh = GridMesh().mesh_passes([first, back])
    assert len(mesh.faces) == 2 * len(GridMesh().mesh(first).faces)


def test_a_pass_without_points_or_surface_adds_nothing():
    first, _ = passes(plane)
    alone = first[first.frame == 0]
    one = GridMesh().mesh(first)
    for others in ([alone, first], [first, alone], [first]):
        assert len(GridMesh().mesh_passes(others).faces) == len(one.faces)
    assert len(GridMesh().mesh_passes([]).faces) == 0


def test_sheets_that_lie_on_one_another_are_not_measured():
    both = passes(plane)
    sample = Sample.from_cloud(PointCloud.concatenate(both))
    one, other = (GridMesh().mesh(single) for single in both)
    twice = Mesh(
        np.concatenate([one.vertices, other.vertices]),
        np.concatenate([one.faces, other.faces + len(one.vertices)]),
    )
    with pytest.raises(InputError, match="count twice"):
        measure_area(twice, sample)
    with pytest.raises(InputError, match="poisson"):
        measure_volume(twice, sample, Plane(np.array([0.0, 0.0, -1.0]), 0.6))
