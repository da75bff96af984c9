"""rig.toml: what the instrument is. Users write it by hand, `calibrate` writes into it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit
from pydantic import ValidationError
from tomlkit.items import AoT

from ..errors import FormatError, InputError
from ..types.laser import Laser
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .atomic import replacing
from .rig_as_tables import as_tables as as_tables
from .rig_as_tables import camera_table, covariance_table, laser_table, mount_table, water_table
from .rig_stale import drop_stale, fingerprints, water_of
from .rig_tables import RigTable
from .toml_files import parse_toml
from .validation import explain


def load_rig(path: Path | str) -> Rig:
    """Read a rig file.

    Raises:
        FormatError: The file is missing or no TOML, a key is unknown, missing or out of range; the
            message names the file and the key.
    """
    return parse_rig(read_tables(Path(path)), name=str(path))


def read_tables(path: Path) -> dict[str, Any]:
    """Read the tables of a rig file that may not be complete yet.

    Raises:
        FormatError: The file is missing or no TOML.
    """
    return _read(path).unwrap()


def parse_rig(tables: dict[str, Any], *, name: str) -> Rig:
    """Make a rig of the tables of a rig file; `name` is what an error calls them.

    Raises:
        FormatError: A key is unknown, missing or out of range; the message names the key.
    """
    try:
        table = RigTable.model_validate(tables)
        covariance = table.calibration.covariance
        if covariance is None:
            return table.as_rig()
        return drop_stale(table.as_rig(), of=covariance.of, water=covariance.water)
    except ValidationError as error:
        raise FormatError(f"{name}: {explain(error)}") from error
    except InputError as error:
        raise FormatError(f"{name}: {error}") from error


def save_rig(path: Path | str, rig: Rig) -> None:
    """Write a new rig file.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    tables = as_tables(rig)
    calibration = tables.pop("calibration", None)
    document = tomlkit.parse(tomlkit.dumps(tables))
    if calibration is not None:
        _put_covariance(document, rig.covariance)
    _write(Path(path), document)


def save_calibration(
    path: Path,
    rig: Rig,
    step: Sequence[str],
    *,
    record: dict[str, Any],
    lasers: Mapping[int, Laser] | None = None,
    keep_water: bool = True,
) -> None:
    """Write what a calibration found: [camera], some lasers and the covariance.

    All else of the file stays, comments too.

    Args:
        path: The rig file; made where it is missing.
        rig: The rig with its covariance.
        step: Where in [calibration] the record goes, such as ("laser", "0").
        record: What it shall say: date, views, residuals.
        lasers: Lasers that are new or have changed, by number.
        keep_water: Whether [water] stays as it is.

    Raises:
        FormatError: The file is there but is no rig file.
        InputError: The number of a laser leaves a gap.
    """
    document = _read(path) if path.exists() else tomlkit.parse("format = 1\n")
    document.setdefault("wavelength_nm", round(rig.wavelength * 1e9, 3))
    _update(document.setdefault("camera", tomlkit.table()), camera_table(rig.camera))
    for number, laser in sorted((lasers or {}).items()):
        _put_laser(document, laser_table(laser), number, path)
    if not keep_water and rig.water is not None:
        document["water"] = water_table(rig.water)
    if rig.vehicle_from_camera is not None and "mount.turn[0]" in rig.covariance.names:
        # A mount was found with this camera, so it moves along where the camera does.
        document.setdefault("mount", tomlkit.table()).update(mount_table(rig.vehicle_from_camera))
    _put_covariance(document, rig.covariance)
    table = document["calibration"]
    for word in step[:-1]:
        table = table.setdefault(word, tomlkit.table(True))
    table[step[-1]] = _lay_out(record)
    _write(path, document)


def put_tables(path: Path, top: Mapping[str, Any], tables: Mapping[str, Any]) -> None:
    """Put tables into a rig file; all else of it stays, comments too.

    Args:
        path: The rig file; made where it is missing.
        top: Keys above all tables.
        tables: [camera], whose port is replaced whole; the first [[laser]]; [water]; as they are
            written.

    Raises:
        FormatError: The file is there but is no rig file, or a value cannot be.
    """
    document = _read(path) if path.exists() else tomlkit.parse("format = 1\n")
    for key, value in top.items():
        document[key] = value
    camera = dict(tables.get("camera", {}))
    if "port" in camera and "camera" in document:
        document["camera"].pop("port", None)
    _update(document.setdefault("camera", tomlkit.table()), camera)
    if "laser" in tables:
        _put_laser(document, tables["laser"], 0, path)
    if "water" in tables:
        document["water"] = dict(tables["water"])
    _write(path, document)


def _update(table: Any, values: dict[str, Any]) -> None:
    """Put values into a table; tables within it are kept, with their comments."""
    for key, value in values.items():
        if isinstance(value, dict) and isinstance(table.get(key), dict):
            _update(table[key], value)
        else:
            table[key] = value


def _put_laser(
    document: tomlkit.TOMLDocument, laser: Mapping[str, Any], number: int, path: Path
) -> None:
    """Replace laser `number`, or add it as the next one."""
    lasers = document.get("laser")
    if not isinstance(lasers, AoT):
        # `laser = []`, or tables in one line, cannot be lengthened by a table of its own.
        inline = document.pop("laser", [])
        document["laser"] = tomlkit.aot()
        lasers = document["laser"]
        for old in inline:
            lasers.append(tomlkit.item(dict(old.unwrap())))
    if number > len(lasers):
        raise InputError(
            f"{path} has {len(lasers)} lasers, so the next one is --laser {len(lasers)}, "
            f"not {number}."
        )
    table = tomlkit.table()
    table.update(laser)
    table.add(tomlkit.nl())
    if number == len(lasers):
        lasers.append(table)
    else:
        lasers[number] = table


def _put_covariance(document: tomlkit.TOMLDocument, covariance: RigCovariance) -> None:
    """Replace the covariance; it says which rig and which water it belongs to."""
    calibration = document.setdefault("calibration", tomlkit.table(True))
    calibration.pop("covariance", None)
    rig = parse_rig(document.unwrap(), name="the new rig file")
    belongs = {"of": fingerprints(rig), "water": water_of(rig)}
    calibration["covariance"] = _lay_out(covariance_table(covariance) | belongs)


def _lay_out(record: dict[str, Any]) -> dict[str, Any]:
    """Put each row of a matrix on a line of its own."""
    laid_out = dict(record)
    for key, value in record.items():
        if isinstance(value, list) and value and isinstance(value[0], list):
            laid_out[key] = tomlkit.array().multiline(True)
            laid_out[key].extend(value)
    return laid_out


def _read(path: Path) -> tomlkit.TOMLDocument:
    try:
        return parse_toml(path.read_text("utf-8-sig"), str(path))
    except FileNotFoundError as error:
        raise FormatError(f"There is no rig file {path}; give one with --rig.") from error
    except (UnicodeDecodeError, OSError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise FormatError(f"{path} is not a TOML file: {why}.") from error


def _write(path: Path, document: tomlkit.TOMLDocument) -> None:
    text = tomlkit.dumps(document)
    parse_rig(tomlkit.parse(text).unwrap(), name=str(path))
    with replacing(path) as aside:
        aside.write_text(text, "utf-8")
