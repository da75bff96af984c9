"""The scene of `murkscan demo`: a ship-model hull under the paper's rig."""

import math

import numpy as np

from ..errors import InputError
from ..types.camera import Camera
from ..types.laser import Laser
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .scene import Light, Scene
from .wigley_hull import WigleyHull

HULL_SPEED = 0.1
"""Speed of the camera along + y, over the hull from stern to bow [m/s]."""
HULL_FRAME_RATE = 25.0
"""Frames of the PAL camera a second."""


def hull_scene(*, num_frames: int = 250, noise: float = 0.0, seed: int = 0) -> Scene:
    """Make the scene of the demo: a hull 0.9 m long, 0.42 to 0.58 m before the camera.

    The rig is the paper's: a PAL camera of 720 by 576 pixels and 66 degrees, and a 532 nm line
    laser, here 0.25 m beside it along y. The camera moves at constant speed along + y; at time 0
    its frame is the world frame. The first and the last frames show no hull.

    Args:
        num_frames: Frames over the whole hull; the speed stays, so the frame rate follows.
        noise: Standard deviation of one pixel's white noise [grey levels].
        seed: Where the noise starts.

    Raises:
        InputError: There are fewer than two frames.
    """
    if num_frames < 2:
        raise InputError(f"The hull's recording needs at least 2 frames, got {num_frames}.")
    duration = 250 / HULL_FRAME_RATE
    ends = np.array([0.0, duration])
    positions = np.array([[0.0, 0.0, 0.0], [0.0, HULL_SPEED * duration, 0.0]])
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))
    return Scene(
        surface=WigleyHull(),
        rig=hull_rig(),
        trajectory=Trajectory(ends, positions, upright),
        times=np.arange(num_frames) * (duration / num_frames),
        light=Light(noise=noise),
        seed=seed,
    )


def hull_rig() -> Rig:
    """Make the rig of the demo: its sheet crosses the optical axis at 0.5 m."""
    camera = Camera(size=(720, 576), focal_length=(554.0, 554.0), principal_point=(359.5, 287.5))
    laser = Laser.from_baseline_angle(0.25, math.atan2(0.5, 0.25), "y")
    return Rig(camera, (laser,), 532e-9)
