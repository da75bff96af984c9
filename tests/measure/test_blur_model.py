"""What is known of the blur beforehand, and what its formula leaves open, is stated two-sidedly."""

from dataclasses import replace

import numpy as np
import pytest
import tomlkit

from murkscan.cloud import merge_profiles
from murkscan.extract import Murk
from murkscan.geometry.stripe_blur import (
    MOST_BLUR,
    Sight,
    blur_moves,
    expect_blur,
    is_readable,
    sheet_moves,
)
from murkscan.measure import trust
from murkscan.optics.seen_points import look_back
from murkscan.simulate import Scene, parse_scene, read_scene, simulate_frames
from murkscan.triangulate import RaySheet
from murkscan.triangulate.base import triangulate
from murkscan.types.arrays import Points, Scalars
from murkscan.types.cylinder import Cylinder
from murkscan.types.stripe import Stripe

PIPE = Cylinder(np.array([0.001, 0.2, 0.9]), np.array([0.0, 1.0, 0.0]), 0.05)
LENS = 1.0**2 + 0.7**2
"""Variance along the stripe of lens and composite video in the scene [px²]."""
SIZE, ABOVE = (280, 174), 222
"""Columns and rows of its pictures that show the pipe, and the rows above them."""
FIELDS = 6
WELL, DITHER = 6e6, 0.4
"""Electrons that fill a pixel, and its noise in the dark [grey levels]."""


def make_scene(water: str) -> Scene:
    """Put a pipe before the PAL rig, in water without particles.

    Its sensor has the noise that dithers what is rounded, and hardly more: without any, pictures
    look as if an encoder had smoothed them.
    """
    text, label, folder = read_scene(f"sphere-c{water}")
    document = tomlkit.parse(text)
    pipe = {"mesh": "cylinder", "radius_mm": 50.0, "length_mm": 600.0}
    document["object"][0] = pipe | {"position_mm": (1e3 * PIPE.point).tolist()}
    document["motion"].update(frames=14, speed_mm_s=100.0, start_mm=[-40.0, 187.0, 0.0])
    scene = parse_scene(tomlkit.dumps(document), label, folder)
    u, v = scene.rig.camera.principal_point
    aside = (scene.rig.camera.size[0] - SIZE[0]) / 2
    camera = replace(scene.rig.camera, size=SIZE, principal_point=(u - aside, v - ABOVE))
    return replace(
        scene,
        rig=replace(scene.rig, camera=camera),
        sensor=replace(scene.sensor, full_well=WELL, read_noise=DITHER * WELL / 255),
        particles=replace(scene.particles, per_frame=0.0),
    )


def scan_pipe(scene: Scene) -> tuple[Points, Sight, Scalars]:
    """Scan it by Murk; gives the points near the pipe, from where they were seen, and widths."""
    frames = [simulated.frame for simulated in simulate_frames(scene, 0, FIELDS)]
    murk = Murk()
    stripes = murk.extract(frames, scene.rig, murk.learn(frames, scene.rig))
    profile = triangulate(Stripe.concatenate(list(stripes)), scene.rig, RaySheet())
    cloud = merge_profiles(profile, scene.trajectory, axes=("y",))
    sight = look_back(cloud, scene.times[cloud.frame], scene.trajectory, scene.rig)
    near = np.abs(PIPE.distance_to(cloud.points)) < 5e-4
    near[near] = is_readable(PIPE, cloud.points[near], sight[near])
    return cloud.points[near], sight[near], cloud.width[near]


def angle_of_pixel(scene: Scene) -> float:
    """Compute how wide a pixel looks in water, from behind a flat port [rad]."""
    return 1 / (scene.rig.camera.focal_length[0] * scene.index)


@pytest.fixture(scope="module")
def pipes() -> list[tuple[Points, Sight, Scalars]]:
    """Give a pipe in clear water and in murk."""
    return [scan_pipe(make_scene(water)) for water in ("0.3", "1.5")]


def test_each_part_of_a_pipe_is_off_the_formula_by_what_is_stated(pipes):
    """In clear water and in murk, whose skirt moves the middle; of noise nothing is left.

    Nine parts of two pipes tell a deviation to a quarter if they are off by themselves.
    """
    off, told = [], []
    for points, sight, _ in pipes:
        pixel = angle_of_pixel(make_scene("1.5")) * np.mean(sight.ranges)
        moved, _ = blur_moves(PIPE, points, sight, LENS * pixel**2)
        rest = PIPE.distance_to(points) - sheet_moves(PIPE, points, sight) - moved
        lean = np.einsum("ij,ij->i", PIPE.normals(points), sight.along)
        for part in np.arange(-0.8, 0.81, 0.2):
            here = np.abs(lean - part) < 0.1
            off.append(rest[here].mean())
            told.append(trust._BLUR_MODEL * moved[here].mean())
    assert 0.7 < np.sqrt(np.mean(np.square(off)) / np.mean(np.square(told))) < 1.4


def test_the_width_that_a_finder_has_learnt_is_told_where_it_looks_that_wide(pipes):
    for _, sight, widths in pipes:
        # The lens is of 1 px, and the sheet adds to it; the pipe lies by the picture's middle.
        assert ((widths > 1.0) & (widths < 1.5)).all()
        told = sight.widths / sight.ranges / widths
        np.testing.assert_allclose(told, angle_of_pixel(make_scene("1.5")), rtol=0.02)


def test_the_blur_is_expected_between_none_and_what_the_width_allows():
    assert expect_blur(Sight(np.eye(3), np.eye(3))) is None
    rows = np.ones((3, 1))
    sight = Sight(rows * [0, 0, 1], rows * [1, 0, 0], widths=np.full(3, 1e-3))
    expected, spread = expect_blur(sight)
    drawn = np.random.default_rng(0).uniform(0.0, MOST_BLUR**2 * 1e-6, 100_000)
    assert expected == pytest.approx(drawn.mean(), rel=0.01)
    assert spread == pytest.approx(drawn.std(), rel=0.01)
    assert expect_blur(replace(sight, widths=np.array([1e-3, 0.0, 1e-3]))) is None
