"""Damaged and hostile files: small sound ones of every kind that is read, changed at random.

A mutant is a number: the same number is the same file. `python -m tests.mutants FOLDER FIRST END`
reads those from FIRST to END - 1 and says of each, in a line of JSON, how that ended.
"""

import inspect
import json
import random
import shutil
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import numpy as np

from murkscan import ConstantStep, GrayGravity, open_recording, scan, simulate
from murkscan.errors import MurkscanError
from murkscan.io.cloud_files import iterate_cloud_file, writing_cloud_file
from murkscan.io.images import write_image
from murkscan.io.mesh_files import load_mesh, save_mesh
from murkscan.io.navigation_log import read_navigation_log
from murkscan.io.poses import load_poses, save_poses
from murkscan.io.rig_toml import load_rig
from murkscan.project import Project
from murkscan.simulate import load_scene
from murkscan.simulate.scene_file import read_scene
from murkscan.types.cloud import PointCloud
from murkscan.types.mesh import Mesh
from murkscan.types.trajectory import Trajectory

from .memory import peak_kib

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))
import dive_files

SIZE = (96, 64)
CODECS = {
    "grey.mkv": ("ffv1", "gray"),
    "h264.mp4": ("libx264", "yuv420p"),
    "h264.avi": ("libx264", "yuv420p"),
    "h264.ts": ("libx264", "yuv420p"),
    "mpeg4.avi": ("mpeg4", "yuv420p"),
    "mjpeg.mov": ("mjpeg", "yuvj420p"),
    "hevc.mkv": ("libx265", "yuv420p"),
}
RIG = """
format = 1
wavelength_nm = 532

[camera]
size = [96, 64]
focal_length = [90.0, 90.0]
principal_point = [47.5, 31.5]
distortion = [0.0, 0.0, 0.0, 0.0, 0.0]

[camera.port]
kind = "flat"
normal = [0.0, 0.0, 1.0]
distance_mm = 30.0
thickness_mm = 8.0
glass_index = 1.49

[[laser]]
kind = "plane"
normal = [0.0, 0.9, -0.4358898943540674]
distance_mm = 200.0

[water]
temperature_c = 20.0
salinity_psu = 35.0

[mount]
translation_mm = [0.0, 0.0, 0.0]
quaternion_wxyz = [1.0, 0.0, 0.0, 0.0]
"""
NUMBERS = [b"nan", b"inf", b"-inf", b"1e300", b"-1", b"0", b"1e-300", b"99999999999", b"77", b'"x"']


def make_seeds(folder: Path) -> None:
    """Write one small sound file of every kind, each in a folder with what belongs to it."""
    pictures = [_picture(k) for k in range(8)]
    for name, (codec, form) in CODECS.items():
        _write_video(folder / "video" / name, pictures, codec, form)
    for suffix in ("png", "tif", "jpg", "bmp", "webp", "pgm", "jp2"):
        for number, picture in enumerate(pictures[:2]):
            write_image(folder / f"folder-{suffix}" / f"{number}.{suffix}", picture)
    times = folder / "folder-png" / "times.csv"
    times.write_text("file,time_s\n0.png,0.0\n1.png,0.04\n")
    for suffix in ("ply", "las", "laz", "e57", "xyz", "csv"):
        path = folder / "cloud" / f"cloud.{suffix}"
        path.parent.mkdir(exist_ok=True)
        with writing_cloud_file(path) as write:
            write(_cloud())
    for suffix in ("ply", "stl", "obj", "glb"):
        save_mesh(folder / "mesh" / f"mesh.{suffix}", _mesh())
    (folder / "rig").mkdir()
    (folder / "rig" / "rig.toml").write_text(RIG)
    (folder / "scene").mkdir()
    (folder / "scene" / "scene.toml").write_text(read_scene("hull")[0])
    shutil.copytree(Path(simulate.__file__).parent / "scenes" / "rigs", folder / "scene" / "rigs")
    _write_logs(folder / "poses")
    _write_dives(folder, pictures)
    stairs = folder / "recording"
    for number in range(8):
        write_image(stairs / f"{number}.png", _picture(number))
    scan(
        open_recording(stairs, fps=25.0),
        load_rig(folder / "rig" / "rig.toml"),
        ConstantStep(0.002, "y"),
        out=folder / "project",
        extractor=GrayGravity(),
    )


