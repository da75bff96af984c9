"""The tables of scene.toml: keys with their units on one side, values in SI on the other."""

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, FiniteFloat
from scipy.spatial.transform import Rotation

from ..errors import InputError
from ..io.mesh_files import load_mesh
from ..optics.medium import Medium
from ..optics.phase import AbstractPhase
from ..optics.phase_fournier_forand import FournierForand
from ..optics.phase_henyey_greenstein import HenyeyGreenstein
from ..optics.phase_petzold import PetzoldHarbour
from ..optics.turbidity import medium_of
from ..types.mesh import Mesh
from ..types.navigation import NavigationAccuracy
from ..types.pose import Pose
from ..types.water import Water
from .camera_tables import LightTable, OverlayTable, SensorTable, WindowTable
from .choices import SHAPES, TEXTURES, make_choice
from .instruments import Instruments
from .particles import Particles
from .surface import Body
from .table import OpenTable, Table
from .textures import AbstractTexture
from .vehicle import Navigation, Unrest

_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254}
_STATE = {"temperature_c", "salinity_psu", "depth_m", "index"}

_Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class SurfaceTable(OpenTable):
    """[surface] for all objects, [object.surface] for one."""

    texture: str = "plain"
    gloss: FiniteFloat = 0.0
    translucency_mm: FiniteFloat = 0.0

    def as_texture(self, key: str) -> AbstractTexture:
        """Give the texture, with its settings."""
        made: AbstractTexture = make_choice(TEXTURES, self.texture, self.settings, f"{key}.texture")
        return made


class ObjectTable(OpenTable):
    """[object], or several [[object]]."""

    mesh: str
    unit: Literal["m", "cm", "mm", "in"] = "m"
    position_mm: _Vector = (0.0, 0.0, 0.0)
    rotation_deg: _Vector = (0.0, 0.0, 0.0)
    surface: SurfaceTable | None = None

    def as_body(self, key: str, surface: SurfaceTable, folder: Path) -> Body:
        """Give the object with its surface; `folder` is where a mesh file is looked for.

        Raises:
            InputError: The mesh is no built-in shape and no file, or a setting is out of range.
            FormatError: The mesh file cannot be read.
        """
        own = self.surface or surface
        turn = Rotation.from_euler("xyz", self.rotation_deg, degrees=True).as_matrix()
        pose = Pose(turn, np.array(self.position_mm) / 1e3)
        where = "surface" if self.surface is None else f"{key}.surface"
        texture = own.as_texture(where)
        mesh = self._as_mesh(key, folder)
        return Body(mesh, pose, texture, own.gloss, own.translucency_mm / 1e3)

    def _as_mesh(self, key: str, folder: Path) -> Mesh:
        if self.mesh in SHAPES:
            if "unit" in self.model_fields_set:
                raise InputError(f"{key}.unit is for meshes from files; {self.mesh} is in mm.")
            return make_choice(SHAPES, self.mesh, self.settings, f"{key}.mesh").mesh()
        path = folder / self.mesh
        if not path.is_file():
            raise InputError(
                f"{key}.mesh: {self.mesh!r} is neither a file in {folder} nor one of "
                f"{', '.join(SHAPES)}."
            )
        if self.settings:
            raise InputError(f"{key}.{next(iter(self.settings))} is no key of a mesh from a file.")
        mesh = load_mesh(path)
        return Mesh(mesh.vertices * _UNITS[self.unit], mesh.faces)


class WaterTable(Table):
    """[water]."""

    temperature_c: FiniteFloat | None = None
    salinity_psu: FiniteFloat | None = None
    depth_m: FiniteFloat | None = None
    index: FiniteFloat | None = None
    type: str | None = None
    attenuation_per_m: FiniteFloat | None = None
    single_scattering_albedo: FiniteFloat | None = None
    phase: Literal["petzold-harbour", "fournier-forand", "henyey-greenstein"] = "petzold-harbour"
    mean_cosine: FiniteFloat | None = None
    particles_per_frame: FiniteFloat = 0.0
    particle_diameter_mm: FiniteFloat = 0.4
    particle_albedo: FiniteFloat = 0.4
    drift_mm_s: _Vector = (3.0, 5.0, 0.0)
    glow: bool = True
    forward_scattering: bool = True

    def as_water(self) -> Water | None:
        """Give what bends the light; None where the table does not say."""
        if self.index is not None:
            others = sorted((_STATE - {"index"}) & self.model_fields_set)
            if others:
                raise InputError(
                    f"water.{others[0]} is given beside water.index; keep one of them."
                )
            return Water(index=self.index)
        if not _STATE & self.model_fields_set:
            return None
        return Water(
            20.0 if self.temperature_c is None else self.temperature_c,
            35.0 if self.salinity_psu is None else self.salinity_psu,
            self.depth_m or 0.0,
        )

    def as_medium(self) -> Medium | None:
        """Give what attenuates and scatters it; None for clear water."""
        if self.type is not None:
            if {"attenuation_per_m", "single_scattering_albedo"} & self.model_fields_set:
                raise InputError(
                    "water.type says how the water attenuates; remove water.attenuation_per_m and "
                    "water.single_scattering_albedo, or the type."
                )
            return medium_of(self.type, self._as_phase())
        if self.mean_cosine is not None and self.phase != "henyey-greenstein":
            raise InputError(
                "water.mean_cosine goes with water.phase henyey-greenstein; remove it."
            )
        if not self.attenuation_per_m:
            if self.single_scattering_albedo is not None:
                raise InputError("water.single_scattering_albedo needs water.attenuation_per_m.")
            return None
        if self.attenuation_per_m < 0:
            raise InputError(
                f"water.attenuation_per_m must not be below 0, got {self.attenuation_per_m:g}."
            )
        albedo = self.single_scattering_albedo
        return Medium(self.attenuation_per_m, 0.83 if albedo is None else albedo, self._as_phase())

    def as_particles(self) -> Particles:
        """Give the marine snow."""
        x, y, z = self.drift_mm_s
        return Particles(
            self.particles_per_frame,
            self.particle_diameter_mm / 1e3,
            self.particle_albedo,
            (x / 1e3, y / 1e3, z / 1e3),
        )

    def _as_phase(self) -> AbstractPhase:
        if self.phase == "henyey-greenstein":
            return HenyeyGreenstein(0.9 if self.mean_cosine is None else self.mean_cosine)
        return FournierForand() if self.phase == "fournier-forand" else PetzoldHarbour()


