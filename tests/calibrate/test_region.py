import numpy as np

from murkscan.calibrate import calibrate_camera, judge
from murkscan.calibrate.region import errors_where_seen, shape_sigma

from .boards import BOARD, CAMERA, views


def test_the_error_told_is_that_where_boards_were_and_not_of_the_whole_picture():
    """Boards in the middle of a wide picture say little of its corners."""
    random = np.random.default_rng(6)
    tilts = [tuple(random.uniform(-30, 30, 2)) for _ in range(12)]
    seen = [view.__class__(view.name, view.corners + 400) for view in views(random, tilts)]
    found = calibrate_camera(seen, BOARD, (1440, 1280))
    near, middle, far = errors_where_seen(found)
    assert near.depth < middle.depth < far.depth
    u, v = np.meshgrid(np.linspace(200, 1240, 12), np.linspace(200, 1080, 8))
    wide = np.stack([u.ravel(), v.ravel()], axis=1)
    assert shape_sigma(found.rig, middle.depth, wide) > 2 * middle.sigma
    assert "in the part of the picture where boards were" in judge(found).praise


def test_the_error_told_of_a_shape_is_the_one_that_happens():
    """Of 12 cameras, a flat shape is bent by what they state, motions of all of it apart."""
    ratios = []
    for seed in range(12):
        random = np.random.default_rng(seed)
        tilts = [tuple(random.uniform(-30, 30, 2)) for _ in range(12)]
        found = calibrate_camera(views(random, tilts), BOARD, CAMERA.size)
        error = errors_where_seen(found)[1]
        ratios.append(_bend(found, error.depth) / error.sigma)
    # An RMS over some four directions of error that matter, of 12 draws: to a sixth.
    assert 0.6 < np.sqrt(np.mean(np.square(ratios))) < 1.5, ratios


def _bend(found, depth):
    """Measure how far points of a plane are off after the best rigid motion [m]."""
    from murkscan.optics import back_project

    pixels = found.corners[:: len(found.corners) // 200]
    places = []
    for camera in (CAMERA, found.rig.camera):
        rays = back_project(camera, pixels)
        places.append(rays.origins + depth / rays.directions[:, 2:] * rays.directions)
    true, seen = (place - place.mean(axis=0) for place in places)
    u, _, vt = np.linalg.svd(seen.T @ true)
    turned = seen @ (u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt)
    return np.sqrt(np.mean(np.sum((turned - true) ** 2, axis=1)))
