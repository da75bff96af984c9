"""A scan from the recording to the report: the stages in order."""

import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from ..capture import AbstractRecording
from ..cloud import OUTLIER_RULES, AbstractOutlierRule
from ..distribute import AbstractExecutor
from ..extract import AbstractExtractor, Murk
from ..extract.lasers import check_extractor
from ..io.rig_toml import as_tables
from ..mesh import AbstractMesher, GridMesh
from ..motion import AbstractMotion
from ..project import Project, RecordingRecord, ScanRecord, describe, is_merged, load_recording
from ..project.origin import read_calibration, when_written
from ..triangulate import AbstractTriangulation, RaySheet
from ..types.rig import Rig
from .cloud import build_cloud
from .extract import check_recording, extract_recording
from .mesh import build_mesh
from .motion import check_motion, follow_motion
from .progress import Progress, silent
from .triangulate import triangulate_stripes


def scan(
    recording: AbstractRecording,
    rig: Rig,
    motion: AbstractMotion,
    *,
    out: Path | str,
    extractor: AbstractExtractor | None = None,
    method: AbstractTriangulation | None = None,
    mesher: AbstractMesher | None = None,
    lasers: Sequence[int] = (),
    adjust: bool = True,
    rules: Sequence[AbstractOutlierRule] = OUTLIER_RULES,
    attenuation: float | None = None,
    frames: bool = False,
    spacing: float | None = None,
    rig_file: Path | None = None,
    command: Sequence[str] = (),
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> Project:
    """Turn a recording into a measured 3D model, and say how it went.

    A stage that is done with the same settings and inputs is skipped; one that was interrupted
    goes on at its first missing part.

    Args:
        recording: The pictures; see `open_recording`.
        rig: The calibrated rig that recorded them; see `load_rig`.
        motion: How the camera moved.
        out: The folder for everything that is made.
        extractor: The way to find the stripe; Murk unless given.
        method: The way from pixels to points; ray and sheet unless given.
        mesher: The way to make a surface; the scan's own grid unless given.
        lasers: Numbers of the lasers whose stripes are followed; all of the rig unless given.
        adjust: Whether the scan corrects a motion whose accuracy is stated, from what it saw twice.
        rules: The reasons to take a point out of the cloud.
        attenuation: Beam attenuation of the water [1/m], by which the points' reflectance is
            corrected; what the laser's glow tells unless given.
        frames: Whether to write one cloud a frame for more than 500 frames, too.
        spacing: Wanted spacing of the points [m]; the report judges gaps by the scan's own unless
            given.
        rig_file: The file of the rig, for what the report says of its calibration.
        command: The words that were typed after `murkscan`, for the report.
        executor: Who does the work; threads unless given. The result is the same.
        progress: Told how far each stage is.

    Returns:
        The project, from which each value can be loaded.

    Raises:
        InputError: The recording is not of this rig, or the motion says nothing about its times.
        FormatError: Nothing of the recording can be read.
        MissingDependency: The mesher needs an extra that is not installed.
        DeviceError: The disk is full; what is finished is kept.
    """
    extractor, method = extractor or Murk(), method or RaySheet()
    mesher = mesher or GridMesh()
    mesher.check_available()
    check_motion(recording, motion)
    check_recording(recording, rig, lasers)
    check_extractor(extractor, rig.choose_lasers(lasers))
    settings = {"extractor": extractor, "method": method, "motion": motion, "mesher": mesher}
    project = Project(Path(out), tuple(command))
    project.check_writable()
    with project.hold():
        begin_scan(project, recording, rig, lasers=lasers, settings=settings, rig_file=rig_file)
        extract_recording(
            project, recording, rig, extractor, lasers=lasers, executor=executor, progress=progress
        )
        triangulate_stripes(project, rig, method, executor=executor, progress=progress)
        follow_motion(project, motion, adjust=adjust, progress=progress)
        build_cloud(
            project, rig, rules=rules, attenuation=attenuation, frames=frames, executor=executor,
            progress=progress,
        )  # fmt: skip
        build_mesh(project, mesher, executor=executor, progress=progress)

        from .report import write_report  # loaded when due: the first stage need not wait for it
        from .view import draw_views

        draw_views(project, progress=progress)
        write_report(project, spacing=spacing, progress=progress)
    return project


def begin_scan(
    project: Project,
    recording: AbstractRecording,
    rig: Rig,
    *,
    lasers: Sequence[int] = (),
    settings: Mapping[str, object],
    rig_file: Path | None = None,
) -> None:
    """Write down what a project scans with what.

    Args:
        project: The project, of a new folder or of an earlier scan.
        recording: The pictures.
        rig: The rig that recorded them.
        lasers: Numbers of the lasers whose stripes are followed; all of the rig unless given.
        settings: The Choice of each kind that was made.
        rig_file: The file of the rig, for what the report says of its calibration.

    Raises:
        InputError: The folder holds other things or another run is at work in it, or the recording
            is not of this rig.
    """
    check_recording(recording, rig, lasers)
    project.check_writable()
    chosen = {name: describe(choice) for name, choice in settings.items()}
    record = ScanRecord(
        versions=_versions(),
        started=datetime.now(UTC),
        recording=RecordingRecord(
            path=str(recording.path),
            fingerprint=recording.fingerprint(),
            size=recording.size,
            is_timed=recording.is_timed,
            fields_per_picture=recording.fields_per_picture,
            written=when_written(recording.path),
        ),
        rig=as_tables(rig),
        command=tuple(project.command),
        rig_file="" if rig_file is None else str(rig_file),
        calibration=None if rig_file is None else read_calibration(rig_file),
        settings={"lasers": rig.choose_lasers(lasers), **chosen},
    )
    with project.hold():
        if is_merged(project):
            load_recording(project)  # says what to do
        project.save_scan(record)


def _versions() -> dict[str, str]:
    libraries = ("numpy", "scipy", "numba", "opencv-contrib-python-headless", "av", "pyarrow")
    return {
        "murkscan": version("murkscan"),
        "python": platform.python_version(),
        "platform": platform.platform(),
        **{name: version(name) for name in libraries},
    }
