from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate.adjust.observations import Boards, Observed, Sighting
from murkscan.calibrate.adjust.parameters import (
    INTRINSICS,
    port_parameters,
    sheet_parameters,
    window_parameters,
)
from murkscan.calibrate.adjust.residuals import Observations, State, linearise, residuals_of
from murkscan.calibrate.adjust.solve import adjust
from murkscan.errors import Degenerate, InputError
from murkscan.optics import perturb_rig
from murkscan.types.rig_covariance import RigCovariance, unit_of

from .underwater import DOME, FAN, FLAT, SHEET, rig_behind, see_boards, see_stripes

pytestmark = pytest.mark.without_types

RIGS = [rig_behind(FLAT), rig_behind(DOME), rig_behind(FLAT, FAN), rig_behind(None)]
FAR = {"px": 0.1, "m": 1e-4, "rad": 1e-4, "": 1e-4}
"""Steps ten times those of the code's own differences."""


def names_of(rig):
    port = () if rig.camera.port is None else (*port_parameters(rig.camera.port), "water.index")
    laser = rig.lasers[0]
    return (*INTRINSICS, *port, *sheet_parameters(laser, 0), *window_parameters(laser, 0))


def start(rig, count=3):
    random = np.random.default_rng(0)
    seen = [*see_boards(random, rig, count), *see_stripes(random, rig, count)]
    names = names_of(rig)
    observed = Observations(Observed.of(seen))
    state = State(rig, names, np.zeros(len(names)), Boards.of(seen))
    return state, observed, observed.seen.pixels_to_sheet(rig, state.boards)


def richardson(change, step):
    """Differentiate to fourth order."""
    near = (change(step) - change(-step)) / (2 * step)
    far = (change(2 * step) - change(-2 * step)) / (4 * step)
    return (4 * near - far) / 3


@pytest.mark.parametrize("rig", RIGS, ids=["flat", "dome", "fan", "air"])
def test_derivatives_are_those_of_finite_differences(rig):
    state, observed, scale = start(rig)
    found = linearise(state, observed, scale)
    still, none = np.zeros(len(state.names)), np.zeros((6, 6))
    for column, name in enumerate(state.names):
        unit = np.eye(len(state.names))[column]
        slopes = richardson(
            lambda h, unit=unit: residuals_of(state.move(h * unit, none), observed, scale),
            FAR[unit_of(name)],
        )
        # Central differences err by the square of their step, 1e-10 of what curves in a unit; the
        # fan's surface is met to 1e-9 m only, over steps of 1e-5.
        np.testing.assert_allclose(
            found.by_rig[:, column], slopes, rtol=2e-5, atol=1e-5 * np.abs(slopes).max() + 1e-9
        )
    for column in range(6):
        moves = np.tile(np.eye(6)[column], (6, 1))
        slopes = richardson(
            lambda h, moves=moves: residuals_of(state.move(still, h * moves), observed, scale), 1e-4
        )
        np.testing.assert_allclose(
            found.by_pose[:, column], slopes, rtol=2e-5, atol=1e-5 * np.abs(slopes).max()
        )


@pytest.mark.parametrize("rig", RIGS, ids=["flat", "dome", "fan", "air"])
def test_without_noise_the_true_rig_is_found_from_a_wrong_one(rig):
    random = np.random.default_rng(1)
    seen = [*see_boards(random, rig, 8, noise=0.0), *see_stripes(random, rig, 8, noise=0.0)]
    # A fan's port shows too little to be told exactly; and behind a dome that is nearly centred the
    # lens, the index and the centre look alike.
    weak = (
        "laser[0].port",
        "laser[0].shift[0]",
        "laser[0].shift[1]",
        *(("camera.focal", "water") if rig.camera.port is DOME else ()),
    )
    names = [name for name in names_of(rig) if not name.startswith(weak)]
    steps = {"px": 5.0, "m": 2e-3, "rad": 0.01, "": 1e-3}
    off = np.array([steps[unit_of(name)] for name in names])
    found = adjust(perturb_rig(rig, names, off), seen, names).rig
    # It ends where residuals are down to 1e-6 px; index, distance and focal length then still vary
    # as one, in their last digits.
    assert found.camera.focal_length == pytest.approx(rig.camera.focal_length, abs=0.01)
    assert found.camera.principal_point == pytest.approx(rig.camera.principal_point, abs=0.01)
    sheet, truth = found.lasers[0].sheet, rig.lasers[0].sheet
    if rig.camera.port is FLAT:
        assert found.camera.port.distance == pytest.approx(FLAT.distance, abs=1e-5)
        np.testing.assert_allclose(found.camera.port.normal, FLAT.normal, atol=1e-5)
    if rig.camera.port is DOME:
        np.testing.assert_allclose(found.camera.port.centre, DOME.centre, atol=1e-5)
    plane, true_plane = getattr(sheet, "plane", sheet), getattr(truth, "plane", truth)
    np.testing.assert_allclose(plane.normal, true_plane.normal, atol=1e-5)


def test_the_stated_deviations_are_true():
    """Of 20 calibrations under water, errors over sigma of 5 parameters spread as they should."""
    rig, pulls = rig_behind(FLAT), []
    names = (*INTRINSICS, *port_parameters(FLAT))
    for seed in range(20):
        random = np.random.default_rng(seed)
        known = RigCovariance(names, np.diag([2.0, 2, 3, 3, *[1e-3] * 5, 0.02, 0.02, 2e-3]) ** 2)
        off = random.normal(size=len(names)) * known.sigma
        begin = perturb_rig(rig, names, off)
        found = adjust(begin, see_boards(random, rig, 12), names, prior=known)
        error = np.array([*found.rig.camera.focal_length, *found.rig.camera.principal_point])
        error -= [*rig.camera.focal_length, *rig.camera.principal_point]
        error = [*error, found.rig.camera.port.distance - FLAT.distance]
        sigma = found.rig.covariance.select([*names[:4], "camera.port.distance"]).sigma
        pulls.append(error / sigma)
    # 20 x 5 correlated pulls leave the RMS a scatter of some 0.12.
    assert 0.7 < np.sqrt(np.mean(np.square(pulls))) < 1.3


