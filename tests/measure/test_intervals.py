"""Intervals of measures hold the truth: a bump on a wall, forty scans whose points err together."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from murkscan.cloud import merge_profiles
from murkscan.geometry.stripe_blur import Sight
from murkscan.measure import (
    Ball,
    Box,
    Sample,
    cut_out,
    cut_section,
    measure_area,
    measure_distance,
    measure_plane,
    measure_section,
    measure_volume,
    trust_plane,
)
from murkscan.mesh import GridMesh
from murkscan.types.plane import Plane
from murkscan.types.quantity import Quantity

from .. import scans

pytestmark = pytest.mark.without_types

SEEDS, NOISE = 40, 1e-4
"""Noise goes together over four profiles and ten scan lines, as that of a finder that joins."""
HEIGHT, RADIUS = 0.01, 0.03
PART = Box((-0.04, -0.04, 0.3), (0.04, 0.04, 0.7))
WALL = Plane(np.array([0.0, 0.0, -1.0]), 0.5)
ENDS = [1500, -1400]
"""Numbers of two points of the wall."""
ACROSS = Plane(np.array([1.0, 0.0, 0.0]), -0.0011)


def bump(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Half a wave of a cosine before a wall."""
    away = np.minimum(np.hypot(x, y) / RADIUS, 1)
    return 0.5 - HEIGHT * (1 + np.cos(np.pi * away)) / 2


def true_area() -> float:
    """Give the wall's area in the part, and what the bump's slope adds in rings [m²]."""
    away = (np.arange(4000) + 0.5) / 4000 * RADIUS
    slope = HEIGHT / 2 * np.pi / RADIUS * np.sin(np.pi * away / RADIUS)
    rings = 2 * np.pi * away * RADIUS / 4000
    return 0.08**2 + float(np.sum((np.sqrt(1 + slope**2) - 1) * rings))


def measure(points: np.ndarray, stated: float) -> dict[str, Quantity]:
    """Take all measures of the scan with these points in the camera frame."""
    profile, trajectory = SCAN
    sigma = np.full(len(points), stated, np.float32)
    cloud = merge_profiles(replace(profile, points=points, sigma=sigma), trajectory, axes=("x",))
    rays = points / np.linalg.norm(points, axis=1, keepdims=True)
    sight = Sight(rays, np.tile([0.0, 1.0, 0.0], (len(points), 1)))
    sample, mesh = Sample.from_cloud(cloud, sight=sight), GridMesh().mesh(cloud)
    part = cut_out(mesh, PART)
    wall = sample[~Ball((0.0, 0.0, 0.5), 1.1 * RADIUS).contains(cloud.points)]
    fit, trust = trust_plane(wall)
    over = measure_volume(part, sample, fit.shape, trust=(trust, fit.middle))
    return {
        "area": measure_area(part, sample)["area"],
        "volume": measure_volume(part, sample, WALL)["volume"],
        "volume over a fitted plane": over["volume"],
        "mean height": over["mean_height"],
        "plane": measure_plane(wall)["distance"],
        "distance": measure_distance(sample, cloud.points[ENDS])["distance"],
        "section": measure_section(cut_section(mesh, ACROSS), sample)[0]["width"],
    }


SCAN = scans.scan(bump, spacing=2e-3)


@pytest.fixture(scope="module")
def found() -> dict[str, np.ndarray]:
    """Give error and half width of each measure of each seed."""
    profile, _ = SCAN
    volume = np.pi * RADIUS**2 * HEIGHT * (0.5 - 2 / np.pi**2)
    truth = {name: one.value for name, one in measure(profile.points, 0.0).items()}
    truth |= {
        "area": true_area(), "volume": volume, "volume over a fitted plane": volume,
        "mean height": volume / 0.08**2, "plane": 0.5,
    }  # fmt: skip
    rows: dict[str, list[tuple[float, float]]] = {name: [] for name in truth}
    for seed in range(SEEDS):
        # Cropped, so that the noise is as strong at the rim as inside.
        errors = np.random.default_rng(seed).standard_normal((profile.frame.max() + 21, 240))
        errors = gaussian_filter(errors, (1.0, 3.0))[10:-10, 20:-20]
        errors *= NOISE / errors.std()
        along = errors[profile.frame, profile.pixels[:, 1].astype(int)]
        longer = 1 + along / np.linalg.norm(profile.points, axis=1)
        for name, one in measure(profile.points * longer[:, None], NOISE).items():
            rows[name].append((one.value - truth[name], one.half_width))
    return {name: np.array(some) for name, some in rows.items()}


NAMES = (
    "area", "volume", "volume over a fitted plane", "mean height", "plane", "distance", "section",
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_the_interval_holds_the_truth(found, name):
    errors, half_widths = found[name].T
    assert np.mean(np.abs(errors) <= half_widths) >= 0.9


@pytest.mark.parametrize(
    ("name", "widest"),
    # Against 1.96 standard deviations of the errors, known from forty to 11 %. An area's interval
    # has, beside noise, how far normals may be tilted: a share of the number itself.
    [
        ("plane", 1.5),
        ("distance", 1.5),
        ("section", 1.5),
        ("volume", 1.5),
        ("mean height", 1.65),
        ("volume over a fitted plane", 1.65),
    ],
)
def test_the_interval_is_not_much_wider_than_the_errors(found, name, widest):
    errors, half_widths = found[name].T
    assert np.median(half_widths) < widest * 1.96 * errors.std()


def test_the_interval_of_an_area_is_a_small_share_of_it(found):
    assert np.median(found["area"][:, 1]) < 0.003 * true_area()
