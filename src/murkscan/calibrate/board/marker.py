"""Square markers with a number, as ArUco and AprilTag have them."""

import cv2
import numpy as np
from jaxtyping import Float

from ...errors import InputError
from ...types.arrays import Image

Corners = Float[np.ndarray, "k 2"]
Place = Float[np.ndarray, "2"]
_ROUNDS = 2
"""Times that edges are looked for, beginning where OpenCV found them."""
_REACH, _FARTHEST = 0.8, 4.0
"""How far from an edge is looked, in modules of the marker, and at most [px]: the frame is one
module wide."""
_STEP = 0.25
"""Distance of places across an edge [px]."""
_LIT = 0.95
"""Share of the pixels that are darker than the laser's line."""
_CLEAR = 0.12
"""Share of an edge at either end that is left out: blur rounds the corners."""


def require_dictionary(name: str) -> None:
    """Refuse a dictionary that OpenCV has not.

    Raises:
        InputError: There is none of that name.
    """
    if not hasattr(cv2.aruco, f"DICT_{name}"):
        known = sorted(each[5:] for each in dir(cv2.aruco) if each.startswith("DICT_"))
        raise InputError(
            f"There is no dictionary of markers {name!r}; give the one that they were printed "
            f"with: {', '.join(known)}."
        )


def load_dictionary(name: str) -> cv2.aruco.Dictionary:
    """Give a dictionary by OpenCV's name of it, without `DICT_` before it."""
    require_dictionary(name)
    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{name}"))


def find_markers(picture: Image, dictionary: cv2.aruco.Dictionary) -> dict[int, Corners]:
    """Find markers in a picture.

    Args:
        picture: Grey, 8 or 16 bit.
        dictionary: Which ones; see `load_dictionary`.

    Returns:
        The corners of each by its number, clockwise from its top left [px]; those that the picture
        has twice are left out.

    References:
        Garrido-Jurado et al., Automatic generation and detection of highly reliable fiducial
        markers under occlusion, Pattern Recognition 47(6), 2014.
    """
    settings = cv2.aruco.DetectorParameters()
    settings.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_CONTOUR
    detector = cv2.aruco.ArucoDetector(dictionary, settings)
    corners, numbers, _ = detector.detectMarkers(_stretch(picture))
    if numbers is None:
        return {}
    called, modules = numbers.ravel().tolist(), dictionary.markerSize + 2
    return {
        number: _refine(picture, corner.reshape(4, 2).astype(np.float64), modules)
        for number, corner in zip(called, corners, strict=True)
        if called.count(number) == 1
    }


def _refine(picture: Image, corners: Corners, modules: int) -> Corners:
    """Put the corners where straight lines along the four edges of the black frame meet.

    An edge lies where its steps from black to white have their centre of gravity: however blurred
    it is, and whatever is printed within the frame.
    """
    for _ in range(_ROUNDS):
        starts, ends = corners, np.roll(corners, -1, axis=0)
        lines = [
            _follow_edge(picture, start, end, modules)
            for start, end in zip(starts, ends, strict=True)
        ]
        found = np.array([_meet(lines[k - 1], lines[k]) for k in range(4)])
        if not np.isfinite(found).all():
            return corners
        corners = found
    return corners


def _follow_edge(picture: Image, start: Place, end: Place, modules: int) -> Corners:
    """Give two places on the line along an edge, of which the marker lies on the right."""
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    outwards = np.array([along[1], -along[0]])
    reach = float(np.clip(_REACH * length / modules, 1.5, _FARTHEST))
    away = np.arange(-reach, reach + _STEP / 2, _STEP)
    ways = np.linspace(_CLEAR, 1 - _CLEAR, max(int(length), 8)) * length
    places = start + ways[:, None, None] * along + away[:, None] * outwards
    flat = places.astype(np.float32)
    levels = cv2.remap(picture, flat[..., 0], flat[..., 1], cv2.INTER_LINEAR).astype(float)
    steps = np.maximum(np.diff(levels, axis=1), 0.0)
    weights = steps.sum(axis=1)
    with np.errstate(invalid="ignore"):
        offsets = steps @ (away[:-1] + _STEP / 2) / weights
    seen = weights > 0.5 * np.median(weights)
    if seen.sum() < 4:
        return np.full((2, 2), np.nan)
    slope, offset = np.polyfit(ways[seen], offsets[seen], 1)
    return np.array(
        [start + way * along + (offset + slope * way) * outwards for way in (0.0, length)]
    )


def _meet(first: Corners, second: Corners) -> Place:
    """Give the place where two lines, each through two places, meet."""
    ways = np.stack([first[1] - first[0], second[0] - second[1]], axis=1)
    if abs(np.linalg.det(ways)) < 1e-9 or not np.isfinite(ways).all():
        return np.full(2, np.nan)
    share = np.linalg.solve(ways, second[0] - first[0])[0]
    return first[0] + share * (first[1] - first[0])


def _stretch(picture: Image) -> Image:
    """Give a picture of 8 bits in which what a lamp lights is bright, however bright the laser is.

    OpenCV tells black from white by some grey levels.
    """
    white = max(float(np.quantile(picture[::4, ::4], _LIT)), 1.0)
    return np.clip(picture * (255 / white), 0, 255).astype(np.uint8)
