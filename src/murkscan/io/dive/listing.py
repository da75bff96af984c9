"""What a dive's file holds, in lines for the terminal."""

from collections.abc import Sequence

import numpy as np

from ..clock_times import say_moment
from .contents import DiveContents, TopicFacts
from .series import WORDS

_HOLE = 1.0
"""Shortest pause that is told as a hole, if it is also five usual steps long [s]."""
_STEPS = 5.0
_LATE = 0.05
"""Shortest time from sending to writing down that is told [s]."""
_TOLD = 3
"""Holes of a topic that are told one by one: the longest."""
_HEADS: tuple[str, ...] = ("topic", "type", "messages", "rate", "from", "to", "of use for")
_WIDEST = 48
"""Letters of a name in the table; longer ones push their line."""


def list_contents(contents: DiveContents) -> list[str]:
    """Write what there is: a table of topics, and what is odd."""
    file, topics = contents.file, sorted(contents.topics, key=lambda one: one.topic.name)
    if not topics:
        return [f"{file.path}: {file.kind}, no messages", *_told("damage", contents.damage)]
    begin = min(float(one.times.min()) for one in topics)
    end = max(float(one.times.max()) for one in topics)
    head = (
        f"{file.path}: {file.kind}, {contents.num_bytes / 1e6:,.1f} MB, {say_moment(begin)} to "
        f"{say_moment(end)} ({end - begin:,.1f} s)"
    )
    rows = [_HEADS, *(_row(one, begin) for one in topics)]
    steps = [
        f"put {'forward' if step.size > 0 else 'back'} by {abs(step.size):.3f} s at "
        f"{step.time - begin:.1f} s; taken out of all times here"
        for step in contents.steps
    ]
    return [
        head,
        *_table(rows),
        *_told("hole", [words for one in topics for words in _holes(one, begin)]),
        *_told("clock", [*steps, *_lags(topics), *_stamps(contents)]),
        *_told("damage", contents.damage),
        *_told("use", _uses(contents)),
    ]


def _row(one: TopicFacts, begin: float) -> tuple[str, ...]:
    rate = 1 / step if (step := _usual_step(one)) > 0 else 0.0
    use = next((words for kind, words in WORDS.items() if kind == one.use), one.use)
    return (
        one.topic.name,
        one.topic.type or one.topic.encoding,
        f"{one.num_messages:,}",
        f"{rate:.1f}/s" if rate else "",
        f"{one.times.min() - begin:.1f} s",
        f"{one.times.max() - begin:.1f} s",
        use,
    )


def _table(rows: Sequence[tuple[str, ...]]) -> list[str]:
    widths = [min(max(len(row[k]) for row in rows), _WIDEST) for k in range(len(rows[0]))]
    return [
        "  ".join(
            cell.rjust(width) if 2 <= k <= 5 else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _usual_step(one: TopicFacts) -> float:
    return float(np.median(np.diff(one.times))) if one.num_messages > 1 else 0.0


def _holes(one: TopicFacts, begin: float) -> list[str]:
    """Tell the longest pauses of what is of use."""
    if not one.use or one.num_messages < 3:
        return []
    steps = np.diff(one.times)
    long = np.flatnonzero(steps > max(_HOLE, _STEPS * _usual_step(one)))
    longest = sorted(long[np.argsort(-steps[long])][:_TOLD].tolist())
    told = [f"{steps[k]:.1f} s from {one.times[k] - begin:.1f} s" for k in longest]
    more = f" and {len(long) - len(told)} more" if len(long) > len(told) else ""
    return [f"{one.topic.name}: {', '.join(told)}{more}"] if told else []


def _lags(topics: Sequence[TopicFacts]) -> list[str]:
    return [
        f"{one.topic.name}: written down {one.lag * 1e3:.0f} ms after it was sent, in the median; "
        "the time of writing counts"
        for one in topics
        if one.use and abs(one.lag) > _LATE
    ]


def _stamps(contents: DiveContents) -> list[str]:
    return [
        f"{one.topic.name}: pictures are timed by {one.clock} clock"
        + (f", uneven by {one.jitter * 1e3:.0f} ms (1σ) and smoothed" if one.jitter else "")
        for one in contents.pictures
    ]


def _uses(contents: DiveContents) -> list[str]:
    """Say what can be done with the file."""
    path, cameras = contents.file.path, [one.topic.name for one in contents.pictures]
    kinds = {one.kind for one in contents.series}
    turns = bool(kinds & {"attitude", "orientation"})
    knows_way = "pose" in kinds or (turns and bool(kinds & {"position", "geodetic", "twist"}))
    topic = f" --topic {cameras[0]}" if len(cameras) > 1 else ""
    speed = "" if knows_way else " --speed-mm-s V"
    if cameras:
        return [f"murkscan scan {path} --rig rig.toml{topic}{speed} --out OUT"]
    if kinds:
        return [f"murkscan scan VIDEO --rig rig.toml --navigation {path}{speed} --out OUT"]
    return ["nothing here is of use for a scan"]


def _told(name: str, sentences: Sequence[str]) -> list[str]:
    return [f"{name + ':':<8}{words}" for words in sentences]
