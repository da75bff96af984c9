"""Dents of every shape, in scans whose points err together with their neighbours."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from murkscan.measure import Sample, find_dents
from murkscan.types.cloud import PointCloud
from murkscan.types.dent import Dent
from murkscan.types.deviation import Deviation

pytestmark = pytest.mark.without_types

SPACING, STEP = 2e-3, 1e-3
"""Distance between profiles, and along them [m]."""
NOISE = 4e-5
"""Standard deviation of the points' errors [m], which go together over two profiles, three lines:
as a finder's do that joins so many."""
SEEDS = 10
SHAPES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "half a wave of a cosine": lambda r: (1 + np.cos(np.pi * np.minimum(r, 1))) / 2,
    "a cap of a sphere": lambda r: np.clip(1 - r**2, 0, None),
    "a bell": lambda r: np.exp(-((1.5 * r) ** 2)),
    "a flat floor": lambda r: np.clip((1 - r) / 0.4, 0, 1),
}
"""Depth over that of the deepest place, at a distance from it in radii of the dent."""


@dataclass(frozen=True)
class Truth:
    """What a dent is [m]."""

    depth: float
    width: float
    middle: np.ndarray


def scan_dent(shape: str, seed: int, *, wave: float = 0.0) -> tuple[Sample, Deviation, Truth]:
    """Scan a wall with a dent 1 to 4 mm deep and 40 to 120 mm wide.

    Args:
        shape: The dent's.
        seed: Of all that is random.
        wave: Height of a long wave by which the wall departs from its drawing [m].
    """
    random = np.random.default_rng(seed)
    depth, width = random.uniform(1e-3, 4e-3), random.uniform(0.04, 0.12)
    side = max(0.2, 3 * width)
    frames, lines = int(side / SPACING), int(side / STEP)
    frame, line = np.divmod(np.arange(frames * lines), lines)
    x, y = frame * SPACING, line * STEP
    middle = side / 2 + random.uniform(-3e-3, 3e-3, 2)
    errors = gaussian_filter(random.standard_normal((frames, lines)), (2, 3), mode="wrap").ravel()
    away = np.hypot(x - middle[0], y - middle[1]) / (width / 2)
    values = NOISE / errors.std() * errors - depth * SHAPES[shape](away)
    values += wave * np.cos(2 * np.pi * (x - middle[0]) / side)
    ones = np.ones(len(x), np.float32)
    towards = np.tile([0.0, 0.0, -1.0], (len(x), 1))
    cloud = PointCloud(
        np.stack([x, y, 0.8 - values], axis=1), towards.astype(np.float32), ones, ones,
        ones * np.float32(NOISE), 0 * ones, frame.astype(np.int32), line.astype(np.int32),
        *np.zeros((2, len(x)), np.uint8),
    )  # fmt: skip
    deviation = Deviation(values, towards, np.zeros(len(x)))
    return Sample.from_cloud(cloud), deviation, Truth(depth, width, middle)


def find(sample: Sample, deviation: Deviation) -> Dent:
    """Give the deepest dent: noise as regular as this may show another one."""
    return find_dents(sample, deviation, smallest=0.02).dents[0]


def rim_of(shape: str) -> float:
    """Give where a dent of this shape is a tenth as deep as in its middle, in its radii."""
    away = np.linspace(0, 3, 3001)
    return float(away[SHAPES[shape](away) >= 0.1][-1])


@pytest.fixture(scope="module", params=SHAPES)
def found(request) -> dict[str, np.ndarray]:
    """Give error and half width of the interval of what each seed's dent is [m]."""
    rows = []
    for seed in range(SEEDS):
        sample, deviation, truth = scan_dent(request.param, seed)
        dent, rim = find(sample, deviation), truth.width * rim_of(request.param)
        off, half_widths = dent.place[:2] - truth.middle, 1.96 * dent.sigma_place[:2]
        rows.append([
            (dent.depth.value - truth.depth, dent.depth.half_width),
            (dent.diameter.value - rim, dent.diameter.half_width),
            *zip(off.tolist(), half_widths.tolist(), strict=True),
        ])  # fmt: skip
    return dict(zip(("depth", "diameter", "x", "y"), np.array(rows).swapaxes(0, 1), strict=True))


# Of ten intervals of 95 %, nine or ten hold the truth in 91 of 100 cases; eight in 99.
@pytest.mark.parametrize(
    ("what", "least"), [("depth", 0.9), ("diameter", 0.8), ("x", 0.8), ("y", 0.8)]
)
def test_the_interval_holds_the_truth_whatever_the_dents_shape(found, what, least):
    assert np.mean(np.abs(found[what][:, 0]) <= found[what][:, 1]) >= least


# A steep rim, which the averaged map does not follow, counts as noise of the place; the map's noise
# counts as one that moves the whole rim alike.
@pytest.mark.parametrize(("what", "widest"), [("depth", 2), ("x", 5), ("y", 5), ("diameter", 5)])
def test_the_interval_is_not_much_wider_than_its_errors_ask_for(found, what, widest):
    # The errors' own size is known from ten to a quarter.
    errors = np.sqrt(np.mean(found[what][:, 0] ** 2))
    assert np.median(found[what][:, 1]) < widest * 1.96 * 1.25 * errors


def test_a_hull_that_is_not_as_drawn_does_not_widen_the_interval():
    plain, waved = (
        find(*scan_dent("a cap of a sphere", 0, wave=wave)[:2]).depth for wave in (0.0, 2e-4)
    )
    # The wave's own curve over the polynomial changes the floor a little.
    assert waved.half_width < 1.25 * plain.half_width


def test_a_part_that_shows_hardly_more_than_the_dent_still_has_an_interval():
    sample, deviation, truth = scan_dent("a cap of a sphere", 1)
    deepest = sample.cloud.points[np.argmin(deviation.values)]
    near = np.linalg.norm(sample.cloud.points - deepest, axis=1) < 0.09
    measured = find(sample[near], deviation[near]).depth
    # What residuals alone tell is too little by up to two: they do not show what the fit follows.
    assert abs(measured.value - truth.depth) < 2 * measured.half_width
    assert measured.half_width < 0.1 * truth.depth
