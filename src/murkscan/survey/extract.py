"""Find the stripes of all lasers in every frame, in chunks that can be resumed."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import tee

from ..capture import AbstractRecording
from ..capture.chunks import CHUNK, Chunk, Run, missing_runs, read_missing, read_run
from ..distribute import AbstractExecutor, Threads
from ..errors import InputError
from ..extract import AbstractExtractor, check_stripes, require_extractor
from ..extract.lasers import check_extractor, join_remarks
from ..extract.overlay import draw_stripe
from ..extract.overlay_choice import Candidates, choose_overlays, name_candidates
from ..project import EXTRACT, ExtractResult, PartNote, Project, describe
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .progress import Progress, silent
from .stage_runner import run_stage

_SAMPLES = 48
"""Frames that an extractor learns from."""


def extract_recording(
    project: Project,
    recording: AbstractRecording,
    rig: Rig,
    extractor: AbstractExtractor,
    *,
    lasers: Sequence[int] = (),
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> ExtractResult:
    """Run the extract stage; parts that are there already are kept.

    Args:
        project: Where the stripes go.
        recording: The pictures.
        rig: The rig that recorded them.
        extractor: The way to find the stripe.
        lasers: Numbers of the lasers whose stripes are looked for; of all unless given.
        executor: Who does it; threads unless given. The result is the same.
        progress: Told of each part.

    Raises:
        InputError: The recording is not of this rig, the extractor cannot tell its lasers apart,
            or gives, perhaps one's own, what cannot be.
        FormatError: Nothing of the recording can be read.
        DeviceError: The disk is full.
    """
    require_extractor(extractor)
    check_recording(recording, rig, lasers)
    chosen = rig.choose_lasers(lasers)
    check_extractor(extractor, chosen)
    stage = project.stage(
        EXTRACT,
        settings={"extractor": describe(extractor), "lasers": chosen},
        inputs={"recording": recording.fingerprint(), "rig": describe(rig)},
    )

    def make(_: None) -> ExtractResult:
        backgrounds = _learn(project, recording, rig, extractor, chosen, progress)
        job = _Job(project, rig, extractor, backgrounds, overlay_step(recording))
        _extract_parts(job, recording, executor or Threads(), progress)
        return _count(job)

    return run_stage(project, stage, make, prepare=lambda: None, progress=progress)


def _learn(
    project: Project,
    recording: AbstractRecording,
    rig: Rig,
    extractor: AbstractExtractor,
    lasers: tuple[int, ...],
    progress: Progress,
) -> dict[int, Background]:
    """Learn the recording for each laser, from the same frames; what is there already is kept."""
    known = {number: project.load_background(number) for number in lasers}
    missing = [number for number, background in known.items() if background is None]
    frames = recording.sample(_SAMPLES) if missing else ()
    for done, number in enumerate(missing):
        progress("learn the recording", done, len(missing) if done else None)
        background = extractor.learn(frames, rig, laser=number)
        project.save_background(background, number)
        known[number] = background
        progress("learn the recording", done + 1, len(missing))
    return {number: background for number, background in known.items() if background is not None}


def check_recording(recording: AbstractRecording, rig: Rig, lasers: Sequence[int] = ()) -> None:
    """Refuse a recording that this rig cannot have made, and lasers that it does not have."""
    rig.choose_lasers(lasers)
    if recording.size != rig.camera.size:
        raise InputError(
            f"{recording.path} has pictures of {recording.size[0]} × {recording.size[1]} px but "
            f"the rig's camera has {rig.camera.size[0]} × {rig.camera.size[1]}; give the rig that "
            "made this recording, and never resize pictures."
        )


def overlay_step(recording: AbstractRecording) -> int:
    """Give the distance between frames that are drawn; `choose_overlays` thins them to a few."""
    return max((recording.num_frames or 64 * CHUNK) // 8, 1)


@dataclass(frozen=True, eq=False)
class _Part:
    """What one part gives."""

    number: int
    stripe: Stripe
    note: PartNote
    shown: Mapping[str, tuple[Frame, Stripe]]
    """What may be drawn, by the names of the pictures: each is a dozen times as large."""


@dataclass(frozen=True, eq=False)
class _Job:
    """What every chunk needs."""

    project: Project
    rig: Rig
    extractor: AbstractExtractor
    backgrounds: Mapping[int, Background]
    """What was learnt for each laser whose stripe is looked for."""
    overlay_step: int

    def find(self, chunk: Chunk) -> _Part:
        """Find the stripes of one part."""
        frames, *streams = tee(chunk.take_frames(), 1 + len(self.backgrounds))
        each = [self._find_one(*given) for given in zip(streams, self.backgrounds, strict=True)]
        moments, stripes = list[tuple[int, float]](), list[Stripe]()
        candidates = Candidates(self.overlay_step)
        for frame, *found in zip(frames, *each, strict=True):
            if chunk.owns(frame.index):
                moments.append((frame.index, frame.time))
                stripes.append(Stripe.concatenate(found))
                candidates.add(frame, stripes[-1])
            elif moments:
                break  # the frames after it have been looked at as far as it needs them
        stripe = Stripe.concatenate(stripes)
        note = PartNote(
            frames=tuple(index for index, _ in moments),
            times=tuple(time for _, time in moments),
            points=tuple(map(len, stripes)),
            skips=tuple((skip.index, skip.count, skip.reason) for skip in chunk.skips),
            points_of=tuple(int((stripe.laser == laser).sum()) for laser in self.backgrounds),
        )
        return _Part(chunk.part, stripe, note, candidates.by_name())

    def _find_one(self, frames: Iterator[Frame], laser: int) -> Iterator[Stripe]:
        """Find one laser's stripe in each frame."""
        background, size = self.backgrounds[laser], self.rig.camera.size
        seen, given = tee(frames)
        stripes = self.extractor.extract(given, self.rig, background, laser=laser)
        return check_stripes(self.extractor, stripes, seen, size=size, laser=laser)

    def save(self, part: _Part) -> int:
        """Write one part: its overlays, its stripes, and last its note."""
        for name, found in part.shown.items():
            self.project.save_overlay(name, draw_stripe(*found))
        self.project.save_stripe_part(part.number, part.stripe, part.note)
        return part.number


