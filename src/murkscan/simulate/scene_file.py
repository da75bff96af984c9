"""scene.toml: what to simulate. Some scenes ship with the package, by name."""

import re
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from pydantic import ValidationError

from ..errors import FormatError, InputError
from ..io.acceptance_toml import load_acceptance
from ..io.poses import load_poses
from ..io.rig_toml import as_tables, parse_rig, read_tables
from ..io.toml_files import parse_toml
from ..io.validation import explain
from ..types.arrays import Scalars
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .choices import SHAPES
from .scene import Scene
from .scene_tables import MotionTable, ObjectTable, SceneTable
from .vehicle import drive

_FOLDER = Path(str(resources.files(__package__))) / "scenes"
_NAME = re.compile(r"(?P<object>[a-z-]+?)(?:-c(?P<murk>\d+(?:\.\d+)?))?(?P<rig>-hd)?")
_LADDER = {3.0: 200.0, 4.0: 100.0, 5.0: 50.0, 6.0: 24.0}
"""Grey level that the stripe still reaches in water that murky: a lamp of fixed power runs out."""
_SNOW = 15.0
"""Particles in a frame for an attenuation of 1 per metre."""


def list_scenes() -> dict[str, str]:
    """Give the names of the scenes that ship with the package, and what each is.

    To a name may be added `-c3`, for murky water of that beam attenuation per metre, and `-hd`, for
    the machine-vision rig: `hull-c3-hd`; the chessboards and their cameras have no -hd.
    """
    lines = {
        file.stem: file.read_text("utf-8").partition("\n")[0] for file in _FOLDER.glob("*.toml")
    }
    return {name: lines[name].lstrip("# ") for name in sorted(lines)}


def load_scene(source: Path | str) -> Scene:
    """Read a scene file, or a scene of the package by its name.

    Raises:
        FormatError: The file is missing or no TOML, or a key is unknown, missing or out of range;
            the message names the file and the key.
        InputError: Values that do not go together; the message names the key.
    """
    return parse_scene(*read_scene(source))


def read_scene(source: Path | str) -> tuple[str, str, Path]:
    """Give the text of a scene, what errors call it, and the folder its files are looked for in.

    Raises:
        FormatError: There is no such file, and no scene of that name.
    """
    path, name = Path(source), _NAME.fullmatch(str(source))
    try:
        if not path.is_file() and name and (_FOLDER / f"{name['object']}.toml").is_file():
            text = (_FOLDER / f"{name['object']}.toml").read_text("utf-8")
            return _vary(text, name["murk"], name["rig"]), f"the scene {source}", _FOLDER
        return path.read_text("utf-8-sig"), str(path), path.parent
    except (OSError, UnicodeDecodeError) as error:
        raise FormatError(
            f"There is no scene {source}: give a scene file, or a name that "
            "`murkscan simulate --list` shows."
        ) from error


def _vary(text: str, murk: str | None, rig: str | None) -> str:
    """Give a scene of the package other water, or the other rig."""
    document = tomlkit.parse(text)
    if murk is not None:
        attenuation = float(murk)
        grey = [_LADDER[c] for c in sorted(_LADDER) if c <= max(attenuation, 3.0)][-1]
        water = {"attenuation_per_m": attenuation, "particles_per_frame": _SNOW * attenuation}
        document.setdefault("water", tomlkit.table()).update(water)
        document["sensor"]["peak_grey"] = grey
    if rig is not None:
        if "file" not in document["rig"]:
            raise InputError("A scene with a rig of its own, such as chessboard, has no -hd.")
        document["rig"]["file"] = "rigs/machine-vision.toml"
        for key in ("interlaced", "composite_px", "psf_px"):
            document["sensor"].pop(key, None)
    return tomlkit.dumps(document)


def as_standalone(text: str, rig: Rig, folder: Path) -> str:
    """Give a scene's text such that it can be run from any folder.

    Args:
        text: TOML.
        rig: Its rig, whose tables take the place of a file.
        folder: Where the files that it names lie.
    """
    document = tomlkit.parse(text)
    document["rig"] = as_tables(rig)
    for table, key in ((document["motion"], "poses"), (document, "acceptance")):
        if key in table:
            table[key] = str((folder / table[key]).resolve())
    bodies = document.get("object", [])
    for body in [bodies] if isinstance(bodies, dict) else bodies:
        if body["mesh"] not in SHAPES:
            body["mesh"] = str((folder / body["mesh"]).resolve())
    return tomlkit.dumps(document)


def parse_scene(text: str, name: str, folder: Path) -> Scene:
    """Make a scene of a scene file's text.

    Args:
        text: TOML.
        name: What errors call it.
        folder: Where the files that it names are looked for.

    Raises:
        FormatError: As for `load_scene`.
        InputError: As for `load_scene`.
    """
    tables = parse_toml(text, name).unwrap()
    try:
        return _as_scene(SceneTable.model_validate(tables), name, folder)
    except ValidationError as error:
        raise FormatError(f"{name}: {explain(error)}") from error
    except InputError as error:
        raise FormatError(f"{name}: {error}") from error


