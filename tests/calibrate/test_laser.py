from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate import (
    BoardView,
    StripeOnBoard,
    calibrate_lasers,
    judge,
    sheet_of,
)
from murkscan.calibrate.adjust.observations import index_of
from murkscan.calibrate.adjust.parameters import INTRINSICS, port_parameters
from murkscan.calibrate.adjust.solve import adjust
from murkscan.calibrate.region import errors_where_seen
from murkscan.optics import back_project, distance_to_sheet, intersect_rays_with_sheet
from murkscan.types.water import Water

from .boards import BOARD
from .underwater import FAN, FLAT, SHEET, rig_behind, see_boards, see_stripes

pytestmark = pytest.mark.without_types


def as_photos(sightings):
    """Give sightings as the finders do: stripes and boards of the same photos."""
    stripes = [StripeOnBoard(s.name, s.stripe, s.camera_from_board) for s in sightings]
    return stripes, [BoardView(s.name, s.corners) for s in sightings]


def calibrated(rig, random, count=12, noise=0.1):
    """Calibrate the camera in air, and then its port."""
    air = adjust(rig_behind(None), see_boards(random, rig_behind(None), count, noise), INTRINSICS)
    camera = replace(air.rig.camera, port=rig.camera.port)
    names = (*INTRINSICS, *port_parameters(rig.camera.port))
    start = replace(rig, camera=camera, lasers=())
    seen = see_boards(random, rig, count, noise)
    return adjust(start, seen, names, prior=air.rig.covariance).rig


@pytest.mark.parametrize("sheet", [SHEET, FAN], ids=["plane", "fan"])
def test_a_sheet_under_water_measures_as_well_as_it_states(sheet):
    rig = rig_behind(FLAT, sheet)
    random = np.random.default_rng(1)
    seen = see_stripes(random, rig, 15)
    known = calibrated(rig, random)
    fan = None if sheet is SHEET else replace(FAN, origin=FAN.origin + 2e-3)
    found = calibrate_lasers(*as_photos(seen), BOARD, known, fans={} if fan is None else {0: fan})
    assert not found.is_camera_kept
    pixels = np.concatenate([s.stripe for s in see_stripes(random, rig, 5, noise=0.0)])
    truth, points = (
        intersect_rays_with_sheet(
            back_project(r.camera, pixels, index_of(rig)), r.lasers[0], index_of(rig)
        )
        for r in (rig, found.rig)
    )
    rms = np.sqrt(np.nanmean(np.sum((points - truth) ** 2, axis=1)))
    depth = float(np.nanmean(truth[:, 2]))
    # One draw of about three directions of error that matter.
    assert rms < 2.5 * errors_where_seen(found)[1].sigma < 5e-3 * depth


def test_in_other_water_a_fan_measures_as_well():
    """Fresh water for 35 PSU, and only the water is changed."""
    rig, random = rig_behind(FLAT, FAN), np.random.default_rng(2)
    known = calibrated(rig, random)
    seen = as_photos(see_stripes(random, rig, 12))
    found = calibrate_lasers(*seen, BOARD, known, fans={0: FAN}).rig
    sea = replace(rig, water=Water(20.0, 35.0))
    pixels = np.concatenate([s.stripe for s in see_stripes(random, sea, 5, noise=0.0)])
    truth, points = (
        intersect_rays_with_sheet(
            back_project(r.camera, pixels, index_of(sea)), r.lasers[0], index_of(sea)
        )
        for r in (rig, found)
    )
    off = np.linalg.norm(points - truth, axis=1) / np.linalg.norm(truth, axis=1)
    # Two dozen photos of 0.1 px state 0.1 %; a plane fitted in fresh water is off by 1 %.
    assert np.sqrt(np.nanmean(off**2)) < 2e-3


def test_boards_that_contradict_the_camera_do_not_move_it():
    """The zoom was touched between the boards and the laser's line."""
    rig, random = rig_behind(None), np.random.default_rng(3)
    known = adjust(replace(rig, lasers=()), see_boards(random, rig, 15), INTRINSICS).rig
    zoomed = replace(rig, camera=replace(rig.camera, focal_length=(1430.0, 1430.0)))
    stripes, views = as_photos(see_stripes(random, zoomed, 15))
    found = calibrate_lasers(stripes, views, BOARD, known)
    assert found.is_camera_kept
    assert found.rig.camera.focal_length == known.camera.focal_length
    assert found.rig.covariance.select(INTRINSICS[:1]).sigma[0] == pytest.approx(
        known.covariance.sigma[0]
    )
    assert "contradict the camera" in str(judge(found))


def test_a_camera_without_covariance_is_exact_and_that_is_said():
    rig, random = rig_behind(None), np.random.default_rng(4)
    found = calibrate_lasers(
        *as_photos(see_stripes(random, rig, 15)), BOARD, replace(rig, lasers=())
    )
    assert found.rig.camera.focal_length == rig.camera.focal_length
    assert found.rig.covariance.names == found.wanted
    assert "was taken as exact" in str(judge(found))
    off = distance_to_sheet(np.concatenate(sheet_of(found, 0).points), rig.lasers[0])
    assert np.sqrt(np.nanmean(off**2)) < 1e-3


def test_boards_over_a_small_range_are_a_warning():
    rig = rig_behind(None, SHEET)
    seen = see_stripes(np.random.default_rng(9), rig, 30, near=0.55, far=0.65)
    depths = [np.mean(stripe.points(rig.camera)[:, 2]) for stripe in as_photos(seen)[0]]
    near = [seen[i] for i in np.argsort(np.abs(np.array(depths) - 0.6))[:6]]
    verdict = judge(calibrate_lasers(*as_photos(near), BOARD, rig))
    assert "add photos nearer and farther" in str(verdict)


def test_boards_that_do_not_fit_the_camera_at_all_make_no_usable_laser():
    """The pictures of the laser's line were stretched to another format."""
    rig, random = rig_behind(None), np.random.default_rng(5)
    known = adjust(replace(rig, lasers=()), see_boards(random, rig, 12), INTRINSICS).rig
    stretched = replace(rig.camera, focal_length=(1400.0, 1560.0))
    seen = see_stripes(np.random.default_rng(6), replace(rig, camera=stretched), 25)
    found = calibrate_lasers(*as_photos(seen), BOARD, known)
    verdict = judge(found)
    assert found.rms > 5
    assert not verdict.is_usable
    assert str(verdict).startswith("Not usable: The corners are off by")