def read(kind: str, path: Path) -> object:
    """Read a file, or the folder it lies in, as a user's command would."""
    if kind in ("video", "dive"):
        return _read_recording(path)
    if kind == "navigation":
        return read_navigation_log(path)
    if kind.startswith("folder"):
        return _read_recording(path.parent)
    if kind == "cloud":
        return sum(int(block.is_sound().sum()) for block in iterate_cloud_file(path))
    if kind == "project":
        return _read_project(path)
    readers: dict[str, Callable[[Path], object]] = {
        "mesh": load_mesh,
        "rig": load_rig,
        "scene": load_scene,
        "poses": load_poses,
    }
    return readers[kind](path)


def _write_dives(folder: Path, pictures: list[np.ndarray]) -> None:
    times = np.arange(0, 0.4, 0.04)
    way = Trajectory(times, np.zeros((10, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (10, 1)))
    dive = dive_files.Dive(dive_files.encode_h264(pictures, 25.0), times[: len(pictures)], way)
    (folder / "dive").mkdir()
    (folder / "navigation").mkdir()
    dive_files.write_blueos(folder / "dive" / "dive.mcap", dive, chunk_size=2000)
    dive_files.write_ros1(folder / "dive" / "dive.bag", dive, pictures)
    dive_files.write_ros2(folder / "dive" / "ros2", dive, "sqlite3")
    dive_files.write_tlog(folder / "navigation" / "dive.tlog", dive)
    dive_files.write_csv(folder / "navigation" / "dive.csv", dive)


def _read_recording(path: Path) -> object:
    recording = open_recording(path)
    recording.fingerprint()
    recording.sample(3)
    return [frame.time for frame in recording.frames()]


def _read_project(path: Path) -> object:
    """Load all that a scan's folder holds, as the stages and the report do."""
    root = next(one for one in path.parents if (one / "scan.json").exists())
    project = Project(root)
    errors = []
    for name in sorted(vars(Project)):
        method = getattr(project, name)
        if name.startswith("load_") and not inspect.signature(method).parameters:
            try:
                found = method()
                list(found) if isinstance(found, Iterator) else found
            except MurkscanError as error:
                errors.append(str(error))
    return errors


def seeds_of(folder: Path) -> list[tuple[str, Path]]:
    """List the files that are changed, with their kind."""
    found = []
    for path in sorted(folder.rglob("*")):
        kind = path.relative_to(folder).parts[0]
        skipped = kind == "recording" or "rigs" in path.parts or path.suffix in (".html", ".yaml")
        if path.is_file() and not skipped and (kind != "project" or path.suffix != ".png"):
            found.append((kind, path))
    return found


def mutate(data: bytes, chance: random.Random) -> bytes:
    """Change a file in one to four ways."""
    for _ in range(chance.randint(1, 4)):
        if not data:
            break
        data = chance.choice(_WAYS)(data, chance)
    return data


def _flip(data: bytes, chance: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(chance.randint(1, 8)):
        changed[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(changed)


def _flip_head(data: bytes, chance: random.Random) -> bytes:
    changed = bytearray(data)
    changed[chance.randrange(min(len(data), 400))] = chance.choice((0, 1, 0x7F, 0x80, 0xFF))
    return bytes(changed)


def _cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data))]


def _drop(data: bytes, chance: random.Random) -> bytes:
    start = chance.randrange(len(data))
    return data[:start] + data[start + chance.randint(1, 64) :]


def _repeat(data: bytes, chance: random.Random) -> bytes:
    start = chance.randrange(len(data))
    end = min(start + chance.randint(1, 200), len(data))
    return data[:end] + data[start:end] * chance.randint(1, 3) + data[end:]


def _number(data: bytes, chance: random.Random) -> bytes:
    """Put a large, small or odd number of 2, 4 or 8 bytes somewhere."""
    width = chance.choice((2, 4, 8))
    value = chance.choice((0, 1, -1, 2**15, 2**31 - 1, 2**31, 2**62, 1000, 65536))
    start = chance.randrange(len(data))
    order = chance.choice(("little", "big"))
    word = (value % 2 ** (8 * width)).to_bytes(width, order)  # type: ignore[arg-type]
    return data[:start] + word + data[start + width :]


