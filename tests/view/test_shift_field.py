"""What a page keeps of a rig's errors, against the rig itself."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.io.rig_toml import load_rig
from murkscan.optics import parameters_of
from murkscan.optics.length import measure_length
from murkscan.optics.uncertainty import common_shifts
from murkscan.simulate import read_scene
from murkscan.types.rig_covariance import RigCovariance
from murkscan.view import fit_shift_field


@pytest.fixture(scope="module")
def rig():
    """A camera and a fan behind ports, all of whose numbers are uncertain."""
    _, _, folder = read_scene("demo")
    rig = load_rig(folder / "rigs/pal.toml")
    names = parameters_of(rig)
    sigma = [1.0 if name.startswith(("camera.focal", "camera.princ")) else 1e-3 for name in names]
    return replace(rig, covariance=RigCovariance(tuple(names), np.diag(np.square(sigma))))


def test_the_field_stretches_lengths_as_the_rig_does(rig):
    random = np.random.default_rng(0)
    pixels = random.uniform((150, 20), (570, 550), (1200, 2))
    shifts = common_shifts(pixels, rig)
    points = located(rig, pixels)
    seen = np.isfinite(shifts).all(axis=(1, 2)) & (points[:, 2] > 0.4) & (points[:, 2] < 1.2)
    points, shifts = points[seen], shifts[seen]
    assert len(points) > 300
    field = fit_shift_field(points[::2], shifts[::2])
    others = points[1::2]
    kept, true = field.at(others), shifts[1::2]
    half = len(others) // 2
    nothing = np.zeros((2, 3))
    for i, j in zip(range(half), range(half, 2 * half), strict=True):
        ends = others[[i, j]]
        fitted = measure_length(ends, nothing, kept[[i, j]]).sigma_common
        exact = measure_length(ends, nothing, true[[i, j]]).sigma_common
        # Two per cent of an uncertainty is far beyond what it is known to.
        assert fitted == pytest.approx(exact, rel=0.02, abs=1e-6)


def located(rig, pixels):
    from murkscan.optics import back_project, intersect_rays_with_sheet, refractive_index

    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels, index)
    return intersect_rays_with_sheet(rays, rig.lasers[0], index)
