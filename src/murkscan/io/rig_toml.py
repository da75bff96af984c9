"""rig.toml: what the instrument is. Users write it by hand, `calibrate` writes into it."""

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import tomlkit
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveFloat, ValidationError
from pydantic import PositiveInt as Count

from ..errors import FormatError, InputError
from ..types.camera import Camera
from ..types.laser import Axis, Laser
from ..types.plane import Plane
from ..types.pose import Pose
from ..types.rig import Rig
from .atomic import replacing
from .validation import explain

_Positive = Annotated[PositiveFloat, Field(allow_inf_nan=False)]
_Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _CameraTable(_Table):
    size: tuple[Count, Count]
    focal_length: tuple[_Positive, _Positive]
    principal_point: tuple[FiniteFloat, FiniteFloat]
    distortion: tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat] = (
        0, 0, 0, 0, 0,
    )  # fmt: skip

    def as_camera(self) -> Camera:
        return Camera(
            self.size, self.focal_length, self.principal_point, np.array(self.distortion, float)
        )


class _BaselineAngleTable(_Table):
    kind: Literal["baseline_angle"]
    baseline_mm: FiniteFloat
    angle_deg: FiniteFloat
    axis: Axis

    def as_laser(self) -> Laser:
        return Laser.from_baseline_angle(
            self.baseline_mm / 1e3, math.radians(self.angle_deg), self.axis
        )


class _PlaneTable(_Table):
    kind: Literal["plane"]
    normal: _Vector
    distance_mm: FiniteFloat
    axis: Axis | None = None

    def as_laser(self) -> Laser:
        length = np.linalg.norm(self.normal)
        if length == 0:
            raise InputError("The normal of a laser's plane has length 0.")
        sheet = Plane(np.array(self.normal, float) / length, self.distance_mm / 1e3)
        laser = Laser.from_sheet(sheet)
        return laser if self.axis is None else Laser(sheet, self.axis)


class _MountTable(_Table):
    translation_mm: _Vector = (0, 0, 0)
    quaternion_wxyz: tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat] = (1, 0, 0, 0)

    def as_pose(self) -> Pose:
        if not any(self.quaternion_wxyz):
            raise InputError("The quaternion of the mount is zero.")
        return Pose.from_quaternion(
            np.array([self.quaternion_wxyz], float), np.array(self.translation_mm, float) / 1e3
        )


class _RigTable(_Table):
    format: Literal[1]
    wavelength_nm: Annotated[float, Field(ge=350, le=1100)] = 532
    camera: _CameraTable
    laser: list[Annotated[_BaselineAngleTable | _PlaneTable, Field(discriminator="kind")]] = []
    mount: _MountTable | None = None
    calibration: dict[str, Any] = {}

    def as_rig(self) -> Rig:
        return Rig(
            camera=self.camera.as_camera(),
            lasers=tuple(laser.as_laser() for laser in self.laser),
            wavelength=self.wavelength_nm / 1e9,
            vehicle_from_camera=None if self.mount is None else self.mount.as_pose(),
        )


def load_rig(path: Path) -> Rig:
    """Read a rig file.

    Raises:
        FormatError: The file is missing or no TOML, a key is unknown, missing or out of range; the
            message names the file and the key.
    """
    return parse_rig(_read(path).unwrap(), name=str(path))


def parse_rig(tables: dict[str, Any], *, name: str) -> Rig:
    """Make a rig of the tables of a rig file; `name` is what an error calls them.

    Raises:
        FormatError: A key is unknown, missing or out of range; the message names the key.
    """
    try:
        return _RigTable.model_validate(tables).as_rig()
    except ValidationError as error:
        raise FormatError(f"{name}: {explain(error)}") from error
    except InputError as error:
        raise FormatError(f"{name}: {error}") from error


