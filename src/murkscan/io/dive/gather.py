"""Find out what a dive's file holds, by reading it once from end to end."""

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
from jaxtyping import Int

from ...errors import FormatError
from ...types.arrays import Scalars
from .clock import (
    ClockStep,
    find_jumps,
    find_steps_back,
    refine_steps,
    smooth_arrival,
    take_out,
    time_by_other,
)
from .contents import DiveContents, PictureIndex, TopicFacts
from .decode import decode
from .messages import Message, Topic
from .open import DiveFile, open_dive
from .pictures import may_hold_pictures, read_picture
from .series import Series, SeriesKind, read_series, series_kind

_NEAR = 10.0
"""Difference of a message's own time from the log's up to which both clocks are one [s]: further
apart, the message's clock was never set."""
_LATEST = 1 << 62
"""Times beyond this are none: the year 2116 [ns]."""
_ALIKE = 0.2
"""Change of that difference at a step up to which the step is in both clocks [s]."""


Progress = Callable[[int, int], None]
"""Told how many bytes of how many have been read."""


def read_contents(path: Path) -> DiveContents:
    """Read a dive's file from end to end; a second time the same answer costs nothing.

    Raises:
        InputError: There is nothing at the path.
        FormatError: It is no dive's recording.
        MissingDependency: What reads it is not installed.
    """
    return _read_once(path, _marks(open_dive(path)))


def gather_contents(path: Path, progress: Progress) -> DiveContents:
    """Read a dive's file from end to end, and say how far; see `read_contents`."""
    file = open_dive(path)
    return _Gathering(file).read(sum(size for size, _ in _marks(file)), progress)


@lru_cache(maxsize=1)
def _read_once(path: Path, marks: tuple[tuple[int, int], ...]) -> DiveContents:
    """Read a file that has these sizes and dates."""
    del marks
    return gather_contents(path, lambda done, total: None)


def _marks(file: DiveFile) -> tuple[tuple[int, int], ...]:
    states = [one.stat() for one in file.files]
    return tuple((state.st_size, state.st_mtime_ns) for state in states)


@dataclass(eq=False)
class _Camera:
    """Pictures of a topic while they are gathered."""

    topic: Topic
    messages: "array[int]" = field(default_factory=lambda: array("q"))
    places: "array[int]" = field(default_factory=lambda: array("q"))
    stamps: "array[int]" = field(default_factory=lambda: array("q"))
    keys: "array[int]" = field(default_factory=lambda: array("b"))
    codecs: dict[str, int] = field(default_factory=dict)


@dataclass(eq=False)
class _Instrument:
    """Readings of a series while they are gathered."""

    topic: Topic
    kind: SeriesKind
    messages: "array[int]" = field(default_factory=lambda: array("q"))
    stamps: "array[int]" = field(default_factory=lambda: array("q"))
    boots: "array[float]" = field(default_factory=lambda: array("d"))
    values: "array[float]" = field(default_factory=lambda: array("d"))


