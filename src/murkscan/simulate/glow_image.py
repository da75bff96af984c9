"""Which pixels see the sheet's own glow: it ends where the surface begins."""

import cv2
import numpy as np
from jaxtyping import Bool, Float32
from scipy.special import ndtr

from ..optics.sheet_view import SheetView
from ..types.arrays import Indices, Mask, Scalars
from ..types.rays import Rays
from .lit_line import Fall, LitLine, to_world
from .stripe_image import Rendering

_BLOCK = 8
"""Pixels from one node to the next at which sight is first tried."""
_SOFT = 4.0
"""Widths to both sides of a true centre over which the glow's end is drawn."""
_FARTHEST = 100
"""The same in pixels, at most."""


def mask_glow(
    scene: Rendering, view: SheetView, fall: Fall, line: LitLine, widths: Scalars
) -> Float32[np.ndarray, "h w"]:
    """Give the share of each pixel's glow that is there: lit, and with nothing before it.

    Sight is tried at the corners of blocks of pixels, and pixel by pixel in blocks whose corners
    disagree and in those beside them. At the stripe the glow fades as the sheet's Gaussian
    thickness dips into the surface.

    Args:
        scene: Rig, objects and pose.
        view: What each pixel sees of the sheet, row by row.
        fall: How far the fan's rays go.
        line: The true centres.
        widths: Of the stripe there, with the lens's blur [px], 1σ.
    """
    width, height = scene.scan_lines.camera.size
    shape = (height, width)
    lit = fall.is_lit(view.angle, view.laser_range)
    glows, undecided = _try_blocks(scene, view, lit, shape)
    glows &= lit.reshape(shape)
    left = np.flatnonzero(undecided.ravel() & lit)
    glows.ravel()[left] = _is_in_sight(scene, view, left)
    mask = glows.astype(np.float32)
    _soften(mask.T if scene.scan_lines.laser.axis == "y" else mask, line, widths)
    return mask


def _is_in_sight(scene: Rendering, view: SheetView, which: Indices) -> Mask:
    """Tell where nothing lies between the camera and the sheet."""
    rays = Rays(view.origins[which], view.directions[which])
    ranges = np.nan_to_num(view.camera_range[which], nan=np.inf)
    return scene.surroundings.caster.first_hits(to_world(rays, scene.pose)).range > ranges


def _try_blocks(
    scene: Rendering, view: SheetView, lit: Mask, shape: tuple[int, int]
) -> tuple[Bool[np.ndarray, "h w"], Bool[np.ndarray, "h w"]]:
    """Give what the blocks' corners say of each pixel, and where they do not agree."""
    rows, columns = (np.append(np.arange(0, size - 1, _BLOCK), size - 1) for size in shape)
    nodes = (rows[:, None] * shape[1] + columns).ravel()
    node = lit[nodes]
    node[node] = _is_in_sight(scene, view, nodes[node])
    node = node.reshape(len(rows), len(columns))
    corners = node[:-1, :-1].astype(int) + node[1:, :-1] + node[:-1, 1:] + node[1:, 1:]
    mixed = cv2.dilate(((corners > 0) & (corners < 4)).astype(np.uint8), np.ones((3, 3), np.uint8))
    of_row = np.minimum(np.arange(shape[0]) // _BLOCK, len(rows) - 2)
    of_column = np.minimum(np.arange(shape[1]) // _BLOCK, len(columns) - 2)
    at = np.ix_(of_row, of_column)
    return (corners == 4)[at], mixed.astype(bool)[at]


def _soften(mask: Float32[np.ndarray, "lines length"], line: LitLine, widths: Scalars) -> None:
    """Let the glow fade out over the stripe; rows are scan lines, the near side is found there."""
    reach = int(min(np.ceil(_SOFT * widths.max(initial=1.0)), _FARTHEST))
    offsets = np.arange(-reach, reach + 1)
    at = np.rint(line.positions).astype(int)[:, None] + offsets
    inside = (at >= 0) & (at < mask.shape[1])
    at = np.clip(at, 0, mask.shape[1] - 1)
    rows = np.broadcast_to(line.lines[:, None], at.shape)
    before, after = mask[rows[:, 0], at[:, 0]], mask[rows[:, -1], at[:, -1]]
    share = ndtr((line.positions[:, None] - at) / widths[:, None])
    soft = before[:, None] * share + after[:, None] * (1 - share)
    mask[rows[inside], at[inside]] = soft[inside]