def _as_scene(table: SceneTable, name: str, folder: Path) -> Scene:
    single = isinstance(table.object, ObjectTable)
    objects = [table.object] if isinstance(table.object, ObjectTable) else table.object
    rig = _as_rig(table, name, folder)
    sensor = table.sensor.as_sensor()
    times, trajectory = _as_motion(table.motion, rig, folder, sensor.interlaced, table.seed)
    return Scene(
        bodies=tuple(
            body.as_body("object" if single else f"object.{number}", table.surface, folder)
            for number, body in enumerate(objects)
        ),
        rig=rig,
        trajectory=trajectory,
        times=times,
        medium=table.water.as_medium(),
        light=table.light.as_light(),
        sensor=sensor,
        particles=table.water.as_particles(),
        window=table.window.as_window(),
        processing=table.sensor.as_processing(),
        overlay=table.overlay.as_overlay(),
        recorder=table.sensor.as_recorder(),
        glow=table.water.glow,
        forward_scattering=table.water.forward_scattering,
        navigation=None
        if table.motion.navigation is None
        else table.motion.navigation.as_navigation(),
        seed=table.seed,
        acceptance="" if table.acceptance is None else _read_acceptance(folder / table.acceptance),
    )


def _read_acceptance(path: Path) -> str:
    """Read what is known of the artefacts, and refuse what `murkscan accept` would."""
    load_acceptance(path)
    return path.read_text("utf-8-sig")


def _as_rig(table: SceneTable, name: str, folder: Path) -> Rig:
    """Read the rig from its file or its tables; what [water] says goes before its own."""
    tables: dict[str, Any] = dict(table.rig)
    if "file" in tables:
        others = [key for key in tables if key != "file"]
        if others:
            raise InputError(f"rig.{others[0]} is given beside rig.file; keep one of them.")
        path = folder / str(tables["file"])
        if not path.is_file():
            raise InputError(f"rig.file: there is no file {path}.")
        tables, name = read_tables(path), str(path)
    else:
        tables.setdefault("format", 1)
        name = f"{name}, [rig]"
    rig = parse_rig(tables, name=name)
    water = table.water.as_water()
    return rig if water is None else replace(rig, water=water)


def _as_motion(
    motion: MotionTable, rig: Rig, folder: Path, interlaced: bool, seed: int
) -> tuple[Scalars, Trajectory]:
    """Give the times of the frames, of the fields where interlaced, and the way of the camera."""
    if motion.poses is not None:
        return _follow_log(motion, rig, folder, interlaced)
    if motion.speed_mm_s is None or motion.frames is None:
        raise InputError("motion needs frames and speed_mm_s, or poses.")
    times = _times(motion.frames, motion.frame_rate_hz, interlaced)
    along = motion.along or (rig.lasers[0].axis if rig.lasers else "x")
    velocity = np.eye(3)["xyz".index(along)] * motion.speed_mm_s / 1e3
    start = np.array(motion.start_mm) / 1e3
    way = drive(motion.vehicle.as_unrest(), velocity, start, float(times[-1]), seed=seed)
    return times, way


def _follow_log(
    motion: MotionTable, rig: Rig, folder: Path, interlaced: bool
) -> tuple[Scalars, Trajectory]:
    """Go where a pose log says: at its own times, or from its start at the frame rate."""
    if motion.navigation is not None and motion.navigation.latency_ms:
        raise InputError(
            "motion.navigation.latency_ms goes with motion.speed_mm_s: a log that is stamped late "
            "would not cover a recording that begins and ends with motion.poses."
        )
    for key in ("speed_mm_s", "along"):
        if getattr(motion, key) is not None:
            raise InputError(f"motion.{key} is given beside motion.poses; keep one of them.")
    log = load_poses(folder / str(motion.poses))
    if rig.vehicle_from_camera is not None:
        log = log.follow_mount(rig.vehicle_from_camera)
    if motion.frames is None:
        if interlaced:
            raise InputError("motion.frames is missing: fields lie between the poses of the log.")
        return log.times, log
    times = log.times[0] + _times(motion.frames, motion.frame_rate_hz, interlaced)
    if times[-1] > log.times[-1]:
        raise InputError(
            f"motion.frames: {motion.frames} frames take until {times[-1]:.3f} s, but "
            f"motion.poses ends at {log.times[-1]:.3f} s; record fewer frames or lengthen the log."
        )
    return times, log


def _times(frames: int, rate: float, interlaced: bool) -> Scalars:
    """Give when each frame is exposed, or each of its two fields."""
    return np.arange(2 * frames) / (2 * rate) if interlaced else np.arange(frames) / rate