class _Gathering:
    """One reading of a file."""

    def __init__(self, file: DiveFile) -> None:
        self._file = file
        self._log, self._sent, self._which = array("q"), array("q"), array("l")
        self._numbers: dict[Topic, int] = {}
        self._handlers: dict[Topic, Callable[[int, Message], None] | None] = {}
        self._cameras: dict[str, _Camera] = {}
        self._instruments: dict[str, _Instrument] = {}
        self._damage: dict[str, int] = {}

    def read(self, num_bytes: int, progress: Progress) -> DiveContents:
        for message in self._file.messages(tell=self._note):
            if not (0 <= message.log_time < _LATEST and 0 <= message.publish_time < _LATEST):
                self._note(f"a message of {message.topic.name} has a time that cannot be")
                continue
            number = len(self._log)
            self._log.append(message.log_time)
            self._sent.append(message.publish_time)
            topic = message.topic
            if topic not in self._numbers:
                self._numbers[topic] = len(self._numbers)
                self._handlers[topic] = self._choose_handler(message)
            self._which.append(self._numbers[topic])
            handle = self._handlers[topic]
            if handle is not None:
                try:
                    handle(number, message)
                except FormatError as error:
                    self._note(str(error).rstrip("."))
            if number % 1000 == 0 and self._file.kind in ("MCAP", "bag of ROS 1"):
                progress(message.place & ((1 << 48) - 1), num_bytes)
        progress(num_bytes, num_bytes)
        return self._conclude(num_bytes)

    def _note(self, words: str) -> None:
        self._damage[words] = self._damage.get(words, 0) + 1

    def _choose_handler(self, message: Message) -> Callable[[int, Message], None] | None:
        topic = message.topic
        first = None
        if topic.encoding == "json":
            try:
                first = decode(message)
            except FormatError:
                return None
        if may_hold_pictures(topic, first):
            self._cameras.setdefault(topic.name, _Camera(topic))
            return self._add_picture
        return None if series_kind(topic) is None else self._add_readings

    def _add_picture(self, number: int, message: Message) -> None:
        camera = self._cameras[message.topic.name]
        camera.messages.append(number)
        camera.places.extend((message.place, message.number))
        camera.stamps.append(-1)
        camera.keys.append(0)
        picture = read_picture(message.topic, decode(message))
        camera.codecs[picture.codec] = camera.codecs.get(picture.codec, 0) + 1
        camera.stamps[-1] = -1 if picture.stamp is None else picture.stamp
        camera.keys[-1] = bool(picture.data) and picture.is_key is True

    def _add_readings(self, number: int, message: Message) -> None:
        kind = series_kind(message.topic)
        assert kind is not None
        readings, stamp = read_series(message.topic, decode(message))
        for name, values, boot in readings:
            one = self._instruments.setdefault(name, _Instrument(message.topic, kind))
            one.messages.append(number)
            one.stamps.append(-1 if stamp is None else stamp)
            one.boots.append(boot)
            one.values.extend(values)

    def _conclude(self, num_bytes: int) -> DiveContents:
        log, which = np.array(self._log, np.int64), np.array(self._which)
        steps = self._find_steps(log)
        mended = take_out(log, steps)
        pictures = tuple(
            self._index(camera, log, mended, steps) for camera in self._cameras.values()
        )
        series = tuple(
            self._series(name, one, log, mended, steps) for name, one in self._instruments.items()
        )
        late = (log - np.array(self._sent, np.int64)) / 1e9
        topics = []
        for topic, number in self._numbers.items():
            mine = which == number
            lag = float(np.median(late[mine]))
            use = self._use(topic)
            topics.append(TopicFacts(topic, int(mine.sum()), mended[mine] / 1e9, lag, use))
        return DiveContents(
            self._file,
            tuple(topics),
            pictures,
            series,
            tuple(ClockStep(at, float(mended[max(at - 1, 0)]) / 1e9, size) for at, size in steps),
            tuple(f"{n:,} times: {w}" if n > 1 else w for w, n in self._damage.items()),
            num_bytes,
        )

    def _find_steps(self, log: Int[np.ndarray, " n"]) -> list[tuple[int, float]]:
        """Find steps of the log's clock, in itself and against the autopilot's."""
        steps = find_steps_back(log)
        clocks = [o for o in self._instruments.values() if np.isfinite(np.array(o.boots)).any()]
        if not clocks:
            return steps
        longest = max(clocks, key=lambda one: len(one.messages))
        boots = np.array(longest.boots)
        known = np.isfinite(boots)
        carriers, boots = np.array(longest.messages)[known], boots[known]
        steps = refine_steps(steps, log, carriers, boots)
        return sorted([*steps, *find_jumps(take_out(log, steps), carriers, boots)])

    def _index(
        self,
        camera: _Camera,
        log: Int[np.ndarray, " n"],
        mended: Int[np.ndarray, " n"],
        steps: list[tuple[int, float]],
    ) -> PictureIndex:
        messages = np.array(camera.messages)
        stamps = _own_times(np.array(camera.stamps), messages, log, mended, steps)
        times, jitter = smooth_arrival(mended[messages] / 1e9 if stamps is None else stamps)
        by_count = sorted(camera.codecs, key=lambda codec: -camera.codecs[codec])
        return PictureIndex(
            camera.topic,
            tuple(by_count),
            np.array(camera.places, np.int64).reshape(-1, 2),
            times,
            np.array(camera.keys, bool),
            jitter,
            "the log's" if stamps is None else "the messages' own",
        )

    def _series(
        self,
        name: str,
        one: _Instrument,
        log: Int[np.ndarray, " n"],
        mended: Int[np.ndarray, " n"],
        steps: list[tuple[int, float]],
    ) -> Series:
        messages, boots = np.array(one.messages), np.array(one.boots)
        own = _own_times(np.array(one.stamps), messages, log, mended, steps)
        times = mended[messages] / 1e9 if own is None else own
        known = np.isfinite(boots)
        if own is None and known.all() and np.all(np.diff(boots) >= 0):
            times = time_by_other(times, boots)
        values = np.array(one.values).reshape(len(messages), -1)
        order = np.argsort(times, kind="stable")
        return Series(name, one.kind, times[order], values[order], one.topic)

    def _use(self, topic: Topic) -> str:
        if topic.name in self._cameras:
            return f"pictures: {', '.join(self._cameras[topic.name].codecs) or 'none readable'}"
        kind = series_kind(topic)
        return "" if kind is None else kind


def _own_times(
    stamps: Int[np.ndarray, " n"],
    messages: Int[np.ndarray, " n"],
    log: Int[np.ndarray, " m"],
    mended: Int[np.ndarray, " m"],
    steps: list[tuple[int, float]],
) -> Scalars | None:
    """Give messages' own times [s], steps of the clock taken out; None where they have none.

    A stamp by a clock that was never set is no use beside other topics' times.
    """
    if (stamps < 0).any() or len(stamps) == 0:
        return None
    away = (stamps - log[messages]) / 1e9
    if abs(float(np.median(away))) > _NEAR:
        return None
    own = stamps.astype(np.int64)
    for message, size in steps:
        at = int(np.searchsorted(messages, message))
        before, after = away[max(at - 20, 0) : at], away[at : at + 20]
        if len(before) and len(after) and abs(np.median(after) - np.median(before)) < _ALIKE:
            own = own.copy()
            own[at:] -= round(size * 1e9)
        elif not len(before):
            own = own - round(size * 1e9)
    return own / 1e9
