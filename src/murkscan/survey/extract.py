"""Find the stripe in every frame of a recording, in chunks that can be resumed."""

import os
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import count

from ..capture import AbstractRecording, Skip
from ..errors import InputError
from ..extract import AbstractExtractor
from ..project import EXTRACT, ExtractResult, PartNote, Project, describe
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .overlay import choose_overlays, draw_overlays, name_candidates
from .progress import Progress, silent
from .stage_runner import run_stage

CHUNK = 64
"""Frames a part: 27 MB of pictures at 720 × 576."""
_MOST_WORKERS = 4
"""Parts in work at once; two more wait. Reading is what limits a scan, not this."""

_SAMPLES = 24
"""Frames that an extractor learns from."""


@dataclass(frozen=True, eq=False)
class _Chunk:
    """Frames that make one part, with a halo of frames on both sides."""

    part: int
    frames: list[Frame] = field(default_factory=list)
    skips: list[Skip] = field(default_factory=list)

    def owns(self, index: int) -> bool:
        return index // CHUNK == self.part


def extract_recording(
    project: Project,
    recording: AbstractRecording,
    rig: Rig,
    extractor: AbstractExtractor,
    *,
    laser: int = 0,
    progress: Progress = silent,
) -> ExtractResult:
    """Run the extract stage; parts that are there already are kept.

    Args:
        project: Where the stripes go.
        recording: The pictures.
        rig: The rig that recorded them.
        extractor: The way to find the stripe.
        laser: Number of the laser whose stripe is looked for.
        progress: Told of each part.

    Raises:
        InputError: The recording is not of this rig.
        FormatError: Nothing of the recording can be read.
        DeviceError: The disk is full.
    """
    check_recording(recording, rig, laser)
    stage = project.stage(
        EXTRACT,
        settings={"extractor": describe(extractor), "laser": laser},
        inputs={"recording": recording.fingerprint(), "rig": describe(rig)},
    )

    def make(_: None) -> ExtractResult:
        background = project.load_background()
        if background is None:
            background = extractor.learn(recording.sample(_SAMPLES), rig, laser=laser)
            project.save_background(background)
        job = _Job(project, rig, extractor, background, laser, overlay_step(recording))
        _extract_parts(job, recording, progress)
        return _count(job)

    return run_stage(project, stage, make, prepare=lambda: None, progress=progress)


def check_recording(recording: AbstractRecording, rig: Rig, laser: int) -> None:
    """Refuse a recording that this rig cannot have made, and a laser that it does not have."""
    rig.laser(laser)
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
class _Job:
    """What every chunk needs."""

    project: Project
    rig: Rig
    extractor: AbstractExtractor
    background: Background
    laser: int
    overlay_step: int

    def extract(self, chunk: _Chunk) -> int:
        """Make one part: its overlays, its stripes, and last its note."""
        stripes = self.extractor.extract(chunk.frames, self.rig, self.background, laser=self.laser)
        found = [
            (frame, stripe)
            for frame, stripe in zip(chunk.frames, stripes, strict=True)
            if chunk.owns(frame.index)
        ]
        note = PartNote(
            frames=tuple(frame.index for frame, _ in found),
            times=tuple(frame.time for frame, _ in found),
            points=tuple(len(stripe) for _, stripe in found),
            skips=tuple((skip.index, skip.count, skip.reason) for skip in chunk.skips),
        )
        draw_overlays(self.project, found, note, step=self.overlay_step)
        self.project.save_stripe_part(
            chunk.part, Stripe.concatenate([stripe for _, stripe in found]), note
        )
        return chunk.part


def _extract_parts(job: _Job, recording: AbstractRecording, progress: Progress) -> None:
    """Make the parts that are missing, and keep the overlays that are chosen among all."""
    for part in _run(job, recording):
        progress("extract", (part + 1) * CHUNK, recording.num_frames)
    # A drawing may have been lost with everything else of its part in place: then that is redone.
    lost = choose_overlays(_notes(job), step=job.overlay_step) - {*job.project.find_overlays()}
    for part, note in list(job.project.load_stripe_parts()):
        if lost.intersection(name_candidates(note, step=job.overlay_step)):
            job.project.discard_stripe_part(part)
    if lost:
        for _ in _run(job, recording):
            progress("extract", 0, None)
    chosen = choose_overlays(_notes(job), step=job.overlay_step)
    for name in job.project.find_overlays():
        if name not in chosen:
            job.project.remove_overlay(name)


def _run(job: _Job, recording: AbstractRecording) -> Iterator[int]:
    """Read on in this thread while others extract; hold few chunks at once."""
    workers = min(os.cpu_count() or 1, _MOST_WORKERS)
    waiting: deque[Future[int]] = deque()
    with ThreadPoolExecutor(workers) as pool:
        try:
            for chunk in _missing_chunks(job, recording):
                waiting.append(pool.submit(job.extract, chunk))
                if len(waiting) > workers:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _missing_chunks(job: _Job, recording: AbstractRecording) -> Iterator[_Chunk]:
    there = {part for part, _ in job.project.load_stripe_parts()}
    first = next(part for part in count() if part not in there)
    halo, skips = job.extractor.look_ahead, list[Skip]()
    frames = recording.frames(max(first * CHUNK - halo, 0), on_skip=skips.append)
    for chunk in cut_chunks(frames, skips, first=first, halo=halo):
        if chunk.part not in there:
            yield chunk


def cut_chunks(
    frames: Iterable[Frame], skips: list[Skip], *, first: int, halo: int
) -> Iterator[_Chunk]:
    """Cut frames into chunks from part `first` on, each with `halo` frames of its neighbours.

    Skips that were reported go with the part that they fall into, late ones with the last part.
    """
    kept: list[Frame] = []
    part = first
    for frame in frames:
        while frame.index >= (part + 1) * CHUNK + halo:
            yield _cut(part, kept, skips, halo)
            part += 1
            kept = [one for one in kept if one.index >= part * CHUNK - halo]
        kept.append(frame)
    while kept and part <= kept[-1].index // CHUNK:
        yield _cut(part, kept, skips, halo)
        part += 1
    if skips:
        yield _Chunk(part, [], skips)


def _cut(part: int, kept: list[Frame], skips: list[Skip], halo: int) -> _Chunk:
    low, high = part * CHUNK, (part + 1) * CHUNK
    own, later = list[Skip](), list[Skip]()
    for skip in skips:
        end = skip.index + skip.count
        inside = (max(skip.index, low), min(end, high))
        if inside[0] < inside[1]:
            own.append(Skip(inside[0], skip.reason, inside[1] - inside[0]))
        if end > high:
            later.append(Skip(max(skip.index, high), skip.reason, end - max(skip.index, high)))
    skips[:] = later
    near = [frame for frame in kept if low - halo <= frame.index < high + halo]
    return _Chunk(part, near, own)


def _notes(job: _Job) -> list[PartNote]:
    return [note for _, note in job.project.load_stripe_parts()]


def _count(job: _Job) -> ExtractResult:
    points = [number for note in _notes(job) for number in note.points]
    skips = tuple(skip for note in _notes(job) for skip in note.skips)
    return ExtractResult(
        laser=job.laser,
        frames=len(points),
        skipped=sum(number for _, number, _ in skips),
        frames_without_stripe=points.count(0),
        points=sum(points),
        skips=skips,
        remarks=job.background.remarks,
        attenuation=job.background.attenuation,
    )