def test_outliers_are_let_go():
    rig = rig_behind(FLAT)
    random = np.random.default_rng(2)
    seen = see_boards(random, rig, 12)
    wrong = [
        replace(s, corners=s.corners + (random.uniform(size=(54, 1)) < 0.05) * 20.0) for s in seen
    ]
    clean, found = (adjust(rig, s, INTRINSICS).rig.camera for s in (seen, wrong))
    # The weights of 5 % of the corners are gone, the rest says the same to a fraction of the
    # deviation of about half a pixel.
    assert found.focal_length == pytest.approx(clean.focal_length, abs=0.3)


def test_a_board_that_is_not_flat_widens_the_deviations():
    """All corners of a photo err together, so that more corners do not tell more."""
    rig = rig_behind(None)
    random = np.random.default_rng(3)
    seen = see_boards(random, rig, 20)
    bend = random.normal(0, 4e-4, (20, 6))
    x, y = (seen[0].points[:, :2] - seen[0].points[:, :2].mean(axis=0)).T / 0.12
    shapes = np.stack([x * y, x * x, y * y, x**3, y**3, x * x * y], axis=1)
    bent = [
        Sighting(
            s.name, s.corners + 1400 * (shapes @ b)[:, None] * [1.0, 0.5], s.points,
            s.camera_from_board,
        )
        for s, b in zip(seen, bend, strict=True)
    ]  # fmt: skip
    worth = adjust(rig, bent, INTRINSICS).worth
    assert worth.dispersion > 2
    assert adjust(rig, seen, INTRINSICS).worth.dispersion == 1


def test_what_photos_cannot_tell_apart_is_refused_by_name():
    rig = rig_behind(FLAT)
    seen = see_boards(np.random.default_rng(4), rig, 6)
    glass = ["camera.port.distance", "laser[0].distance"]
    with pytest.raises(Degenerate, match=r"nothing at all of laser\[0\]\.distance"):
        adjust(rig, seen, glass)


def test_what_is_considered_widens_and_goes_along():
    """The index of water is not estimated, but its error goes into the port's distance."""
    rig = rig_behind(FLAT)
    seen = see_boards(np.random.default_rng(5), rig, 12)
    names = port_parameters(FLAT)
    index = RigCovariance(("water.index",), np.array([[1e-3**2]]))
    sure = adjust(rig, seen, names).rig.covariance
    unsure = adjust(rig, seen, names, prior=index, considered=index.names).rig.covariance
    assert unsure.names == (*names, "water.index")
    assert unsure.sigma[3] == pytest.approx(1e-3)
    moved = adjust(perturb_rig(rig, index.names, np.array([1e-3])), seen, names).rig
    by_index = moved.camera.port.distance - adjust(rig, seen, names).rig.camera.port.distance
    # To first order; a change of 1e-3 bends the answer by some per cent.
    assert unsure.matrix[2, 3] == pytest.approx(by_index * 1e-3, rel=0.1)
    assert unsure.matrix[2, 2] == pytest.approx(sure.matrix[2, 2] + by_index**2, rel=0.1)


def test_boards_inside_the_port_are_told_from_metres_for_millimetres():
    rig = rig_behind(FLAT)
    seen = see_boards(np.random.default_rng(6), rig, 3)
    port = replace(FLAT, distance=30.0)
    far = replace(rig, camera=replace(rig.camera, port=port))
    with pytest.raises(InputError, match="in millimetres"):
        adjust(far, seen, port_parameters(port))


def test_the_stripe_s_noise_is_told_apart_from_the_corners():
    rig = rig_behind(FLAT, SHEET)
    random = np.random.default_rng(7)
    seen = see_stripes(random, rig, 10, noise=0.1)
    coarse = [replace(s, stripe=s.stripe + random.normal(0, 0.4, s.stripe.shape)) for s in seen]
    found = adjust(rig, coarse, sheet_parameters(rig.lasers[0], 0))
    # 1080 corner and over a thousand stripe residuals: 3 % each.
    assert found.corner_sigma == pytest.approx(0.1, rel=0.1)
    assert found.stripe_sigma == pytest.approx(np.hypot(0.1, 0.4), rel=0.1)


def test_what_is_considered_in_two_steps_is_worth_what_it_is_in_one():
    """A prior that goes with the considered index tells as much as its photos would."""
    rig = rig_behind(FLAT)
    random = np.random.default_rng(8)
    first, second = see_boards(random, rig, 10), see_boards(random, rig, 10)
    names = (*INTRINSICS, *port_parameters(FLAT))
    index = RigCovariance(("water.index",), np.array([[1e-3**2]]))
    one = adjust(rig, [*first, *second], names, prior=index, considered=index.names)
    begun = adjust(rig, first, names, prior=index, considered=index.names)
    two = adjust(begun.rig, second, names, prior=begun.rig.covariance, considered=index.names)
    # Noise is told from each half by itself, to 3 % each.
    scale = np.outer(one.rig.covariance.sigma, one.rig.covariance.sigma)
    np.testing.assert_allclose(
        two.rig.covariance.matrix / scale, one.rig.covariance.matrix / scale, atol=0.15
    )
    error = np.array(two.rig.camera.focal_length) - one.rig.camera.focal_length
    assert np.all(np.abs(error) < 0.3 * one.rig.covariance.sigma[:2])