@dataclass(frozen=True, eq=False)
class _RunTask:
    """A run of parts that reads its own frames, wherever it is done."""

    job: _Job
    recording: AbstractRecording

    def __call__(self, run: Run) -> list[_Part]:
        halo = self.job.extractor.look_ahead
        return [self.job.find(chunk) for chunk in read_run(self.recording, run, halo=halo)]


def _extract_parts(
    job: _Job, recording: AbstractRecording, executor: AbstractExecutor, progress: Progress
) -> None:
    """Make the parts that are missing, and keep the overlays that are chosen among all."""
    for part in _run(job, recording, executor):
        progress("extract", (part + 1) * CHUNK, recording.num_frames)
    # A drawing may have been lost with everything else of its part in place: then that is redone.
    lost = choose_overlays(_notes(job), step=job.overlay_step) - {*job.project.find_overlays()}
    for part, note in list(job.project.load_stripe_parts()):
        if lost.intersection(name_candidates(note, step=job.overlay_step)):
            job.project.discard_stripe_part(part)
    if lost:
        for _ in _run(job, recording, executor):
            progress("extract", 0, None)
    chosen = choose_overlays(_notes(job), step=job.overlay_step)
    for name in job.project.find_overlays():
        if name not in chosen:
            job.project.remove_overlay(name)


def _run(job: _Job, recording: AbstractRecording, executor: AbstractExecutor) -> Iterator[int]:
    """Make the missing parts; this process alone writes, so that a worker may die."""
    there = frozenset(part for part, _ in job.project.load_stripe_parts())
    halo = job.extractor.look_ahead
    if executor.shares_memory or not recording.starts_anywhere:
        chunks = read_missing(recording, there, halo=halo)
        with closing(executor.map(job.find, chunks)) as parts:
            yield from map(job.save, parts)
        return
    runs = missing_runs(recording, there)
    with closing(executor.map(_RunTask(job, recording), runs)) as found:
        for some in found:
            yield from map(job.save, some)


def _notes(job: _Job) -> list[PartNote]:
    return [note for _, note in job.project.load_stripe_parts()]


def _count(job: _Job) -> ExtractResult:
    notes, backgrounds = _notes(job), job.backgrounds
    points = [number for note in notes for number in note.points]
    points_of = tuple(map(sum, zip(*(note.points_of for note in notes), strict=True)))
    skips = tuple(skip for note in notes for skip in note.skips)
    water = (one.water for one in backgrounds.values() if one.water)
    return ExtractResult(
        lasers=tuple(backgrounds),
        frames=len(points),
        skipped=sum(number for _, number, _ in skips),
        frames_without_stripe=points.count(0),
        points=sum(points),
        skips=skips,
        remarks=join_remarks({n: one.remarks for n, one in backgrounds.items()}, points_of),
        attenuation=next(water, None),
        points_of=points_of,
    )
