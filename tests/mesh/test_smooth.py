"""The grid mesh evens out noise, and nothing that noise does not explain."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.mesh import GridMesh

from ..scans import cylinder, plane, scan_cloud, sphere, step

NOISE = 2e-4


def depth_errors(mesh, surface):
    off = mesh.vertices[:, 2] - surface(mesh.vertices[:, 0], mesh.vertices[:, 1])
    inner = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1]) < 0.025
    return off[inner]


@pytest.mark.parametrize("surface", [plane, sphere, cylinder])
@pytest.mark.parametrize("interlaced", [False, True])
def test_white_noise_falls_to_less_than_half(surface, interlaced):
    cloud = scan_cloud(surface, noise=NOISE, interlaced=interlaced)
    rough = depth_errors(GridMesh(smoothing=0.0).mesh(cloud), surface)
    fine = depth_errors(GridMesh().mesh(cloud), surface)
    # A parabola through 49 points has 3 / (2 sqrt(49)) = 0.21 of their noise in its middle, one
    # through 17 0.36: together 0.08. The third of the points that are more than a sigma off may
    # only come nearer by one: that leaves sqrt(2 (2 (1 - Phi(1)) - phi(1))) = 0.39.
    assert np.std(fine) < 0.45 * np.std(rough)
    # Of a circle a parabola misses 3/35 L^4 / 8 R^3 in its middle, 0.07 mm for L = 30 mm (24 rows
    # of a field) and R = 50 mm, if the chain is not cut before: well below the noise in any case.
    assert abs(np.mean(fine) - np.mean(rough)) < 0.25 * NOISE


@given(smoothing=st.floats(0.0, 1.0), noise=st.floats(1e-5, 1e-3))
@settings(max_examples=15, deadline=None)
def test_no_vertex_moves_farther_than_it_may(smoothing, noise):
    cloud = scan_cloud(step, spacing=4e-3, noise=noise, num_rows=60)
    cloud.sigma[::3] *= 0.1
    before = GridMesh(smoothing=0.0).mesh(cloud)
    after = GridMesh(smoothing=smoothing).mesh(cloud)
    np.testing.assert_array_equal(before.faces, after.faces)
    # Every point of this scan that has a neighbour is a vertex, in the cloud's order.
    moved = np.linalg.norm(after.vertices - before.vertices, axis=1)
    sigma = np.full(len(moved), noise)
    if len(moved) == len(cloud):
        sigma = cloud.sigma.astype(float)
    # Normals are unit to single precision.
    assert (moved <= smoothing * sigma * (1 + 1e-6) + 1e-12).all()


def test_points_that_state_no_sigma_stay():
    cloud = scan_cloud(sphere, noise=NOISE)
    cloud = replace(cloud, sigma=np.zeros_like(cloud.sigma))
    np.testing.assert_array_equal(
        GridMesh().mesh(cloud).vertices, GridMesh(smoothing=0.0).mesh(cloud).vertices
    )


def test_points_without_a_normal_stay_and_spoil_no_neighbour():
    cloud = scan_cloud(plane, noise=NOISE)
    cloud.normals[::7] = 0
    mesh = GridMesh().mesh(cloud)
    np.testing.assert_array_equal(mesh.vertices[::7], cloud.points[::7])
    assert np.isfinite(mesh.vertices).all()


@pytest.mark.parametrize("unknown", [np.nan, np.inf, -1.0])
def test_normals_and_deviations_that_are_no_numbers_move_nothing(unknown):
    cloud = scan_cloud(plane, noise=NOISE)
    cloud.normals[:100] = unknown if unknown != -1.0 else 0.0
    cloud.sigma[2000:2100] = unknown
    mesh = GridMesh().mesh(cloud)
    assert np.isfinite(mesh.vertices).all()
    for still in (slice(100), slice(2000, 2100)):
        np.testing.assert_array_equal(mesh.vertices[still], cloud.points[still])


def test_smoothing_never_reaches_over_a_depth_jump():
    near, far = GridMesh().mesh(scan_cloud(step, noise=NOISE)).vertices, 0.5
    off = np.minimum(np.abs(near[:, 2] - far), np.abs(near[:, 2] - 0.47))
    # Five standard deviations of 24 000 points; a mean over the jump of 30 mm would be millimetres.
    assert off.max() < 5 * NOISE


def test_a_ridge_much_higher_than_sigma_stays():
    def ridged(x, y):
        return 0.5 - 3e-3 * (np.abs(y) < 2e-3) + 0 * x

    cloud = scan_cloud(ridged, noise=1e-4)
    fine, rough = GridMesh().mesh(cloud), GridMesh(smoothing=0.0).mesh(cloud)
    top = fine.vertices[np.abs(fine.vertices[:, 1]) < 1e-3, 2]
    before = rough.vertices[np.abs(rough.vertices[:, 1]) < 1e-3, 2]
    # The height of a ridge seven points wide is not worn away by a tenth of a sigma.
    assert abs(np.mean(top) - np.mean(before)) < 1e-5
    assert np.mean(top) == pytest.approx(0.497, abs=2e-5)


def test_smoothing_beyond_sigma_is_refused():
    with pytest.raises(InputError, match="smoothing must lie from 0 to 1"):
        GridMesh(smoothing=1.5)
