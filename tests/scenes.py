"""Small scenes for tests: in clear air, before a PAL camera."""

import math
from dataclasses import replace

import numpy as np

from murkscan.simulate import Body, Scene, Sensor, drive
from murkscan.simulate.shapes import AbstractShape, Hull, Plane
from murkscan.simulate.textures import Plain
from murkscan.simulate.vehicle import Unrest
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

HULL_SPEED = 0.1
"""Speed of the camera along y in `hull_scene` [m/s]."""
QUIET = Sensor(
    full_well=1e6, read_noise=0.0, shot_noise=False, bits=16, vignetting=False, peak_grey=4e4,
    black_level=0.0,
)  # fmt: skip
"""A camera whose pictures are light alone, in 16 bit."""


def air_rig(baseline: float = 0.25, distance: float = 0.5, axis: str = "y") -> Rig:
    """A PAL camera; its sheet crosses the optical axis at a distance [m]."""
    camera = Camera(size=(720, 576), focal_length=(554.0, 554.0), principal_point=(359.5, 287.5))
    angle = math.atan2(distance, abs(baseline))
    angle = angle if baseline > 0 else math.pi - angle
    return Rig(camera, (Laser.from_baseline_angle(baseline, angle, axis),), 532e-9)


def body(shape: AbstractShape, at: tuple[float, float, float], **settings: object) -> Body:
    """An object, upright, at a place in the world [m]."""
    return Body(shape.mesh(), Pose(np.eye(3), np.array(at)), **settings)


def standing(*bodies: Body, rig: Rig | None = None, **settings: object) -> Scene:
    """A camera that stands still at the origin of the world, and takes one frame."""
    trajectory = Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0, 0, 0]]))
    settings = {"sensor": QUIET} | settings
    return Scene(bodies, rig or air_rig(), trajectory, np.zeros(1), **settings)


def wall(distance: float = 0.6, *, albedo: float = 0.2, **settings: object) -> Body:
    """A wall that fills the picture."""
    return body(Plane(8.0, 8.0), (0.0, 0.0, distance), texture=Plain(albedo), **settings)


def smaller(scene: Scene, factor: int = 3) -> Scene:
    """The same scene through a camera of fewer pixels, which is drawn sooner."""
    camera = scene.rig.camera
    width, height = (side // factor for side in camera.size)
    camera = replace(
        camera,
        size=(width, height),
        focal_length=tuple(f / factor for f in camera.focal_length),
        principal_point=((width - 1) / 2, (height - 1) / 2),
    )
    return replace(scene, rig=replace(scene.rig, camera=camera))


def hull_scene(num_frames: int = 130) -> Scene:
    """A ship model's hull, 0.42 to 0.58 m before the camera, which passes it in ten seconds."""
    times = np.arange(num_frames) * (10.0 / num_frames)
    way = drive(Unrest(), np.array([0.0, HULL_SPEED, 0.0]), np.zeros(3), 10.0, seed=0)
    hull = body(Hull(), (0.0, 0.5, 0.58), texture=Plain(0.2))
    sensor = Sensor(peak_grey=200.0, read_noise=2.0)
    return Scene((hull,), air_rig(), way, times, sensor=sensor)
