"""A dive: record it, show it while it goes on, and scan it when it is over."""

import math
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
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
from .extract import check_recording
from .live_finder import STALE, LiveFinder
from .live_settings import LiveSettings
from .live_source import LiveSource, RecordedSource, ReplayedSource
from .live_stage import TICK, LiveStage, ScanTeller, Tell
from .progress import Progress, silent
from .scan import scan

_TURN = 5e-4
"""Longest turn of a thread while another one waits [s]."""


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
    rig.laser(settings.laser)
    project = Project(out, tuple(command))
    project.check_writable()
    recording = _open(source, rig, settings.fields)
    dive = _Dive(
        source, recording, rig, settings, project, DiveFolder(out / "capture"),
        LiveFolder(out / "live"),
    )  # fmt: skip
    with project.hold():
        if not dive.is_over():
            with settings.beside(), _switching_soon():
                dive.go_on(tell, until)
        return dive.scan(rig_file, executor, progress)


@dataclass(frozen=True)
class _Dive:
    """What is recorded or replayed, how, and the folders for it."""

    source: str
    recording: AbstractRecording | None
    """What is replayed; None for a stream or a camera, which is recorded."""
    rig: Rig
    settings: LiveSettings
    project: Project
    folder: DiveFolder
    show: LiveFolder

    def is_over(self) -> bool:
        """Tell whether it was over when the command ran last; a new one begins with no preview."""
        record = self.folder.record
        if record is None:
            self.show.clear()
            return False
        if record.source != self.source:
            raise InputError(
                f"{self.project.root} holds a dive that was recorded from {record.source}; give "
                "another folder with --out, or the same source to go on with it."
            )
        return record.ended

    def go_on(self, tell: Tell, until: Callable[[], bool]) -> None:
        """Record or replay, and show it, until it ends."""
        pictures, finder = self._pictures(), self._finder()
        receiving = threading.Thread(target=pictures.run, args=(finder,), daemon=True)
        finding = threading.Thread(target=finder.run, daemon=True)
        stage = LiveStage(
            self.source, pictures, finder, show=self.show, folder=self.folder, rig=self.rig,
            settings=self.settings, tell=tell,
        )  # fmt: skip
        receiving.start()
        finding.start()
        _play(stage, until)
        finder.frames.close()
        finding.join()
        stage.finish()
        if pictures.failure is not None:
            failed = replace(_last_status(self.show), state="failed", message=str(pictures.failure))
            with suppress(MurkscanError):  # the disk may be full
                self.show.save_status(failed)
            raise pictures.failure
        self.folder.save(replace(self._record(), ended=True))

    def scan(
        self, rig_file: Path | None, executor: AbstractExecutor | None, progress: Progress
    ) -> Project:
        """Learn from the whole recording, and scan it."""
        status = _last_status(self.show)
        scanning = replace(status, state="scanning", message="Scanning the recording.")
        teller = ScanTeller(self.show, scanning)

        def both(stage: str, done: int, total: int | None) -> None:
            teller(stage, done, total)
            progress(stage, done, total)

        made = scan(
            self._recorded(),
            self.rig,
            self.settings.move(self._record().began),
            out=self.project.root,
            extractor=self.settings.extractor,
            method=self.settings.method,
            lasers=self.settings.lasers,
            spacing=self.settings.spacing,
            rig_file=rig_file,
            command=self.project.command,
            executor=executor,
            progress=both,
        )
        done = replace(teller.status, state="done", message="The dive is scanned.", scan=None)
        self.show.save_status(done)
        return made

    def _record(self) -> DiveRecord:
        return self.folder.record or DiveRecord(self.source, 0.0)

    def _recorded(self) -> AbstractRecording:
        """Give the whole recording: what was replayed, or all chapters that were written."""
        if self.recording is not None:
            return self.recording
        chapters = self.folder.chapters
        if not chapters:
            raise MissingResult(
                f"{self.folder.root} holds no recording; run the same command again."
            )
        return open_recording(chapters, wavelength=self.rig.wavelength, fields=self.settings.fields)

    def _pictures(self) -> LiveSource:
        if self.recording is not None:
            return ReplayedSource(self.recording)
        settings = self.settings
        return RecordedSource(
            self.source, self.folder, self.rig, fields=settings.fields, timeout=settings.timeout,
            patience=settings.patience,
        )  # fmt: skip

    def _finder(self) -> LiveFinder:
        settings = self.settings
        return LiveFinder(
            self.rig, settings.extractor, settings.method, laser=settings.laser,
            learner=settings.learner,
            stale=STALE if self.recording is None else math.inf,
        )  # fmt: skip


@contextmanager
def _switching_soon() -> Iterator[None]:
    """Let threads take turns quickly.

    The finding leaves Python's lock some twenty times a frame; where a thread that draws had it for
    the usual 5 ms each time, a frame would take longer than it lasts.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(_TURN)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


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
    check_recording(recording, rig)
    return recording


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


def _last_status(show: LiveFolder) -> LiveStatus:
    try:
        return show.load_status()
    except MurkscanError:
        return LiveStatus()
