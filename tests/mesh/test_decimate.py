from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.mesh import ByDepth, BySignal, GridMesh, close_holes, decimate
from murkscan.types.mesh import Mesh

from ..scans import holed, plane, scan_cloud, sphere


def test_a_ball_keeps_its_shape_with_a_tenth_of_its_triangles():
    mesh = GridMesh().mesh(scan_cloud(sphere))
    fewer = decimate(mesh, faces=len(mesh.faces) // 10)
    assert len(fewer.faces) == pytest.approx(len(mesh.faces) / 10, rel=0.02)
    np.testing.assert_array_equal(np.unique(fewer.faces), np.arange(len(fewer.vertices)))
    middle = fewer.vertices[fewer.faces].mean(axis=1)
    inner = np.hypot(middle[:, 0], middle[:, 1]) < 0.03
    off = np.linalg.norm(middle[inner] - [0, 0, 0.5], axis=1) - 0.05
    # Sides of 3.5 mm, up to 11 mm: on a radius of 50 mm these sink by 11²/(8·50) = 0.3 mm, those by
    # 0.03 mm.
    assert np.abs(off).max() < 3e-4
    assert np.sqrt(np.mean(off**2)) < 5e-5


def test_a_mesh_with_few_triangles_is_given_back():
    mesh = GridMesh().mesh(scan_cloud(plane, spacing=0.01, num_rows=20))
    assert decimate(mesh, faces=10**6) is mesh


def test_a_place_at_sea_loses_no_digits():
    mesh = GridMesh().mesh(scan_cloud(sphere, spacing=2e-3))
    there = Mesh(mesh.vertices + np.array([512345.0, 4.9e6, 0.0]), mesh.faces)
    here = decimate(mesh, faces=500)
    moved = decimate(there, faces=500)
    # Numbers of 5e6 have steps of 1e-9; which sides fall first may hang on the last of them.
    assert len(moved.faces) == pytest.approx(len(here.faces), abs=10)
    lows = moved.vertices.min(axis=0) - [512345.0, 4.9e6, 0.0]
    np.testing.assert_allclose(lows, here.vertices.min(axis=0), atol=1e-3)


def test_the_mark_of_closed_holes_survives():
    mesh = close_holes(GridMesh().mesh(scan_cloud(holed, spacing=2e-3)), largest=0.05).mesh
    fewer = decimate(mesh, faces=2000)
    middle = fewer.vertices[fewer.faces].mean(axis=1)
    radius = np.hypot(middle[:, 0], middle[:, 1])
    assert fewer.filled[radius < 0.01].all()
    assert not fewer.filled[radius > 0.03].any()


@pytest.mark.parametrize("faces", [3, 0, -1])
def test_too_few_triangles_are_refused(faces):
    with pytest.raises(InputError, match="at least 4"):
        decimate(GridMesh().mesh(scan_cloud(plane, spacing=0.01)), faces=faces)


def test_depth_is_brightest_where_it_is_near():
    cloud = scan_cloud(sphere, spacing=2e-3)
    mesh = GridMesh().mesh(cloud)
    colours = ByDepth().paint(mesh, cloud.signal)
    assert colours.shape == mesh.vertices.shape
    near, far = mesh.vertices[:, 2].argmin(), mesh.vertices[:, 2].argmax()
    assert colours[near].sum() > colours[far].sum() + 200


def test_signal_is_that_of_the_vertex_point():
    cloud = scan_cloud(plane, spacing=2e-3)
    cloud.signal[:] = np.where(cloud.points[:, 1] > 0, 200, 50)
    mesh = GridMesh().mesh(cloud)
    colours = BySignal().paint(mesh, cloud.signal)
    bright = mesh.vertices[:, 1] > 0
    assert len(np.unique(colours[bright], axis=0)) == len(np.unique(colours[~bright], axis=0)) == 1
    assert colours[bright][0].sum() > colours[~bright][0].sum() + 200


def test_values_without_a_range_have_one_colour():
    cloud = scan_cloud(plane, spacing=0.01)
    assert len(np.unique(BySignal().paint(GridMesh().mesh(cloud), cloud.signal), axis=0)) == 1


def test_a_vertex_keeps_its_point_through_every_step():
    cloud = scan_cloud(holed, spacing=2e-3)
    mesh = GridMesh(smoothing=0.0).mesh(cloud)
    np.testing.assert_array_equal(mesh.vertices, cloud.points[mesh.points])
    fewer = decimate(close_holes(mesh, largest=0.05).mesh, faces=1000)
    # Some hundred vertices of a wall of 120 mm: each stands for one that it was joined from.
    away = np.linalg.norm(fewer.vertices - cloud.points[fewer.points], axis=1)
    assert np.median(away) < 3e-3
    assert away.max() < 0.02
    with pytest.raises(InputError, match="which points its vertices are"):
        BySignal().paint(replace(mesh, points=None), cloud.signal)
