"""A recording's frames in chunks, each with what its neighbours show."""

from collections.abc import Iterable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from itertools import count

from ..types.frame import Frame
from .base import AbstractRecording, Skip

CHUNK = 64
"""Frames a part: 27 MB of pictures at 720 × 576."""
_RUN = 8
"""Parts a worker does that reads its own frames: it begins at a keyframe, of which there may be but
one in ten seconds."""
_ALL = 1 << 31
"""More parts than a recording has."""


@dataclass(frozen=True, eq=False)
class Chunk:
    """Frames that make one part, with a halo of frames on both sides, until they are taken."""

    part: int
    frames: list[Frame] = field(default_factory=list)
    skips: list[Skip] = field(default_factory=list)

    def take_frames(self) -> Iterator[Frame]:
        """Give the frames in order, and let go of each, so that few are held at once."""
        while self.frames:
            yield self.frames.pop(0)

    def owns(self, index: int) -> bool:
        """Tell whether a frame belongs to the part, not to its halo."""
        return index // CHUNK == self.part


@dataclass(frozen=True)
class Run:
    """Parts that follow one another."""

    first: int
    end: int
    """The first part after them."""
    there: frozenset[int]
    """Parts among them that need not be made."""


def read_missing(
    recording: AbstractRecording, there: AbstractSet[int], *, halo: int
) -> Iterator[Chunk]:
    """Read on from the first part that is missing, and give those that are."""
    first = next(part for part in count() if part not in there)
    skips = list[Skip]()
    frames = recording.frames(max(first * CHUNK - halo, 0), on_skip=skips.append)
    for chunk in cut_chunks(frames, skips, first=first, halo=halo):
        if chunk.part not in there:
            yield chunk


def missing_runs(recording: AbstractRecording, there: frozenset[int]) -> Iterator[Run]:
    """Give runs of parts of which some are missing; the last one goes on to the recording's end."""
    num_parts = -(-(recording.num_frames or 0) // CHUNK)
    for first in range(0, max(num_parts, 1), _RUN):
        end = first + _RUN if first + _RUN < num_parts else _ALL
        inside = frozenset(part for part in there if first <= part < end)
        if len(inside) < end - first:
            yield Run(first, end, inside)


def read_run(recording: AbstractRecording, run: Run, *, halo: int) -> Iterator[Chunk]:
    """Read the chunks of a run, as if the recording were read from its beginning."""
    skips, seen = list[Skip](), False

    def own() -> Iterator[Frame]:
        nonlocal seen
        # From the part before: whether it has frames tells to which part a loss at the end belongs.
        begin = max(run.first * CHUNK - max(halo, CHUNK), 0)
        for frame in recording.frames(begin, on_skip=skips.append):
            seen = True
            yield frame
            if frame.index >= run.end * CHUNK + halo:
                return

    for chunk in cut_chunks(own(), skips, first=run.first, halo=halo):
        is_known = seen or run.first == 0
        if is_known and run.first <= chunk.part < run.end and chunk.part not in run.there:
            yield chunk


def cut_chunks(
    frames: Iterable[Frame], skips: list[Skip], *, first: int, halo: int
) -> Iterator[Chunk]:
    """Cut frames into chunks from part `first` on, each with `halo` frames of its neighbours.

    Skips that were reported go with the part that they fall into, late ones with the last part.
    """
    kept: list[Frame] = []
    part = first
    for frame in frames:
        while frame.index >= (part + 1) * CHUNK + halo:
            chunk, part = _cut(part, kept, skips, halo), part + 1
            kept = [one for one in kept if one.index >= part * CHUNK - halo]
            yield chunk
        kept.append(frame)
    while kept and part <= kept[-1].index // CHUNK:
        yield _cut(part, kept, skips, halo)
        part += 1
    late = [one for skip in skips if (one := _from(skip, part * CHUNK)).count > 0]
    if late:
        yield Chunk(part, [], late)


def _cut(part: int, kept: list[Frame], skips: list[Skip], halo: int) -> Chunk:
    low, high = part * CHUNK, (part + 1) * CHUNK
    own, later = list[Skip](), list[Skip]()
    for skip in skips:
        end = skip.index + skip.count
        inside = (max(skip.index, low), min(end, high))
        if inside[0] < inside[1]:
            own.append(Skip(inside[0], skip.reason, inside[1] - inside[0]))
        if end > high:
            later.append(_from(skip, high))
    skips[:] = later
    near = [frame for frame in kept if low - halo <= frame.index < high + halo]
    return Chunk(part, near, own)


def _from(skip: Skip, index: int) -> Skip:
    """Give what of a skip lies at a frame or after it."""
    begin = max(skip.index, index)
    return Skip(begin, skip.reason, skip.index + skip.count - begin)
