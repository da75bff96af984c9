"""Write a simulated recording, its rig, its poses and its truth."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..distribute import Threads
from ..errors import InputError
from ..io.images import write_image
from ..io.mesh_files import save_mesh
from ..io.navigation_writing import save_navigation
from ..io.parquet import writing_true_stripes
from ..io.poses import save_poses
from ..io.rig_toml import save_rig
from ..io.text import save_text
from ..io.times_csv import write_times
from ..io.video import writing_video
from ..project import (
    SIMULATE,
    Key,
    Project,
    SimulateResult,
    Stage,
    StageFiles,
    describe,
    digest,
    read_record,
    record_of,
)
from ..simulate import Scene, SimulatedFrame, Simulator, as_colour, log_navigation
from ..simulate.instruments import Instruments, measure_way
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .progress import Progress, silent
from .stage_runner import run_stage

_FASTEST = 500.0
"""Pictures a second that a video's times can tell apart."""
_PART = 64
"""Frames whose truth is written at once."""

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
    scene: Scene,
    out: Path,
    *,
    text: str | None = None,
    command: Sequence[str] = (),
    progress: Progress = silent,
) -> SimulatedRecording:
    """Write frames/ or recording.mkv, rig.toml, poses.csv, and truth/.

    acceptance.toml says what is known of the scene's artefacts, where it has some. poses.csv holds
    the true poses at the frames' own times, of the vehicle where the rig has a mount;
    navigation.csv what the vehicle's log says, where the scene has one; of instruments rig.toml
    states how good they are.

    A simulation that is done with the same scene is skipped; one that was stopped is made anew.

    Args:
        scene: What is recorded, by which rig, along which way.
        out: The folder: a new one, or that of an earlier simulation, finished or not.
        text: The scene file's text, to be kept with the truth.
        command: The words that were typed after `murkscan`, for the record.
        progress: Told of each frame.

    Raises:
        InputError: The sheet never meets the object, the folder holds other files, or another run
            is at work in it.
        DeviceError: The disk is full.
    """
    _require_ours(out)
    settings = {"scene": digest(describe(scene)), "text": digest(text)}
    stage = Stage(out, SIMULATE, Key(SIMULATE.meaning, settings), tuple(command))
    # What is refused is refused before anything is written.
    simulator = None if stage.result() is not None else Simulator.of(scene)

    def make(_: None) -> SimulateResult:
        ready = simulator or Simulator.of(scene)
        with closing(Threads().map(ready.draw_frame, range(len(scene)))) as drawn:
            return _write(scene, drawn, StageFiles(out), text, progress)

    project = Project(out, stage.command)
    made = run_stage(project, stage, make, prepare=lambda: None, progress=progress)
    return SimulatedRecording(out / made.recording, made.pictures, made.frames, made.centres)


def _write(
    scene: Scene,
    drawn: Iterator[SimulatedFrame],
    files: StageFiles,
    text: str | None,
    progress: Progress,
) -> SimulateResult:
    centres = 0
    _write_rig_and_trajectory(scene, files)
    with (
        _keeping(scene, files) as (recording, keep),
        files.making("truth/stripes.parquet") as path,
        writing_true_stripes(path) as tell,
    ):
        stripes, fields, kept = [], [], None
        for one in drawn:
            fields.append(one.frame.image)
            if len(fields) == scene.row_step:
                first = one.frame.index + 1 - scene.row_step
                kept = scene.recorder.smooth(_weave(scene, fields), kept, scene.sensor.white)
                keep(kept, float(scene.times[first]))
                fields.clear()
            stripes.append(one.stripe)
            centres += len(one.stripe)
            if len(stripes) == _PART or one.frame.index + 1 == len(scene):
                tell(one.stripe.concatenate(stripes))
                stripes.clear()
            progress("simulate", one.frame.index + 1, len(scene))
    if scene.bodies:
        with files.making("truth/mesh.ply") as path:
            save_mesh(path, scene.surroundings.mesh)
    if text is not None:
        with files.making("truth/scene.toml") as path:
            save_text(path, text)
    return SimulateResult(recording, len(scene) // scene.row_step, len(scene), centres)


def _require_ours(out: Path) -> None:
    """Refuse a folder whose rig, poses or pictures are somebody's own."""
    others = [file for file in sorted(out.glob("*")) if not file.name.startswith(".")]
    if out.is_file() or (others and read_record(record_of(out)) is None):
        raise InputError(
            f"{others[0] if others else out} is not of a simulation; give a new folder for the "
            "recording."
        )


def _write_rig_and_trajectory(scene: Scene, files: StageFiles) -> None:
    with files.making("rig.toml") as path:
        save_rig(path, _as_stated(scene))
    if scene.acceptance:
        with files.making("acceptance.toml") as path:
            save_text(path, scene.acceptance)
    with files.making("poses.csv") as path:
        save_poses(path, _as_logged(scene, scene.trajectory.at(scene.times)))
    if scene.navigation is not None:
        trajectory = _as_logged(scene, scene.trajectory)
        with files.making("navigation.csv") as path:
            if isinstance(scene.navigation, Instruments):
                measured = measure_way(scene.navigation, trajectory, seed=scene.seed)
                save_navigation(path, measured)
            else:
                save_poses(path, log_navigation(scene.navigation, trajectory, seed=scene.seed))


def _as_stated(scene: Scene) -> Rig:
    """Give the rig with what its vehicle's instruments are stated to be good to."""
    if not isinstance(scene.navigation, Instruments):
        return scene.rig
    return replace(scene.rig, navigation=scene.navigation.accuracy)


def _as_logged(scene: Scene, trajectory: Trajectory) -> Trajectory:
    """Give poses of the vehicle, which is what logs hold, where the camera sits on one."""
    mount = scene.rig.vehicle_from_camera
    return trajectory if mount is None else trajectory.follow_mount(mount.inverse())


@contextmanager
def _keeping(scene: Scene, files: StageFiles) -> Iterator[tuple[str, Keep]]:
    """Keep pictures as the scene's recorder does; gives the name of what it makes, too."""
    recorder, pictures = scene.recorder, scene.times[:: scene.row_step]
    if recorder.codec != "png":
        rate = 1 / float(np.median(np.diff(pictures))) if len(pictures) > 1 else 25.0
        if rate > _FASTEST:
            raise InputError(
                f"sensor.codec {recorder.codec}: times in milliseconds are too coarse for "
                f"motion.frame_rate_hz {rate:g}; keep the pictures as png."
            )
        with (
            files.making("recording.mkv") as path,
            writing_video(
                path,
                scene.rig.camera.size,
                rate=rate,
                codec=recorder.codec,
                crf=recorder.crf,
                bitrate=recorder.bitrate,
                quality=recorder.quality,
                streamed=recorder.streamed,
                interlaced=scene.sensor.interlaced,
                is_colour=scene.sensor.colour != "mono",
            ) as write,
        ):
            yield "recording.mkv", write
        return
    times = dict[str, float]()

    def keep(picture: np.ndarray, time: float) -> None:
        name = f"{len(times):06d}.png"
        with files.making(f"frames/{name}") as path:
            write_image(path, picture)
        times[name] = time

    yield "frames", keep
    with files.making("frames/times.csv") as path:
        write_times(path, times)


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
