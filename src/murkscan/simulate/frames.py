"""Draw the frames of a scene, one after another, each with its truth."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..types.arrays import Pixels, Points, Scalars
from ..types.frame import Frame
from ..types.pose import Pose
from ..types.true_stripe import TrueStripe
from .scene import Light, Scene
from .stripes import (
    Crossings,
    ScanLines,
    as_pixels,
    find_crossings,
    laser_position,
    trace_scan_lines,
)
from .truth import surface_normals

_REACH = 6.0
"""Standard deviations of the stripe beyond which it is dark: below 1e-5 of a grey level."""
_WIDEST = 4.0
"""How much wider than across itself the stripe may be along its scan line, at most."""


@dataclass(frozen=True, eq=False)
class SimulatedFrame:
    """A frame, and what is true about it."""

    frame: Frame
    stripe: TrueStripe


def simulate_frames(scene: Scene, start: int = 0) -> Iterator[SimulatedFrame]:
    """Draw the frames of a scene in order, each when it is asked for.

    The stripe is a Gaussian along its scan line, as wide as makes it `scene.light.width` across
    itself; its peak follows Lambert's cosine law for light from the laser. Frames are 8 bit. A
    pixel shows the value at its centre.

    Args:
        scene: What is recorded, and how.
        start: Index of the first frame wanted; it looks the same whatever the start is.
    """
    lasers = [trace_scan_lines(scene.rig.camera, laser) for laser in scene.rig.lasers]
    for index in range(start, len(scene.times)):
        world_from_camera = _pose_at(scene, index)
        width, height = scene.rig.camera.size
        light = np.full((height, width), scene.light.ambient, np.float32)
        parts = []
        for number, scan_lines in enumerate(lasers):
            found = find_crossings(scene.surface, world_from_camera, scan_lines)
            points = world_from_camera @ found.points
            peaks, slopes = _shade(scene, world_from_camera, scan_lines, found, points)
            _add_stripe(light, scan_lines, found, peaks, slopes, scene.light)
            pixels = as_pixels(scan_lines.laser.axis, found.lines, found.positions)
            parts.append(_as_truth(index, number, pixels, points, peaks))
        frame = Frame(_expose(light, scene, index), index, float(scene.times[index]))
        yield SimulatedFrame(frame, TrueStripe.concatenate(parts))


def _pose_at(scene: Scene, index: int) -> Pose:
    now = scene.trajectory.at(scene.times[index : index + 1])
    rotation = Rotation.from_quat(now.quaternions[0], scalar_first=True)
    return Pose(rotation.as_matrix(), now.positions[0])


def _shade(
    scene: Scene, world_from_camera: Pose, scan_lines: ScanLines, found: Crossings, points: Points
) -> tuple[Scalars, Scalars]:
    """Give the stripe's peak [grey levels], and its slope: pixels along a scan line to the next."""
    axis = "xy".index(scan_lines.laser.axis)
    normals = surface_normals(scene.surface, points[:, 0], points[:, 1])
    normals = normals @ world_from_camera.rotation  # world to camera axes
    to_laser = laser_position(scan_lines.laser) - found.points
    cosine = np.einsum("ij,ij->i", normals, to_laser) / np.linalg.norm(to_laser, axis=1)
    x, y, z = found.points.T
    tangent = np.cross(normals, scan_lines.laser.as_plane().normal)
    moved = scan_lines.camera.focal_length * (
        tangent[:, :2] - np.stack([x, y], axis=1) / z[:, None] * tangent[:, 2:]
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = moved[:, axis] / moved[:, 1 - axis]
    return scene.light.brightness * np.clip(cosine, 0, 1), np.nan_to_num(slope)


def _add_stripe(
    light: Float[np.ndarray, "h w"],
    scan_lines: ScanLines,
    found: Crossings,
    peaks: Scalars,
    slopes: Scalars,
    how: Light,
) -> None:
    """Add the stripe to the light, a Gaussian in each scan line."""
    lines = light.T if scan_lines.laser.axis == "y" else light
    sigma = how.width * np.minimum(np.hypot(1.0, slopes), _WIDEST)
    if not len(sigma):
        return
    # Only the pixels near the centres: a window as wide as the widest stripe needs.
    reach = int(np.ceil(_REACH * sigma.max()))
    pixels = np.rint(found.positions).astype(int)[:, None] + np.arange(-reach, reach + 1)
    value = np.exp(-0.5 * ((pixels - found.positions[:, None]) / sigma[:, None]) ** 2)
    inside = (pixels >= 0) & (pixels < lines.shape[1])
    rows = np.broadcast_to(found.lines[:, None], pixels.shape)
    lines[rows[inside], pixels[inside]] += (peaks[:, None] * value)[inside]


def _expose(light: Float[np.ndarray, "h w"], scene: Scene, index: int) -> np.ndarray:
    """Add the noise of this frame and round to 8 bit."""
    if scene.light.noise > 0:
        # A generator a frame, so that a frame does not depend on those before it.
        noise = np.random.default_rng([scene.seed, index])
        light = light + scene.light.noise * noise.standard_normal(light.shape, np.float32)
    return np.clip(np.rint(light), 0, 255).astype(np.uint8)


def _as_truth(index: int, laser: int, pixels: Pixels, points: Points, peaks: Scalars) -> TrueStripe:
    return TrueStripe(
        frame=np.full(len(pixels), index, np.uint32),
        laser=np.full(len(pixels), laser, np.uint8),
        pixels=pixels,
        points=points,
        signal=peaks.astype(np.float32),
    )
