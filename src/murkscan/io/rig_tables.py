"""The tables of rig.toml, and the rig that they mean."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveFloat
from pydantic import PositiveInt as Count

from ..errors import InputError
from ..types.arrays import Vector
from ..types.camera import Camera
from ..types.laser import Axis, Fan, Laser
from ..types.plane import Plane
from ..types.port import DomePort, FlatPort, Layer, Port
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from ..types.water import Water
from .navigation_table import NavigationTable

_Positive = Annotated[PositiveFloat, Field(allow_inf_nan=False)]
_NotNegative = Annotated[FiniteFloat, Field(ge=0)]
_Index = Annotated[FiniteFloat, Field(ge=1, le=4)]
_Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _FlatPortTable(_Table):
    kind: Literal["flat"]
    normal: _Vector
    distance_mm: FiniteFloat
    thickness_mm: _NotNegative
    glass_index: _Index

    def as_port(self, key: str, origin: Vector) -> Port:
        layer = Layer(self.thickness_mm / 1e3, self.glass_index)
        normal = _unit(self.normal, f"{key}.normal")
        with _named(f"{key}.distance_mm"):
            return FlatPort(normal, self.distance_mm / 1e3, (layer,))


class _LayerTable(_Table):
    thickness_mm: _NotNegative
    index: _Index


class _LayersPortTable(_Table):
    kind: Literal["layers"]
    normal: _Vector
    distance_mm: FiniteFloat
    layer: Annotated[list[_LayerTable], Field(min_length=1)]

    def as_port(self, key: str, origin: Vector) -> Port:
        layers = tuple(Layer(layer.thickness_mm / 1e3, layer.index) for layer in self.layer)
        normal = _unit(self.normal, f"{key}.normal")
        with _named(f"{key}.distance_mm"):
            return FlatPort(normal, self.distance_mm / 1e3, layers)


class _DomePortTable(_Table):
    kind: Literal["dome"]
    radius_mm: _Positive
    thickness_mm: _NotNegative
    glass_index: _Index
    centre_mm: _Vector

    def as_port(self, key: str, origin: Vector) -> Port:
        centre = np.array(self.centre_mm, float) / 1e3 - origin
        with _named(f"{key}.centre_mm"):
            return DomePort(centre, self.radius_mm / 1e3, self.thickness_mm / 1e3, self.glass_index)


_PortTable = Annotated[
    _FlatPortTable | _LayersPortTable | _DomePortTable, Field(discriminator="kind")
]


class _CameraTable(_Table):
    size: tuple[Count, Count]
    focal_length: tuple[_Positive, _Positive]
    principal_point: tuple[FiniteFloat, FiniteFloat]
    distortion: tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat] = (
        0, 0, 0, 0, 0,
    )  # fmt: skip
    port: _PortTable | None = None

    def as_camera(self) -> Camera:
        port = None if self.port is None else self.port.as_port("camera.port", np.zeros(3))
        with _named("camera.port.normal"):
            return Camera(
                self.size,
                self.focal_length,
                self.principal_point,
                np.array(self.distortion, float),
                port,
            )


class _BaselineAngleTable(_Table):
    kind: Literal["baseline_angle"]
    baseline_mm: FiniteFloat
    angle_deg: FiniteFloat
    axis: Axis

    def as_laser(self, key: str) -> Laser:
        with _named(key):
            return Laser.from_baseline_angle(
                self.baseline_mm / 1e3, math.radians(self.angle_deg), self.axis
            )


class _PlaneTable(_Table):
    kind: Literal["plane"]
    normal: _Vector
    distance_mm: FiniteFloat
    axis: Axis | None = None

    def as_laser(self, key: str) -> Laser:
        sheet = Plane(_unit(self.normal, f"{key}.normal"), self.distance_mm / 1e3)
        laser = Laser.from_sheet(sheet)
        return laser if self.axis is None else Laser(sheet, self.axis)


class _FanTable(_Table):
    kind: Literal["fan"]
    origin_mm: _Vector
    direction: _Vector
    tangent: _Vector
    half_angle_deg: FiniteFloat
    axis: Axis | None = None
    port: _PortTable | None = None

    def as_laser(self, key: str) -> Laser:
        origin = np.array(self.origin_mm, float) / 1e3
        port = None if self.port is None else self.port.as_port(f"{key}.port", origin)
        direction = _unit(self.direction, f"{key}.direction")
        tangent = _unit(self.tangent, f"{key}.tangent")
        with _named(key):
            fan = Fan.spread(origin, direction, tangent, math.radians(self.half_angle_deg), port)
        laser = Laser.from_sheet(fan)
        return laser if self.axis is None else Laser(fan, self.axis)


class _WaterTable(_Table):
    temperature_c: Annotated[FiniteFloat, Field(ge=-2, le=40)] | None = None
    salinity_psu: Annotated[FiniteFloat, Field(ge=0, le=45)] | None = None
    depth_m: Annotated[FiniteFloat, Field(ge=0, le=11_000)] | None = None
    index: Annotated[FiniteFloat, Field(ge=1, le=2)] | None = None

    def as_water(self) -> Water:
        state = {"temperature_c", "salinity_psu", "depth_m"} & self.model_fields_set
        if self.index is not None:
            if state:
                raise InputError(
                    f"water.index is given together with {', '.join(sorted(state))}; keep the "
                    "index if it was measured, and otherwise the others."
                )
            return Water(index=self.index)
        for key in ("temperature_c", "salinity_psu"):
            if key not in state:
                raise InputError(f"the key water.{key} is missing; add it, or give water.index.")
        assert self.temperature_c is not None
        assert self.salinity_psu is not None
        return Water(self.temperature_c, self.salinity_psu, self.depth_m or 0.0)


class _MountTable(_Table):
    translation_mm: _Vector = (0, 0, 0)
    quaternion_wxyz: tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat] = (1, 0, 0, 0)

    def as_pose(self) -> Pose:
        if not 0.5 <= np.linalg.norm(self.quaternion_wxyz) <= 2:
            raise InputError("mount.quaternion_wxyz has a length that is not 1.")
        return Pose.from_quaternion(
            np.array([self.quaternion_wxyz], float), np.array(self.translation_mm, float) / 1e3
        )


_LaserTable = Annotated[_BaselineAngleTable | _PlaneTable | _FanTable, Field(discriminator="kind")]


class _CovarianceTable(_Table):
    parameters: list[str]
    units: list[str] = []
    matrix: list[list[FiniteFloat]]
    of: dict[str, str] | None = None
    water: dict[str, Any] | str | None = None

    def as_covariance(self) -> RigCovariance:
        count = len(self.parameters)
        if [len(row) for row in self.matrix] != [count] * count:
            raise InputError(
                f"calibration.covariance.matrix must have {count} rows and columns, one a "
                "parameter; run `murkscan calibrate` again, or take [calibration.covariance] out."
            )
        with _named("calibration.covariance"):
            matrix = np.array(self.matrix, float).reshape(count, count)
            return RigCovariance(tuple(self.parameters), matrix)


class _CalibrationTable(BaseModel):
    model_config = ConfigDict(extra="allow")

    covariance: _CovarianceTable | None = None


class RigTable(_Table):
    """All of rig.toml."""

    format: Literal[1]
    wavelength_nm: Annotated[float, Field(ge=350, le=1100)] = 532
    camera: _CameraTable
    laser: list[_LaserTable] = []
    water: _WaterTable | None = None
    mount: _MountTable | None = None
    navigation: NavigationTable | None = None
    calibration: _CalibrationTable = _CalibrationTable()

    def as_rig(self) -> Rig:
        """Give the rig.

        Raises:
            InputError: Values that do not go together; the message names the key.
        """
        covariance = self.calibration.covariance
        return Rig(
            camera=self.camera.as_camera(),
            lasers=tuple(
                laser.as_laser(f"laser.{number}") for number, laser in enumerate(self.laser)
            ),
            wavelength=self.wavelength_nm / 1e9,
            water=None if self.water is None else self.water.as_water(),
            vehicle_from_camera=None if self.mount is None else self.mount.as_pose(),
            navigation=None if self.navigation is None else self.navigation.as_accuracy(),
            covariance=RigCovariance() if covariance is None else covariance.as_covariance(),
        )


@contextmanager
def _named(key: str) -> Iterator[None]:
    """Put the key before what is wrong with its value."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{key}: {error}") from error


def _unit(vector: tuple[float, float, float], key: str) -> Vector:
    """Give the vector at length 1; one that has it to rounding stays as it is."""
    length = math.hypot(*vector)
    if length == 0:
        raise InputError(f"{key} has length 0.")
    return np.array(vector, float) / (1.0 if abs(length - 1) < 1e-12 else length)
