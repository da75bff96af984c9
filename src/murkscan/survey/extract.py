"""Find the stripe in every frame of a recording, in chunks that can be resumed."""

import os
import time
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from ..capture import AbstractRecording, Skip
from ..errors import InputError
from ..extract import AbstractExtractor
from ..project import Project
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .overlay import draw_overlays, keep_overlays
from .progress import Progress, silent
from .settings import describe

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
) -> dict[str, Any]:
    """Run the extract stage; parts that are there already are kept.

    Args:
        project: Where the stripes go.
        recording: The pictures.
        rig: The rig that recorded them.
        extractor: The way to find the stripe.
        laser: Number of the laser whose stripe is looked for.
        progress: Told of each part.

    Returns:
        Counts: frames, skipped, frames_without_stripe, points; the reasons of skips; what is odd
        about the recording, and how murky the water was, as far as the extractor tells.

    Raises:
        InputError: The recording is not of this rig.
        FormatError: Nothing of the recording can be read.
        DeviceError: The disk is full.
    """
    check_recording(recording, rig, laser)
    stage = project.stage(
        "extract",
        settings={"extractor": describe(extractor), "laser": laser},
        inputs={"recording": recording.fingerprint(), "rig": describe(rig)},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    stage.begin()
    progress("extract", 0, recording.num_frames)
    background = extractor.learn(recording.sample(_SAMPLES), rig, laser=laser)
    project.save_background(describe(background))
    job = _Job(project, rig, extractor, background, laser, overlay_step(recording))
    for part in _run(job, recording):
        progress("extract", (part + 1) * CHUNK, recording.num_frames)
    keep_overlays(project)
    result = _count(project) | _tell(background)
    stage.finish(result, since=since)
    return result


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
    """Give the distance between frames that are drawn; `keep_overlays` thins them to a few."""
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
        """Make one part: its stripes, its overlays, and last its note."""
        stripes = self.extractor.extract(chunk.frames, self.rig, self.background, laser=self.laser)
        found = [
            (frame, stripe)
            for frame, stripe in zip(chunk.frames, stripes, strict=True)
            if chunk.owns(frame.index)
        ]
        draw_overlays(self.project, found, step=self.overlay_step)
        note = {
            "frames": [frame.index for frame, _ in found],
            "times": [frame.time for frame, _ in found],
            "points": [len(stripe) for _, stripe in found],
            "skips": [[skip.index, skip.count, skip.reason] for skip in chunk.skips],
        }
        self.project.save_stripe_part(
            chunk.part, Stripe.concatenate([stripe for _, stripe in found]), note
        )
        return chunk.part


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
    first = 0
    while job.project.has_stripe_part(first):
        first += 1
    halo, skips = job.extractor.look_ahead, list[Skip]()
    frames = recording.frames(max(first * CHUNK - halo, 0), on_skip=skips.append)
    for chunk in cut_chunks(frames, skips, first=first, halo=halo):
        if not job.project.has_stripe_part(chunk.part):
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


def _tell(background: Background) -> dict[str, Any]:
    """Give what was learnt that a user wants to know."""
    water = background.attenuation
    return {
        "remarks": list(background.remarks),
        "attenuation": water
        and {
            "effective_per_m": water.effective,
            "between_per_m": [water.low, water.high],
        },
    }


def _count(project: Project) -> dict[str, Any]:
    notes = [note for _, note in project.load_stripe_notes()]
    points = [count for note in notes for count in note["points"]]
    skips = [skip for note in notes for skip in note["skips"]]
    return {
        "frames": len(points),
        "skipped": sum(count for _, count, _ in skips),
        "frames_without_stripe": points.count(0),
        "points": sum(points),
        "skips": skips,
    }
