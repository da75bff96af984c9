"""What is recorded, by which rig, along which way, in which water and light."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import InputError
from ..optics import refractive_index
from ..optics.beam import Light
from ..optics.medium import Medium
from ..optics.sensor import Sensor
from ..types.arrays import Scalars
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .instruments import Instruments
from .overlay import Overlay
from .particles import Particles
from .processing import Processing
from .recorder import Recorder
from .surface import Body, Surroundings
from .vehicle import Navigation
from .window import Window

_MOST_PIXELS = 50_000_000
_FAR = 10.0
"""How far from all objects the camera may go, in sizes of the scene or nearest distances."""


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a simulated recording depends on; the same scene gives the same bytes."""

    bodies: tuple[Body, ...]
    """What stands there; nothing in an empty sea."""
    rig: Rig
    """The camera and its lasers; its water is what bends the light."""
    trajectory: Trajectory
    """world_from_camera."""
    times: Scalars
    """When each frame is exposed [s], within the trajectory; each field, where interlaced."""
    medium: Medium | None = None
    """What the water does to light; None: it is as clear as air."""
    light: Light = field(default_factory=Light)
    sensor: Sensor = field(default_factory=Sensor)
    particles: Particles = field(default_factory=Particles)
    window: Window = field(default_factory=Window)
    processing: Processing = field(default_factory=Processing)
    overlay: Overlay = field(default_factory=Overlay)
    recorder: Recorder = field(default_factory=Recorder)
    glow: bool = True
    """Whether the sheet's own glow is drawn."""
    forward_scattering: bool = True
    """Whether the water spreads sheet and picture."""
    navigation: Navigation | Instruments | None = None
    """What the vehicle's own log is like; None: there is none."""
    seed: int = 0
    """Where noise and particles start."""
    acceptance: str = ""
    """What `murkscan accept` is told of its artefacts, as the text of a file; empty: nothing."""

    def __post_init__(self) -> None:
        """Refuse a scene without light or without frames."""
        if not self.rig.lasers and not self.light.shows_objects:
            raise InputError(
                "A scene needs light: add rig.laser, light.ambient_w_m2 or light.lamp.power_w."
            )
        if not self.bodies and self.sensor.peak_grey is not None:
            raise InputError(
                "sensor.peak_grey is that of a stripe on an [object]: in an empty sea give "
                "sensor.exposure_ms, or an object."
            )
        if len(self.times) == 0:
            raise InputError("motion.frames must be at least 1.")
        if self.recorder.codec != "png" and self.sensor.bits > 8:
            raise InputError(
                f"sensor.codec {self.recorder.codec} keeps 8 bits, but sensor.bits is "
                f"{self.sensor.bits}; keep deeper pictures as png."
            )

        width, height = self.rig.camera.size
        if width * height > _MOST_PIXELS:
            raise InputError(
                f"rig.camera.size is {width} x {height} px; at most {_MOST_PIXELS / 1e6:g} million "
                "pixels are drawn."
            )
        self._check_way()

    def _check_way(self) -> None:
        """Refuse a way that leads out of the scene."""
        if not self.bodies:
            return
        vertices = self.surroundings.mesh.vertices
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        places = self.trajectory.at(self.times).positions
        away = np.linalg.norm(np.maximum(np.maximum(low - places, places - high), 0.0), axis=1)
        limit = _FAR * max(float(away.min()), float(np.linalg.norm(high - low)))
        if away.max() > limit:
            first = int(np.argmax(away > limit))
            raise InputError(
                f"The way leaves the scene: in frame {first} of {len(self)} the camera is "
                f"{away[first]:.3g} m from the nearest object. Lower motion.speed_mm_s or "
                "motion.frames, or check the unit of motion.poses (m)."
            )

    def __len__(self) -> int:
        """Count the frames; fields are counted."""
        return len(self.times)

    @property
    def attenuation(self) -> float:
        """Beam attenuation of the water [1/m]."""
        return self.medium.attenuation if self.medium else 0.0

    @property
    def index(self) -> float:
        """Refractive index of the water."""
        return refractive_index(self.rig.water, self.rig.wavelength)

    @cached_property
    def surroundings(self) -> Surroundings:
        """All bodies as one."""
        return Surroundings(self.bodies)

    def pose(self, number: int) -> Pose:
        """Give world_from_camera of a frame."""
        now = self.trajectory.at(self.times[number : number + 1])
        return Pose.from_quaternion(now.quaternions, now.positions[0])

    def first_row(self, number: int) -> int:
        """Give the row of the full frame that a frame's row 0 shows; the upper field is first."""
        return number % 2 if self.sensor.interlaced else 0

    @property
    def row_step(self) -> int:
        """Give the rows of the full frame from one row of a frame to the next."""
        return 2 if self.sensor.interlaced else 1

    def as_field(self, picture: np.ndarray, number: int) -> np.ndarray:
        """Give the rows of a full picture that a frame shows."""
        return picture[self.first_row(number) :: self.row_step]
