"""A real scan: printed stairs of known height under a red line, in air."""

import math

import numpy as np
import pytest

import murkscan as ms
from murkscan.cloud import merge_profiles
from murkscan.geometry import fit_plane
from murkscan.motion import ConstantStep
from murkscan.triangulate import RaySheet, triangulate

CALIPER = np.array([4.69e-3, 9.63e-3, 14.55e-3])
STEPS = (((12, 24), (200, 350)), ((29, 41), (195, 355)), ((46, 59), (190, 360)))
"""Frames and image rows well inside each step."""
RIG = ms.Rig(
    ms.Camera((640, 480), (850.4, 850.4), (328.0, 239.5)),
    (ms.Laser.from_baseline_angle(0.0373, math.radians(65.0), "x"),),
    wavelength=650e-9,
)


@pytest.fixture(scope="module")
def frames(data):
    recording = ms.open_recording(data("stage_stairs") / "scan", wavelength=RIG.wavelength)
    return list(recording.frames())


@pytest.mark.parametrize(
    ("extractor", "flat"),
    [(finder, 0.12e-3) for finder in (ms.Murk(), ms.GrayGravity(), ms.GaussianFit(), ms.Steger())],
    ids=lambda value: type(value).__name__,
)
def test_steps_are_within_a_tenth_of_a_millimetre_of_the_caliper(frames, extractor, flat):
    """Bars of the project for gray gravity; the caliper itself reads to 0.01 mm."""
    background = extractor.learn(frames[::5], RIG)
    stripe = ms.Stripe.concatenate(list(extractor.extract(frames, RIG, background)))
    trajectory = ConstantStep(1e-3, "x").follow(np.arange(65.0), np.arange(65.0))
    cloud = merge_profiles(triangulate(stripe, RIG, RaySheet()), trajectory, axes=("x",))
    bed = fit_plane(cloud.points[(cloud.scan_line < 160) | (cloud.scan_line >= 400)]).plane
    heights = -np.sign(bed.normal[2]) * bed.distance_to(cloud.points)
    for truth, ((first, last), (low, high)) in zip(CALIPER, STEPS, strict=True):
        inside = (cloud.frame >= first) & (cloud.frame < last)
        step = heights[inside & (cloud.scan_line >= low) & (cloud.scan_line < high)]
        assert np.median(step) == pytest.approx(truth, abs=0.1e-3)
        assert 1.4826 * np.median(np.abs(step - np.median(step))) < flat
