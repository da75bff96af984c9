"""Whether boards are tilted differently enough to tell a camera from."""

from collections.abc import Sequence

import cv2
import numpy as np

from ...errors import Degenerate
from ...types.arrays import Directions
from .chessboard import Chessboard
from .view import BoardView, as_opencv

MIN_SPREAD = np.radians(6.0)
"""Spread of the boards' normals below which they count as parallel [rad].

Boards held straight by hand, or lying on a table, spread by up to 5 degrees; boards tilted at
random by up to 8 degrees, of which a camera can just be told, by 12 or more.
"""
_FRONTAL = np.radians(12.0)
"""Median tilt below which parallel boards are said to face the camera [rad]."""
_PLAIN_CAMERA = (
    cv2.CALIB_USE_INTRINSIC_GUESS
    | cv2.CALIB_FIX_PRINCIPAL_POINT
    | cv2.CALIB_FIX_ASPECT_RATIO
    | cv2.CALIB_ZERO_TANGENT_DIST
    | cv2.CALIB_FIX_K2
    | cv2.CALIB_FIX_K3
)
_EQUALLY_GOOD = 1.05
"""RMS over the lowest one up to which a fit explains the corners as well."""
_FOCAL_GUESSES = (0.8, 2.0, 5.0)
"""Focal lengths over the picture's width from which the plain camera is looked for."""
_REMEDY = (
    "Take photos with the board tilted by 20 to 40 degrees to the left, the right, the top and the "
    "bottom."
)


def refuse_parallel_boards(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> None:
    """Refuse views in which all boards are parallel, or nearly so.

    Raises:
        Degenerate: The boards face the camera, or are all tilted alike.

    References:
        Zhang 2000, section 3.4: a view of a board parallel to that of another one adds nothing.
    """
    normals = plain_normals(views, board, size)
    # One tilted board among parallel ones tells hardly more than they do, and noise in their tilts
    # makes it look like more.
    spreads = [spread_of(np.delete(normals, i, axis=0)) for i in range(len(normals))]
    alone = int(np.argmin(spreads))
    spread = spreads[alone]
    if spread >= MIN_SPREAD:
        return
    if spread_of(normals) >= MIN_SPREAD:
        raise Degenerate(
            f"The {len(views)} views do not determine the focal length: all boards but that of "
            f"{views[alone].name} are parallel to {np.degrees(spread):.1f} degrees. {_REMEDY}"
        )
    tilt = float(np.median(np.arccos(np.clip(np.abs(normals[:, 2]), 0, 1))))
    stance = (
        "all face the camera straight on"
        if tilt < _FRONTAL
        else f"are all tilted alike, by about {np.degrees(tilt):.0f} degrees"
    )
    raise Degenerate(
        f"The boards in the {len(views)} views {stance}: their directions differ by only "
        f"{np.degrees(spread):.1f} degrees, so any focal length fits, with a low RMS too. "
        f"{_REMEDY}"
    )


def plain_normals(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> Directions:
    """Give each board's normal as a plain camera sees it.

    With the principal point in the middle, square pixels and one distortion parameter, the tilt is
    told from how the squares are squeezed. The full model would explain boards that face the
    camera by a tilt and oblong pixels. Where several focal lengths explain the corners equally
    well, the one with the most parallel boards counts: if they may be parallel, nothing is known.
    """
    flat, seen = as_opencv(views, board.points())
    width, height = size
    middle = ((width - 1) / 2, (height - 1) / 2)
    fits = []
    for guess in _FOCAL_GUESSES:
        matrix = np.array([[guess * width, 0, middle[0]], [0, guess * width, middle[1]], [0, 0, 1]])
        rms, _, _, turns, _ = cv2.calibrateCamera(
            flat, seen, size, matrix, np.zeros(5), flags=_PLAIN_CAMERA
        )
        fits.append((rms, np.stack([cv2.Rodrigues(turn)[0][:, 2] for turn in turns])))
    best = min(rms for rms, _ in fits)
    equally_good = [normals for rms, normals in fits if rms <= _EQUALLY_GOOD * best]
    return min(equally_good, key=spread_of)


def spread_of(normals: Directions) -> float:
    """Give the angle [rad] that nine in ten pairs of normals do not exceed."""
    first, second = np.triu_indices(len(normals), 1)
    cosines = np.abs(np.sum(normals[first] * normals[second], axis=1))
    return float(np.percentile(np.arccos(np.minimum(cosines, 1.0)), 90))