def _word(data: bytes, chance: random.Random) -> bytes:
    """Replace a number in a text by an odd one."""
    import re

    words = list(re.finditer(rb"(?<![\w.])-?\d[\d.]*(?![\w.])", data[:20000]))
    if not words:
        return _flip(data, chance)
    one = chance.choice(words)
    return data[: one.start()] + chance.choice(NUMBERS) + data[one.end() :]


def _line(data: bytes, chance: random.Random) -> bytes:
    """Repeat, drop or exchange a line."""
    lines = data.splitlines(keepends=True)
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    match chance.randrange(3):
        case 0:
            lines.insert(at, lines[other])
        case 1:
            del lines[at]
        case _:
            lines[at], lines[other] = lines[other], lines[at]
    return b"".join(lines)


_WAYS = (_flip, _flip_head, _flip_head, _cut, _drop, _repeat, _number, _word, _word, _line)


def run_mutants(folder: Path, numbers: range) -> Iterator[dict[str, object]]:
    """Read mutants and say of each how it ended; before each, its number alone."""
    seeds = seeds_of(folder / "seeds")
    for number in numbers:
        kind, path = seeds[number % len(seeds)]
        name = str(path.relative_to(folder / "seeds"))
        yield {"number": number, "seed": name}
        target = folder / "mutants" / str(number)
        shutil.copytree(folder / "seeds" / kind, target / kind)
        file = target / path.relative_to(folder / "seeds")
        file.write_bytes(mutate(path.read_bytes(), random.Random(number)))
        outcome, said = _try(kind, file)
        peak = peak_kib() / 1024
        yield {"number": number, "seed": name, "outcome": outcome, "said": said, "peak_mib": peak}
        if outcome in ("read", "refused"):
            shutil.rmtree(target)


def _try(kind: str, file: Path) -> tuple[str, str]:
    try:
        read(kind, file)
    except MurkscanError as error:
        return "refused", str(error)[:200]
    except Exception:
        return "traceback", traceback.format_exc()[-1500:]
    return "read", ""


def _picture(number: int) -> np.ndarray:
    rows = np.arange(SIZE[1])[:, None] - (24 + number)
    noise = np.random.default_rng(number).normal(0, 2, (SIZE[1], SIZE[0]))
    line = 160 * np.exp(-0.5 * (rows / 1.5) ** 2)
    return np.clip(20 + line + noise, 0, 255).astype(np.uint8)


def _write_video(path: Path, pictures: list[np.ndarray], codec: str, form: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=25)
        stream.width, stream.height, stream.pix_fmt = *SIZE, form
        if codec == "libx265":
            stream.codec_context.options = {"x265-params": "log-level=none"}
        for picture in pictures:
            frame = av.VideoFrame.from_ndarray(picture, "gray").reformat(format=form)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


def _cloud() -> PointCloud:
    chance = np.random.default_rng(0)
    normals = np.tile(np.array([0, 0, -1], np.float32), (30, 1))
    ratio, number = np.ones(30, np.float32), np.arange(30, dtype=np.int32)
    small = number.astype(np.uint8)
    return PointCloud(
        chance.normal(size=(30, 3)), normals, *[ratio] * 4, number, number, small, small
    )


def _mesh() -> Mesh:
    vertices = np.random.default_rng(0).normal(size=(12, 3))
    return Mesh(vertices, np.array([[k, k + 1, k + 2] for k in range(10)]))


def _write_logs(folder: Path) -> None:
    times = np.arange(20) / 10
    places = np.stack([times * 0.1, np.zeros(20), np.zeros(20)], axis=1)
    log = Trajectory(times, places, np.tile([1.0, 0.0, 0.0, 0.0], (20, 1)))
    save_poses(folder / "poses.csv", log)
    rows = np.concatenate([times[:, None], places, np.tile([0.0, 0, 0, 1], (20, 1))], axis=1)
    np.savetxt(folder / "tum.txt", rows, fmt="%.4f")
    header = "timestamp,northing [m],easting [m],depth [m],roll [deg],pitch [deg],heading [deg]"
    np.savetxt(folder / "nav.csv", rows[:, :7], fmt="%.4f", delimiter=",", header=header)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for line in run_mutants(Path(sys.argv[1]), range(int(sys.argv[2]), int(sys.argv[3]))):
        print(json.dumps(line), flush=True)
