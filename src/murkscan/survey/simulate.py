"""Write a simulated recording, its rig, its poses and its truth."""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..io.atomic import replacing
from ..io.images import write_image
from ..io.mesh_files import save_mesh
from ..io.parquet import writing_true_stripes
from ..io.poses import save_poses
from ..io.rig_toml import save_rig
from ..io.times_csv import write_times
from ..io.video import writing_video
from ..simulate import Scene, SimulatedFrame, Simulator, as_colour, log_navigation
from ..types.trajectory import Trajectory
from .progress import Progress, silent

_WORKERS = 2
"""Frames that are drawn at once: drawing waits for its own Python half of the time."""
_AHEAD = 4
"""Frames that may be ready before they are written: memory stays bounded."""
_FASTEST = 500.0
"""Pictures a second that a video's times can tell apart."""
_PART = 64
"""Frames whose truth is written at once."""
_MARK = "truth/README.txt"
"""The file that only simulations have, and have from the beginning."""
_NO_WORK = ("stage.json",)
"""What may lie in a new folder: the demo's note of what it simulates."""

Keep = Callable[[np.ndarray, float], None]
"""Keeps one picture and its time [s]."""


@dataclass(frozen=True)
class SimulatedRecording:
    """What was written."""

    recording: Path
    """The folder of pictures, or the video."""
    num_pictures: int
    """Pictures kept."""
    num_frames: int
    """Frames, fields counted."""
    num_centres: int
    """True centres."""


def simulate_recording(
    scene: Scene, out: Path, *, text: str | None = None, progress: Progress = silent
) -> SimulatedRecording:
    """Write frames/ or recording.mkv, rig.toml, poses.csv, and truth/.

    poses.csv holds the true poses at the frames' own times, of the vehicle where the rig has a
    mount; navigation.csv what the vehicle's log says, where the scene has one.

    Args:
        scene: What is recorded, by which rig, along which way.
        out: The folder: a new one, or that of an earlier simulation, finished or not, whose files
            are replaced.
        text: The scene file's text, to be kept with the truth.
        progress: Told of each frame.

    Raises:
        InputError: The sheet never meets the object, or the folder holds other files.
        DeviceError: The disk is full.
    """
    _require_ours(out)
    simulator = Simulator.of(scene)
    _clear(out)
    _write_rig_and_way(scene, out)
    centres = 0
    with (
        _keeping(scene, out) as (recording, keep),
        writing_true_stripes(out / "truth" / "stripes.parquet") as tell,
    ):
        stripes, fields, kept = [], [], None
        for frame in _draw_ahead(simulator):
            fields.append(frame.frame.image)
            if len(fields) == scene.row_step:
                first = frame.frame.index + 1 - scene.row_step
                kept = scene.recorder.smooth(_weave(scene, fields), kept, scene.sensor.white)
                keep(kept, float(scene.times[first]))
                fields.clear()
            stripes.append(frame.stripe)
            centres += len(frame.stripe)
            if len(stripes) == _PART or frame.frame.index + 1 == len(scene):
                tell(frame.stripe.concatenate(stripes))
                stripes.clear()
            progress("simulate", frame.frame.index + 1, len(scene))
    if scene.bodies:
        save_mesh(out / "truth" / "mesh.ply", scene.surroundings.mesh)
    if text is not None:
        with replacing(out / "truth" / "scene.toml") as aside:
            aside.write_text(text, "utf-8")
    return SimulatedRecording(recording, len(scene) // scene.row_step, len(scene), centres)


def _require_ours(out: Path) -> None:
    """Refuse a folder whose rig, poses or pictures are somebody's own."""
    others = [file for file in sorted(out.glob("*")) if file.name not in _NO_WORK]
    others = [file for file in others if not file.name.startswith(".")]
    if out.is_file() or (others and not (out / _MARK).is_file()):
        raise InputError(
            f"{others[0] if others else out} is not of a simulation; give a new folder for the "
            "recording."
        )


def _clear(out: Path) -> None:
    """Take away what an earlier simulation left, and mark the folder as one's before all else."""
    (out / _MARK).parent.mkdir(parents=True, exist_ok=True)
    with replacing(out / _MARK) as aside:
        aside.write_text("What is true of a recording that murkscan has simulated.\n", "utf-8")
    left = [
        out / "recording.mkv",
        out / "navigation.csv",
        out / "truth" / "mesh.ply",
        out / "frames" / "times.csv",
    ]
    left += (file for file in (out / "frames").glob("*.png") if file.stem.isdecimal())
    for path in left:
        path.unlink(missing_ok=True)


def _draw_ahead(simulator: Simulator) -> Iterator[SimulatedFrame]:
    """Draw the frames on several threads, and give them in order."""
    waiting: deque[Future[SimulatedFrame]] = deque()
    with ThreadPoolExecutor(_WORKERS) as pool:
        try:
            for number in range(len(simulator.scene)):
                waiting.append(pool.submit(simulator.draw_frame, number))
                if len(waiting) > _AHEAD:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def _write_rig_and_way(scene: Scene, out: Path) -> None:
    save_rig(out / "rig.toml", scene.rig)
    save_poses(out / "poses.csv", _as_logged(scene, scene.trajectory.at(scene.times)))
    if scene.navigation is not None:
        way = _as_logged(scene, scene.trajectory)
        save_poses(out / "navigation.csv", log_navigation(scene.navigation, way, seed=scene.seed))


def _as_logged(scene: Scene, way: Trajectory) -> Trajectory:
    """Give poses of the vehicle, which is what logs hold, where the camera sits on one."""
    mount = scene.rig.vehicle_from_camera
    return way if mount is None else way.follow_mount(mount.inverse())


@contextmanager
def _keeping(scene: Scene, out: Path) -> Iterator[tuple[Path, Keep]]:
    """Keep pictures as the scene's recorder does."""
    recorder, pictures = scene.recorder, scene.times[:: scene.row_step]
    if recorder.codec != "png":
        path = out / "recording.mkv"
        rate = 1 / float(np.median(np.diff(pictures))) if len(pictures) > 1 else 25.0
        if rate > _FASTEST:
            raise InputError(
                f"sensor.codec {recorder.codec}: times in milliseconds are too coarse for "
                f"motion.frame_rate_hz {rate:g}; keep the pictures as png."
            )
        with writing_video(
            path,
            scene.rig.camera.size,
            rate=rate,
            codec=recorder.codec,
            crf=recorder.crf,
            bitrate=recorder.bitrate,
            quality=recorder.quality,
            interlaced=scene.sensor.interlaced,
            is_colour=scene.sensor.colour != "mono",
        ) as write:
            yield path, write
        return
    folder, times = out / "frames", dict[str, float]()

    def keep(picture: np.ndarray, time: float) -> None:
        name = f"{len(times):06d}.png"
        write_image(folder / name, picture)
        times[name] = time

    yield folder, keep
    write_times(folder / "times.csv", times)


def _weave(scene: Scene, fields: list[np.ndarray]) -> np.ndarray:
    """Put the rows of two fields between each other, or fill in a mosaic's colours."""
    if scene.sensor.colour != "mono":
        return as_colour(fields[0], scene.sensor.colour)
    if len(fields) == 1:
        return fields[0]
    width, height = scene.rig.camera.size
    picture = np.empty((height, width), fields[0].dtype)
    for parity, field in enumerate(fields):
        picture[parity::2] = field
    return picture
