"""Clean scans of analytic surfaces: camera rays meet the sheet of light where the surface is."""

from collections.abc import Callable

import numpy as np

from murkscan.cloud import merge_profiles
from murkscan.types.cloud import PointCloud
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

Surface = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Depth at x and y [m], NaN where there is none."""
FOCAL_LENGTH, BASELINE, COTANGENT = 800.0, 0.2, 0.4
_AT_ONCE = 100
"""Rays that step at once: their 401 depths fit into a core's memory."""


def plane(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.5 + 0.3 * x - 0.2 * y


def sphere(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return 0.5 - np.sqrt(0.05**2 - x * x - y * y)


def cylinder(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return 0.5 + 0 * x - np.sqrt(0.04**2 - y * y)


def step(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Two level planes 30 mm apart."""
    return np.where(y > 0, 0.5, 0.47) + 0 * x


def waves(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.5 + 0.008 * np.sin(60 * x) * np.cos(50 * y)


def holed(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A wall with a round hole of 20 mm radius."""
    return np.where(x * x + y * y < 0.02**2, np.nan, 0.5)


def scan(
    surface: Surface,
    *,
    spacing: float = 1e-3,
    noise: float = 0.0,
    interlaced: bool = False,
    num_rows: int = 200,
) -> tuple[Profile, Trajectory]:
    """Move over 0.12 m of a surface along x, with the laser on the x axis.

    Args:
        surface: Its depth.
        spacing: Distance between profiles [m].
        noise: Standard deviation of the range, which the profile states as its sigma [m].
        interlaced: Whether even frames see the even rows only, and odd ones the odd.
        num_rows: Scan lines.
    """
    num_frames = round(0.12 / spacing)
    every = np.arange(num_rows)
    rows = [every[k % 2 :: 2] if interlaced else every for k in range(num_frames)]
    frame, row = (
        np.repeat(np.arange(num_frames), [len(some) for some in rows]),
        np.concatenate(rows),
    )
    slopes = (row - (num_rows - 1) / 2) / FOCAL_LENGTH
    points, met = _meet(surface, spacing * frame - 0.06, slopes)
    random = np.random.default_rng(0).standard_normal(len(points))
    points *= (1 + noise * random / np.linalg.norm(points, axis=1))[:, None]
    profile = as_profile(points, frame[met], row[met], sigma=noise)
    ends = np.array([[-0.06, 0.0, 0.0], [spacing * num_frames - 0.06, 0.0, 0.0]])
    times = np.array([0.0, num_frames * 0.04])
    return profile, Trajectory(times, ends, np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)))


def as_profile(
    points: np.ndarray, frame: np.ndarray, row: np.ndarray, *, sigma: float = 0.0
) -> Profile:
    """Give points of the camera frame [m] what else a profile has."""
    ones = np.ones(len(points), np.float32)
    return Profile(
        frame=frame.astype(np.uint32),
        time=frame * 0.04,
        laser=np.zeros(len(points), np.uint8),
        pixels=np.stack([np.full(len(points), 400.0), row.astype(float)], axis=1),
        points=points,
        sigma=ones * np.float32(sigma),
        signal=ones * 100,
        posterior=ones,
        branch=np.zeros(len(points), np.uint8),
    )


def scan_cloud(surface: Surface, **settings: float | bool) -> PointCloud:
    """Scan a surface and merge the profiles."""
    profile, trajectory = scan(surface, **settings)
    return merge_profiles(profile, trajectory, axes=("x",))


def _meet(surface: Surface, x: np.ndarray, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find where rays meet the surface, and which do: step towards it, then bisect.

    Args:
        surface: Its depth.
        x: Where the camera is for each ray [m].
        slopes: How far each ray goes along y for each metre of depth.
    """

    def beyond(z: np.ndarray, some: slice = slice(None)) -> np.ndarray:
        return z - surface(x[some, None] - BASELINE + z * COTANGENT, slopes[some, None] * z)

    steps = np.linspace(0.4, 0.6, 401)
    first, enters = np.zeros(len(x), int), np.zeros(len(x), bool)
    for start in range(0, len(x), _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        gap = beyond(steps[None], some)
        crossed = (gap[:, :-1] < 0) & (gap[:, 1:] >= 0)
        first[some], enters[some] = crossed.argmax(axis=1), crossed.any(axis=1)
    low, high = steps[first][:, None], steps[first + 1][:, None]
    for _ in range(40):
        middle = (low + high) / 2
        is_beyond = beyond(middle) >= 0
        low, high = np.where(is_beyond, low, middle), np.where(is_beyond, middle, high)
    # At a step the sign changes without the depth being met.
    met = enters & (np.abs(beyond(low)) < 1e-6)[:, 0]
    z = low[met, 0]
    return np.stack([z * COTANGENT - BASELINE, slopes[met] * z, z], axis=1), met
