"""A dive: record it, show it while it goes on, and scan it when it is over."""

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ..capture import (
    AbstractRecording,
    DiveFolder,
    DiveRecord,
    check_source,
    is_camera,
    is_stream,
    open_recording,
)
from ..capture.field_order import Fields
from ..distribute import AbstractExecutor
from ..errors import InputError, MissingResult, MurkscanError
from ..live import LiveFolder, LiveStatus
from ..project import Project
from ..types.rig import Rig
from .live_finder import LiveFinder
from .live_settings import LiveSettings
from .live_source import LiveSource, RecordedSource, ReplayedSource
from .live_stage import TICK, LiveStage, ScanTeller, Tell
from .progress import Progress, silent
from .scan import scan


def run_live(
    source: str,
    rig: Rig,
    settings: LiveSettings,
    *,
    out: Path,
    rig_file: Path | None = None,
    command: Sequence[str] = (),
    executor: AbstractExecutor | None = None,
    tell: Tell = lambda status: None,
    progress: Progress = silent,
    until: Callable[[], bool] = lambda: False,
) -> Project:
    """Record a stream into OUT/capture, show it in OUT/live, and scan it into OUT when it ends.

    The preview is no part of the scan. A dive that was broken off goes on where it was, as a new
    chapter; one that was over is scanned to its end. An interrupt ends the dive, not the job.

    Args:
        source: What `record_dive` takes, or a recording, which is replayed at its own speed.
        rig: The calibrated rig.
        settings: How it is recorded, shown and scanned.
        out: The folder for everything.
        rig_file: The file of the rig, for what the report says of its calibration.
        command: The words that were typed after `murkscan`.
        executor: Who scans; threads unless given.
        tell: Told the status several times a second while the dive goes on.
        progress: Told how far the scan is.
        until: Asked several times a second whether the dive shall end.

    Returns:
        The project of the scan.

    Raises:
        InputError: The source is none, the folder holds other things, or it is another dive's.
        StreamLost: No picture has come at all.
        DeviceError: The disk is full; what is recorded is kept.
    """
    project, dive = Project(out, tuple(command)), DiveFolder(out / "capture")
    rig.laser(settings.laser)
    project.check_writable()
    recording = _open(source, rig, settings.fields)
    with project.hold():
        show = LiveFolder(out / "live")
        record = dive.record
        if record is not None and record.source != source:
            raise InputError(
                f"{out} holds a dive that was recorded from {record.source}; give another folder "
                "with --out, or the same source to go on with it."
            )
        if record is None:
            show.clear()
        if record is None or not record.ended:
            with settings.beside():
                _dive(source, recording, rig, settings, dive, show, tell, until)
        return _scan(
            source, recording, rig, settings, project, dive, show,
            rig_file=rig_file, executor=executor, progress=progress,
        )  # fmt: skip


def _open(source: str, rig: Rig, fields: Fields) -> AbstractRecording | None:
    """Open a recording that shall be replayed; None for a stream or a camera."""
    path = Path(source)
    if is_stream(source) or is_camera(source) or not path.exists():
        check_source(source)
        return None
    recording = open_recording(path, wavelength=rig.wavelength, fields=fields)
    if not recording.is_timed:
        raise InputError(
            f"{path} has no times, so that its own speed is not known; add a times.csv, or scan it "
            "with `murkscan scan` and --fps."
        )
    return recording


def _dive(
    source: str,
    recording: AbstractRecording | None,
    rig: Rig,
    settings: LiveSettings,
    folder: DiveFolder,
    show: LiveFolder,
    tell: Tell,
    until: Callable[[], bool],
) -> None:
    """Record or replay, and show it, until it ends."""
    pictures: LiveSource = (
        RecordedSource(
            source,
            folder,
            rig,
            fields=settings.fields,
            timeout=settings.timeout,
            patience=settings.patience,
        )
        if recording is None
        else ReplayedSource(recording)
    )
    finder = LiveFinder(
        rig, settings.extractor, settings.method, laser=settings.laser, learner=settings.learner
    )
    threads = [
        threading.Thread(target=pictures.run, args=(finder,), daemon=True),
        threading.Thread(target=finder.run, daemon=True),
    ]
    stage = LiveStage(
        source,
        pictures,
        finder,
        show=show,
        folder=folder,
        rig=rig,
        settings=settings,
        tell=tell,
    )
    for thread in threads:
        thread.start()
    _play(stage, until)
    finder.frames.close()
    threads[1].join()
    stage.finish()
    if pictures.failure is not None:
        failed = replace(_last_status(show), state="failed", message=str(pictures.failure))
        with suppress(MurkscanError):  # the disk may be full
            show.save_status(failed)
        raise pictures.failure
    folder.save(replace(folder.record or DiveRecord(source, 0.0), ended=True))


def _play(stage: LiveStage, until: Callable[[], bool]) -> None:
    """Show the dive, tick by tick, until its pictures end, or somebody ends it.

    A thread cannot be waited for here: one whose `join` an interrupt breaks counts as ended.
    """
    while not stage.pictures.is_over.is_set():
        try:
            stage.tick()
            if until():
                stage.pictures.stop()
            stage.pictures.is_over.wait(TICK)
        except KeyboardInterrupt:
            # Stopping by hand is how a dive ends; what follows is the scan.
            stage.pictures.stop()


def _scan(
    source: str,
    recording: AbstractRecording | None,
    rig: Rig,
    settings: LiveSettings,
    project: Project,
    folder: DiveFolder,
    show: LiveFolder,
    *,
    rig_file: Path | None,
    executor: AbstractExecutor | None,
    progress: Progress,
) -> Project:
    """Learn from the whole recording, and scan it."""
    record = folder.record or DiveRecord(source, 0.0)
    status = _last_status(show)
    teller = ScanTeller(show, replace(status, state="scanning", message="Scanning the recording."))
    if recording is None:
        if not folder.chapters:
            raise MissingResult(f"{folder.root} holds no recording; run the same command again.")
        recording = open_recording(
            folder.chapters, wavelength=rig.wavelength, fields=settings.fields
        )

    def both(stage: str, done: int, total: int | None) -> None:
        teller(stage, done, total)
        progress(stage, done, total)

    made = scan(
        recording,
        rig,
        settings.move(record.began),
        out=project.root,
        extractor=settings.extractor,
        method=settings.method,
        lasers=settings.lasers,
        spacing=settings.spacing,
        rig_file=rig_file,
        command=project.command,
        executor=executor,
        progress=both,
    )
    show.save_status(
        replace(teller.status, state="done", message="The dive is scanned.", scan=None)
    )
    return made


def _last_status(show: LiveFolder) -> LiveStatus:
    try:
        return show.load_status()
    except MurkscanError:
        return LiveStatus()
