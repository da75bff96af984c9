"""What nobody knows of light and lens is stated as large as it moves a fit."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.geometry.shape_fit import ShapeFit, refine_shape
from murkscan.geometry.sphere_fit import fit_sphere
from murkscan.io.cloud_columns import from_columns
from murkscan.measure import Sample
from murkscan.measure.trust import moves_of_formula, moves_of_light, trust_fit
from murkscan.types.sphere import Sphere

from ..balls import AWAY, RADIUS, RISE, scan_ball

BLUR, THICKNESS = 1.5e-3 / AWAY, 6e-8**0.5


def fit_drawn(**drawn: float) -> tuple[ShapeFit[Sphere], Sample]:
    """Fit a sphere to a ball whose stripe is drawn by its light."""
    _, points, sight = scan_ball(**drawn)
    x, y, z = points.T
    frame = np.rint((y - RISE * z) / 2e-3).astype(int)
    columns = {"x": x, "y": y, "z": z, "frame": frame, "scan_line": np.rint(2000 * x / z)}
    sample = Sample.from_cloud(from_columns(columns), sight=sight)
    return fit_sphere(points, sight=sight), sample


@pytest.fixture(scope="module")
def usual() -> tuple[ShapeFit[Sphere], Sample]:
    """Give a ball that is lit as is taken for usual."""
    return fit_drawn(blur=BLUR, thickness=THICKNESS)


def change_of(fit: ShapeFit[Sphere], usual: ShapeFit[Sphere]) -> np.ndarray:
    """Give the change of centre and radius."""
    return np.append(fit.shape.centre - usual.shape.centre, fit.shape.radius - usual.shape.radius)


@pytest.mark.parametrize(
    ("column", "drawn"),
    [(1, {"loss": 0.0}), (1, {"loss": 6.0}), (2, {"thickness": 1e-5}),
     (2, {"thickness": 2**0.5 * THICKNESS})],
)  # fmt: skip
def test_water_and_sheet_move_a_ball_by_what_is_stated_at_one_sigma(usual, column, drawn):
    fit, _ = fit_drawn(**{"blur": BLUR, "thickness": THICKNESS} | drawn)
    told = moves_of_light(*usual)[:4, column]
    change = change_of(fit, usual[0])
    change *= np.sign(change @ told)
    # The next order is a fifth of them.
    np.testing.assert_allclose(change, told, rtol=0.3, atol=8e-7)


def test_a_skirt_of_the_lens_moves_a_ball_by_what_is_stated_where_its_blur_is_held(usual):
    """A fiftieth of the light in a skirt three times as wide, and a fit that knows no blur."""
    lens = {"blur": BLUR, "thickness": THICKNESS}
    plain, skirted = (scan_ball(**lens, skirt=share)[1] for share in (0.0, 0.02))
    start = Sphere(np.array([0.0, 0.0, AWAY]), RADIUS)
    fits = [refine_shape(start, points, reach=np.inf) for points in (skirted, plain)]
    fit, sample = usual
    told = moves_of_light(replace(fit, inliers=np.ones_like(fit.inliers)), sample)[:4, 0]
    # Half or twice as much would be off by more than a third of what is found.
    np.testing.assert_allclose(change_of(*fits), told, rtol=0.35, atol=8e-7)


def test_all_of_it_is_in_the_uncertainty(usual):
    fit, sample = usual
    stated = trust_fit(fit, sample)[1].independent[3, 3]
    parts = moves_of_light(fit, sample)[3], moves_of_formula(fit, sample)[3]
    # Without noise nothing else is; what the formulas leave is far less.
    assert float(np.sum(np.concatenate(parts) ** 2)) == pytest.approx(stated, rel=0.3)