class VehicleTable(Table):
    """[motion.vehicle]: how the vehicle departs from its straight way, 1σ."""

    speed_percent: FiniteFloat = 0.0
    sway_mm: FiniteFloat = 0.0
    heave_mm: FiniteFloat = 0.0
    attitude_deg: FiniteFloat = 0.0
    period_s: FiniteFloat = 6.0

    def as_unrest(self) -> Unrest:
        """Give the departure."""
        return Unrest(
            self.speed_percent / 100,
            self.sway_mm / 1e3,
            self.heave_mm / 1e3,
            math.radians(self.attitude_deg),
            self.period_s,
        )


class NavigationTable(Table):
    """[motion.navigation]: what the vehicle's own log says."""

    kind: Literal["poses", "dvl", "ahrs"] = "poses"
    rate_hz: FiniteFloat = 10.0
    position_noise_mm: FiniteFloat = 0.0
    attitude_noise_deg: FiniteFloat = 0.0
    attitude_bias_deg: FiniteFloat = 0.0
    heading_drift_deg_min: FiniteFloat = 0.0
    depth_noise_mm: FiniteFloat = 0.0
    velocity_noise_mm_s: FiniteFloat = 0.0
    velocity_bias_mm_s: FiniteFloat = 0.0
    latency_ms: FiniteFloat = 0.0

    def as_navigation(self) -> Navigation | Instruments:
        """Give the log's qualities.

        Raises:
            InputError: They go with another kind of log.
        """
        others = ("attitude_bias_deg", "heading_drift_deg_min", "depth_noise_mm",
                  "velocity_noise_mm_s", "velocity_bias_mm_s")  # fmt: skip
        wrong = others if self.kind == "poses" else ("position_noise_mm",)
        wrong = (*wrong, *others[3:]) if self.kind == "ahrs" else wrong
        for key in wrong:
            if getattr(self, key):
                raise InputError(f"motion.navigation.{key} does not go with kind {self.kind!r}.")
        if self.kind != "poses":
            return self._as_instruments(self.kind)
        return Navigation(
            self.rate_hz,
            self.position_noise_mm / 1e3,
            math.radians(self.attitude_noise_deg),
            self.latency_ms / 1e3,
        )

    def _as_instruments(self, kind: Literal["dvl", "ahrs"]) -> Instruments:
        return Instruments(
            kind,
            self.rate_hz,
            self.latency_ms / 1e3,
            NavigationAccuracy(
                velocity_noise=self.velocity_noise_mm_s / 1e3 or None,
                velocity_bias=self.velocity_bias_mm_s / 1e3,
                attitude_noise=math.radians(self.attitude_noise_deg) or None,
                attitude_bias=math.radians(self.attitude_bias_deg),
                heading_drift=math.radians(self.heading_drift_deg_min) / 60,
                depth_noise=self.depth_noise_mm / 1e3 or None,
            ),
        )


class MotionTable(Table):
    """[motion]."""

    frames: Annotated[int, Field(ge=1, le=10_000_000)] | None = None
    frame_rate_hz: Annotated[FiniteFloat, Field(gt=0, le=1e5)] = 25.0
    speed_mm_s: FiniteFloat | None = None
    along: Literal["x", "y", "z"] | None = None
    start_mm: _Vector = (0.0, 0.0, 0.0)
    poses: str | None = None
    vehicle: VehicleTable = VehicleTable()
    navigation: NavigationTable | None = None


class SceneTable(Table):
    """All of scene.toml."""

    format: Literal[1]
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    acceptance: str | None = None
    object: ObjectTable | list[ObjectTable] = Field(default_factory=list)
    surface: SurfaceTable = SurfaceTable()
    water: WaterTable = WaterTable()
    rig: dict[str, Any]
    light: LightTable = LightTable()
    window: WindowTable = WindowTable()
    sensor: SensorTable = SensorTable()
    overlay: OverlayTable = OverlayTable()
    motion: MotionTable
