"""Which of the stripe points found in a photo lie on the board's flat paper."""

from dataclasses import dataclass

import cv2
import numpy as np

from ...geometry.intersect import intersect_rays_with_plane
from ...optics import back_project, project
from ...types.arrays import Image, Pixels, Points
from ...types.camera import Camera
from ...types.plane import Plane
from ...types.pose import Pose
from .chessboard import Chessboard, Margin
from .refine import smallest_pitch
from .view import BoardView

_RIM = 6.0
"""How far stripe points keep away from edges: the window of a stripe finder must not see one [px].
"""
_MAX_RIM = 0.3
"""The same in squares, so that small squares keep some light."""
_STRAIGHT = 1.5
"""Distance from the photo's straight line within which a point belongs to the stripe [px]."""
_MIN_POINTS = 20
"""Points on one line that make a stripe: chance puts fewer there."""
_MIN_SHARE = 0.4
"""Share of the points on paper that a stripe has at least; noise is spread all over."""
_NUM_TRIALS = 200
"""Pairs of points tried: one good pair is among them, but for 1e-15, if 0.4 are good."""
_BAND = 25
"""Width of the band that a found line is blackened in [px]."""
_FAINT = 8
"""Contrast up to which a pixel is no stripe [grey levels]."""
_EDGE_STEPS = 16
"""Points on each side of the sheet's outline: a lens bends it."""


@dataclass(frozen=True, eq=False)
class StripeOnBoard:
    """The stripe in one photo, on the flat of the board."""

    name: str
    """Name of the photo."""
    pixels: Pixels
    """Stripe centres on the board [px]."""
    camera_from_board: Pose
    """Where the board was."""
    laser: int = 0
    """Number of the laser that makes it."""

    def points(self, camera: Camera, index: float | None = None) -> Points:
        """Give the stripe in the camera frame [m]: where each pixel's ray meets the board."""
        return locate_on_board(camera, self.pixels, self.camera_from_board, index)


def locate_on_board(
    camera: Camera, pixels: Pixels, camera_from_board: Pose, index: float | None = None
) -> Points:
    """Give where each pixel's ray meets the board, in the camera frame [m]; NaN where not.

    Behind a port, `index` is that of what lies outside it.
    """
    board_plane = Plane.through(camera_from_board.translation, camera_from_board.rotation[:, 2])
    if len(pixels) == 0:
        return np.zeros((0, 3))
    return intersect_rays_with_plane(back_project(camera, pixels, index), board_plane)


def mask_to_sheet(
    image: Image,
    board: Chessboard,
    margin: Margin,
    *,
    camera: Camera,
    camera_from_board: Pose,
    index: float | None = None,
) -> Image:
    """Blacken everything outside of the board's sheet, squares and margin."""
    corners = board.outline(margin)
    share = np.linspace(0, 1, _EDGE_STEPS, endpoint=False)[:, None]
    sides = [
        a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    outline = project(camera, camera_from_board @ np.concatenate(sides), index)
    mask = np.zeros_like(image)
    if np.isfinite(outline).all():
        cv2.fillPoly(mask, [np.clip(np.round(outline), -30000, 30000).astype(np.int32)], 1)
    return image * mask


def count_lit_lines(image: Image) -> tuple[int, int]:
    """Count the rows and the columns in which the stripe of a masked contrast image lies.

    A stripe along the columns lights many rows and few columns: then the laser sits along x.
    """
    lit = image[image > 0]
    if lit.size == 0:
        return 0, 0
    is_bright = image > max(_FAINT, 0.5 * float(np.percentile(lit, 99.5)))
    return int(is_bright.any(axis=1).sum()), int(is_bright.any(axis=0).sum())


def blank_line(image: Image, line: Pixels) -> Image:
    """Blacken a band around the straight line that stripe points lie on, to look for another."""
    middle = line.mean(axis=0)
    along = np.linalg.svd(line - middle, full_matrices=False)[2][0]
    ends = [
        tuple(np.round(middle + side * sum(image.shape) * along).astype(int)) for side in (-1, 1)
    ]
    blanked = image.copy()
    cv2.line(blanked, ends[0], ends[1], 0, thickness=_BAND)
    return blanked


def keep_on_board(
    pixels: Pixels,
    view: BoardView,
    board: Chessboard,
    margin: Margin,
    *,
    camera: Camera,
    camera_from_board: Pose,
    index: float | None = None,
) -> StripeOnBoard:
    """Keep the stripe points on the board's blank paper that lie on one straight line.

    The sheet meets the board in a line as good as straight; what lies beside it is glare or noise.

    Args:
        pixels: Stripe points found in the photo [px].
        view: The board in the photo.
        board: The board.
        margin: How far its sheet runs on beyond the squares.
        camera: The camera.
        camera_from_board: Where the board is.
        index: Refractive index of what lies outside the camera's port; of no effect without one.

    Returns:
        The stripe; of length 0 where the photo does not show one on the board.
    """
    rim = min(_RIM / smallest_pitch(view.grid(board)), _MAX_RIM) * board.square
    in_camera = locate_on_board(camera, pixels, camera_from_board, index)
    in_board = camera_from_board.inverse() @ in_camera
    is_on_paper = board.is_on_paper(in_board, margin, rim=rim, is_first_dark=view.is_first_dark)
    if not view.is_placed:
        # Beyond the corners seen there may be more squares.
        seen = view.places(board.points())[:, :2]
        is_on_paper &= (in_board[:, :2] >= seen.min(axis=0)).all(axis=1)
        is_on_paper &= (in_board[:, :2] <= seen.max(axis=0)).all(axis=1)
    flat = in_camera[is_on_paper, :2] / in_camera[is_on_paper, 2:] * camera.focal_length
    kept = pixels[is_on_paper][_on_one_line(flat)]
    return StripeOnBoard(view.name, kept, camera_from_board)


def _on_one_line(points: Pixels) -> np.ndarray:
    """Tell which points lie on the straight line that most of them lie on; none if too few do."""
    nobody = np.zeros(len(points), dtype=bool)
    if len(points) < _MIN_POINTS:
        return nobody
    random = np.random.default_rng(0)
    first, second = points[random.integers(len(points), size=(2, _NUM_TRIALS))]
    along = second - first
    lengths = np.linalg.norm(along, axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)[lengths > 0] / lengths[lengths > 0, None]
    offsets = np.abs(points @ across.T - np.sum(first[lengths > 0] * across, axis=1))
    members = offsets < _STRAIGHT
    best = members[:, int(np.argmax(members.sum(axis=0)))] if members.size else nobody
    return best if best.sum() >= max(_MIN_POINTS, _MIN_SHARE * len(points)) else nobody