def as_tables(rig: Rig) -> dict[str, Any]:
    """Give a rig as the tables of a rig file; `parse_rig` inverts it."""
    tables: dict[str, Any] = {
        "format": 1,
        "wavelength_nm": round(rig.wavelength * 1e9, 3),
        "camera": _camera_table(rig.camera),
        "laser": [_laser_table(laser) for laser in rig.lasers],
    }
    if rig.vehicle_from_camera is not None:
        tables["mount"] = {
            "translation_mm": (rig.vehicle_from_camera.translation * 1e3).tolist(),
            "quaternion_wxyz": rig.vehicle_from_camera.as_quaternion()[0].tolist(),
        }
    return tables


def save_rig(path: Path, rig: Rig) -> None:
    """Write a new rig file.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    _write(path, tomlkit.parse(tomlkit.dumps(as_tables(rig))))


def save_camera(path: Path, camera: Camera, *, wavelength: float, record: dict[str, Any]) -> None:
    """Create or replace [camera]; all else of the file, comments too, stays.

    Args:
        path: The rig file; made where it is missing.
        camera: The new camera.
        wavelength: Written only where the file is new or has none [m].
        record: What [calibration.camera] shall say: date, views, residuals.

    Raises:
        FormatError: The file is there but is no rig file.
    """
    document = _read(path) if path.exists() else tomlkit.parse("format = 1\n")
    document.setdefault("wavelength_nm", round(wavelength * 1e9, 3))
    document.setdefault("camera", tomlkit.table()).update(_camera_table(camera))
    document.setdefault("calibration", tomlkit.table(True))["camera"] = record
    _write(path, document)


def save_laser(path: Path, laser: Laser, number: int, *, record: dict[str, Any]) -> None:
    """Replace laser `number`, or add it as the next one; all else of the file stays.

    Args:
        path: The rig file.
        laser: The new laser.
        number: Its number, at most the count of those that are there.
        record: What [calibration.laser.N] shall say: date, views, residuals.

    Raises:
        FormatError: The file is no rig file.
        InputError: The number leaves a gap.
    """
    document = _read(path)
    lasers = document.setdefault("laser", tomlkit.aot())
    if number > len(lasers):
        raise InputError(
            f"{path} has {len(lasers)} lasers, so the next one is --laser {len(lasers)}, "
            f"not {number}."
        )
    table = tomlkit.table()
    table.update(_laser_table(laser))
    table.add(tomlkit.nl())
    if number == len(lasers):
        lasers.append(table)
    else:
        lasers[number] = table
    of_lasers = document.setdefault("calibration", tomlkit.table(True)).setdefault(
        "laser", tomlkit.table(True)
    )
    of_lasers[str(number)] = record
    _write(path, document)


def _camera_table(camera: Camera) -> dict[str, Any]:
    return {
        "size": list(camera.size),
        "focal_length": _rounded(camera.focal_length, 9),
        "principal_point": _rounded(camera.principal_point, 9),
        "distortion": _rounded(camera.distortion, 12),
    }


def _laser_table(laser: Laser) -> dict[str, Any]:
    return {
        "kind": "plane",
        "normal": laser.sheet.normal.tolist(),
        "distance_mm": laser.sheet.distance * 1e3,
        "axis": laser.axis,
    }


def _read(path: Path) -> tomlkit.TOMLDocument:
    try:
        return tomlkit.parse(path.read_text("utf-8"))
    except FileNotFoundError as error:
        raise FormatError(f"There is no rig file {path}; give one with --rig.") from error
    except (tomlkit.exceptions.ParseError, UnicodeDecodeError, IsADirectoryError) as error:
        raise FormatError(f"{path} is not a TOML file: {error}.") from error


def _write(path: Path, document: tomlkit.TOMLDocument) -> None:
    text = tomlkit.dumps(document)
    parse_rig(tomlkit.parse(text).unwrap(), name=str(path))
    with replacing(path) as aside:
        aside.write_text(text, "utf-8")


def _rounded(numbers: Any, digits: int) -> list[float]:
    return [round(float(number), digits) for number in numbers]
