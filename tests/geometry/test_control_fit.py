"""A model on control points: its intervals hold what they say."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.geometry.control_fit import fit_control
from murkscan.types.georeference import Georeference

MODEL = np.array(
    [[0, 0, 0], [8, 0.2, 0.3], [7.5, 3, -0.4], [0.3, 2.8, 0.2], [4, 1.5, 0.8], [6, 2, -0.7]], float
)
PLACES = np.array([[4.0, 1.5, 0.0], [12.0, 3.0, 0.5], [0.0, -2.0, 1.0]])
SIGMA = 5e-3


def errors_and_sigmas(seed):
    """Lay the model on control that is off by 5 mm; give errors of places in their deviations."""
    random = np.random.default_rng(seed)
    turn, shift = Rotation.random(rng=random).as_matrix(), random.normal(size=3)
    control = MODEL @ turn.T + shift + SIGMA * random.standard_normal(MODEL.shape)
    fit = fit_control(MODEL, control, np.full(len(MODEL), SIGMA))
    placed = Georeference("", "", np.zeros(3), 1.0, fit.target_from_model, fit.covariance)
    errors = placed.place(PLACES) - (PLACES @ turn.T + shift)
    variances = []
    for point in fit.target_from_model @ PLACES:
        moves = np.hstack([np.cross(np.eye(3), point).T, np.eye(3)])
        variances.append(np.diag(moves @ fit.covariance @ moves.T))
    return errors, np.sqrt(variances), placed.sigma(PLACES), fit


def test_the_stated_deviations_are_those_of_the_errors():
    found = [errors_and_sigmas(seed) for seed in range(40)]
    ratios = np.array([errors / sigma for errors, sigma, _, _ in found])
    within = (np.abs(ratios[:, 1, 0]) < 1.96).sum()
    assert 34 <= within <= 40
    # Of 40 seeds, each with about 6 independent numbers; the inflation takes some 8 % off. Half or
    # twice the deviation would be 2 or 0.5.
    assert 0.75 < np.sqrt((ratios**2).mean()) < 1.15


def test_the_largest_direction_is_stated():
    _, sigma, largest, _ = errors_and_sigmas(1)
    assert (largest >= sigma.max(axis=1) - 1e-12).all()
    assert (largest <= np.linalg.norm(sigma, axis=1)).all()


def test_a_point_that_is_off_stands_out_and_widens_the_intervals():
    control = MODEL.copy()
    control[3, 0] += 0.06
    fit = fit_control(MODEL, control, np.full(len(MODEL), SIGMA))
    assert fit.standardised.argmax() == 3
    assert fit.is_surprising
    assert fit.inflation > 2


def test_columns_that_are_exchanged_are_told():
    with pytest.raises(InputError, match="exchange the two columns"):
        fit_control(MODEL, MODEL[:, [1, 0, 2]], np.full(len(MODEL), SIGMA))
