"""What every triangulation promises, and what the paper's equation (4) gives."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.optics import project
from murkscan.triangulate import BaselineAngle, RaySheet, triangulate
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.rig import Rig
from murkscan.types.stripe import Stripe

METHODS = [RaySheet(), BaselineAngle()]
CAMERA = Camera(
    (720, 576), (554.0, 556.0), (359.5, 287.5), np.array([-0.2, 0.05, 1e-3, -1e-3, 0.01])
)


def _rig(axis, side=1.0, camera=CAMERA):
    angle = math.radians(65)
    laser = Laser.from_baseline_angle(0.2 * side, angle if side > 0 else math.pi - angle, axis)
    return Rig(camera, (laser,))


def _stripe(pixels, sigma=0.1):
    n = len(pixels)
    one = np.ones(n, np.float32)
    number = np.zeros(n, np.uint8)
    return Stripe(
        frame=np.arange(n, dtype=np.uint32),
        time=np.arange(n) / 25,
        pixels=pixels,
        sigma=(sigma * one).astype(np.float32),
        signal=one,
        posterior=one,
        laser=number,
        branch=number,
    )


@pytest.mark.parametrize("method", METHODS, ids=repr)
@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_points_of_the_sheet_come_back_from_their_pixels(method, axis, side):
    rig = _rig(axis, side)
    sheet = rig.lasers[0].sheet
    depth, across = np.meshgrid(np.linspace(0.3, 0.8, 9), np.linspace(-0.1, 0.1, 5))
    along = -(sheet.distance + depth * sheet.normal[2]) / sheet.normal["xy".index(axis)]
    points = np.stack(
        [along, across, depth] if axis == "x" else [across, along, depth], axis=-1
    ).reshape(-1, 3)
    found = method.locate(project(rig.camera, points), rig, 0)
    # The lens is inverted to rounding; a range of 1 m leaves some 1e-13 m of it.
    np.testing.assert_allclose(found, points, atol=1e-11)


@given(
    st.lists(st.tuples(st.floats(0, 719), st.floats(0, 575)), min_size=1, max_size=20),
    st.sampled_from(["x", "y"]),
    st.sampled_from([1.0, -1.0]),
)
def test_equation_4_and_ray_sheet_agree(pixels, axis, side):
    rig = _rig(axis, side)
    first, second = (method.locate(np.array(pixels), rig, 0) for method in METHODS)
    np.testing.assert_array_equal(np.isnan(first), np.isnan(second))
    near = np.nan_to_num(np.linalg.norm(first, axis=1), nan=np.inf) < 10  # beyond is no scan
    np.testing.assert_allclose(first[near], second[near], rtol=0, atol=1e-9)


def test_equation_4_by_hand():
    """f = 500 px, b = 100 mm, θ = 45°, x = -250 px: Z = 100 / (1 + 0.5) mm, X = -Z / 2."""
    rig = Rig(
        Camera((1001, 1001), (500.0, 500.0), (500.0, 500.0)),
        (Laser.from_baseline_angle(0.1, math.pi / 4, "x"),),
    )
    depth = 0.1 / 1.5
    for method in METHODS:
        found = method.locate(np.array([[250.0, 600.0]]), rig, 0)
        np.testing.assert_allclose(found, [[-depth / 2, depth / 5, depth]], atol=1e-12)


def test_a_nearer_surface_moves_the_stripe_towards_minus_x():
    depth = RaySheet().locate(np.array([[300.0, 288.0], [310.0, 288.0]]), _rig("x"), 0)[:, 2]
    assert depth[0] < depth[1]


@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_rays_that_miss_the_sheet_give_no_point(method):
    """Beyond cot θ the ray runs away from the sheet: nothing in front of the camera."""
    rig = _rig("x", camera=Camera((720, 576), (554.0, 554.0), (359.5, 287.5)))
    away = np.array([[359.5 + 554 * (1 / math.tan(math.radians(65)) + 0.05), 100.0], [300, 100]])
    assert np.isnan(method.locate(away, rig, 0)[0]).all()
    profile = triangulate(_stripe(away), rig, method)
    np.testing.assert_array_equal(profile.frame, [1])


@pytest.mark.parametrize("method", METHODS, ids=repr)
def test_no_stripe_gives_no_points(method):
    assert len(triangulate(_stripe(np.zeros((0, 2))), _rig("x"), method)) == 0


def test_sigma_is_what_scattered_centres_show():
    """The stated range deviation against 20 000 draws; 1.5 % is three deviations of that figure."""
    rig, sigma = _rig("x"), 0.2
    centre = np.array([[300.0, 200.0]])
    stated = triangulate(_stripe(centre, sigma), rig, RaySheet()).sigma[0]
    shifts = np.random.default_rng(1).normal(0, sigma, 20_000)
    pixels = centre + np.stack([shifts, np.zeros_like(shifts)], axis=1)
    ranges = np.linalg.norm(RaySheet().locate(pixels, rig, 0), axis=1)
    assert stated == pytest.approx(ranges.std(), rel=0.015)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_what_a_finder_has_put_back_is_told_with_its_sign(axis, side):
    rig, centres = _rig(axis, side), np.array([[300.0, 250.0], [380.0, 240.0]])
    way, found = np.eye(2)["xy".index(axis)], _stripe(centres)
    shift = np.array([0.2, -0.1], np.float32)
    profile = triangulate(replace(found, blur_shift=shift), rig, RaySheet())
    before = triangulate(replace(found, pixels=centres + shift[:, None] * way), rig, RaySheet())
    away = (np.linalg.norm(one.points, axis=1) for one in (before, profile))
    # To first order in a shift of 0.2 px.
    np.testing.assert_allclose(profile.blur_shift, np.subtract(*away), rtol=2e-3)


def test_equation_4_refuses_a_sheet_that_is_turned():
    rig = Rig(CAMERA, (Laser.from_sheet(Plane(np.array([0.8, 0.1, 0.6]), 0.1)),))
    with pytest.raises(InputError, match="--method ray-sheet"):
        BaselineAngle().locate(np.array([[300.0, 200.0]]), rig, 0)
