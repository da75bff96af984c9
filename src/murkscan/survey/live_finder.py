"""Find the stripe in frames as they come, by what has been learnt so far."""

import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..capture import ArrivedFrame
from ..distribute import AbstractExecutor, Serial, give_way
from ..extract import AbstractExtractor
from ..live import Look, Mailbox, PictureWatch, SpreadFrames
from ..triangulate import AbstractTriangulation, triangulate
from ..types.background import Background
from ..types.frame import Frame
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.stripe import Stripe

_FIRST, _LATER = 12, 48
"""Frames that are learnt from at first, so that something is seen soon, and later on, as a scan
does."""
_AGAIN, _FACTOR, _RARELY = 5.0, 3.0, 300.0
"""Recording time after which is learnt anew, by what factor that grows, and at most [s]: what is
fixed to the picture and how murky the water is show better over a longer time."""
STALE = 0.12
"""Age from which a frame of a stream is dropped while others wait [s]: of a quarter of a second the
five fields that `Murk` looks ahead for a preview take 0.1 s, and the finding itself a field's time.
"""
_NICE = 19
"""How much the learning gives way to the finding: as much as there is."""
_WAIT = 0.25
_WAITING = 16
"""Frames that wait at most, whatever their age."""
_UNREAD = 4000
"""Profiles that wait to be shown at most: more than a minute's."""
_ROOM = 4
"""Frames that wait when a replay waits as well."""


@dataclass(frozen=True, eq=False)
class Found:
    """What a frame showed; its picture is not kept."""

    index: int
    """Number of the frame in the recording."""
    time: float
    """Recording time [s]."""
    row_step: int
    """2 where the frame is a field."""
    look: Look
    profile: Profile
    latency: float
    """Time from its arrival to its profile [s]."""


@dataclass(frozen=True, eq=False)
class _Learn:
    """What a worker learns from frames."""

    extractor: AbstractExtractor
    rig: Rig
    laser: int

    def __call__(self, frames: list[Frame]) -> Background:
        return self.extractor.learn_soon(frames, self.rig, laser=self.laser)


class LiveFinder:
    """Takes frames out of one mailbox, and puts what they show into another."""

    def __init__(
        self,
        rig: Rig,
        extractor: AbstractExtractor,
        method: AbstractTriangulation,
        *,
        laser: int,
        learner: AbstractExecutor,
        stale: float = STALE,
    ) -> None:
        """Begin with nothing learnt.

        Args:
            rig: The rig.
            extractor: The way to find the stripe.
            method: The way from pixels to points.
            laser: Number of the laser whose stripe is looked for.
            learner: Who learns anew; a process of its own leaves the finding alone.
            stale: Age from which a frame is dropped while others wait [s].
        """
        self.frames = Mailbox[ArrivedFrame](_WAITING)
        self.found = Mailbox[Found](_UNREAD)
        self.background: Background | None = None
        """What was learnt last; None while nothing was."""
        self.looked, self.dropped = 0, 0
        self.undecoded = 0
        """Pictures that were too late to be decoded."""
        self.newest: Frame | None = None
        self.drawable: tuple[Frame, Stripe] | None = None
        """The newest frame in which the stripe was looked for."""
        self.failure = ""
        """Why the finding has ended, if by an error of its own."""
        self._rig, self._extractor, self._method = rig, extractor, method
        self._laser, self._learner, self._stale = laser, learner, stale
        self._spread = SpreadFrames(_LATER)
        self.watch = PictureWatch()
        self._pending = deque[ArrivedFrame]()
        self._learn_next = threading.Event()
        self._due: float | None = None
        self._step = _AGAIN

    @property
    def is_busy(self) -> bool:
        """Tell whether more frames would have to be dropped, or would come before the learning."""
        is_learning = self._due is not None and self.background is None
        return not self.failure and (is_learning or len(self.frames) >= _ROOM)

    def run(self) -> None:
        """Find, until the frames' mailbox is done; an error ends the finding and nothing else."""
        learning = threading.Thread(target=self._keep_learning, daemon=True)
        learning.start()
        try:
            while not self.frames.is_done and not self.failure:
                background = self._wait_for_background()
                if background is not None:
                    self._find(background)
        except Exception as error:  # whatever it is, the recording goes on
            self.failure = f"The preview has ended ({error}); the recording goes on."
        finally:
            self.found.close()
            self._learn_next.set()
            # A process that ends beside a worker of its own that is still learning hangs.
            learning.join()

    def _wait_for_background(self) -> Background | None:
        while self.background is None and not self.frames.is_done and not self.failure:
            arrived = self.frames.get(_WAIT)
            if arrived is not None:
                self._note(arrived.frame)
                self.watch.look(arrived.frame, None)
        return self.background

    def _find(self, background: Background) -> None:
        given = self._extractor.extract_soon(
            self._feed(background), self._rig, background, laser=self._laser
        )
        for stripe in given:
            arrived = self._pending.popleft()
            profile = triangulate(stripe, self._rig, self._method)
            latency = time.monotonic() - arrived.arrived
            self._tell(arrived.frame, stripe, profile, latency)

    def _tell(self, frame: Frame, stripe: Stripe, profile: Profile, latency: float) -> None:
        look = Look.of(frame, profile, self._rig.laser(self._laser).axis)
        self.watch.look(frame, look)
        self.drawable = frame, stripe
        self.found.put(Found(frame.index, frame.time, frame.row_step, look, profile, latency))
        self.looked += 1

    def _feed(self, background: Background) -> Iterator[Frame]:
        """Give frames until something new has been learnt, or no more come."""
        last = -1
        while self.background is background and not self.frames.is_done:
            arrived = self._take()
            if arrived is None or arrived.frame.index <= last:
                continue
            last = arrived.frame.index
            self._note(arrived.frame)
            self._pending.append(arrived)
            yield arrived.frame

    def _take(self) -> ArrivedFrame | None:
        """Take the next frame; those that have waited too long go while there are others."""
        arrived = self.frames.get(_WAIT)
        while arrived is not None and time.monotonic() - arrived.arrived > self._stale:
            later = self.frames.get(0.0)
            if later is None:
                break
            self.dropped += 1
            arrived = later
        return arrived

    def _note(self, frame: Frame) -> None:
        """Keep a frame to learn from, and see whether it is time to."""
        self.newest = frame
        self._spread.add(frame)
        if self._due is None:
            if len(self._spread.frames()) >= _FIRST:
                self._due = frame.time + self._step
                self._learn_next.set()
        elif frame.time >= self._due and self.background is not None:
            self._step = min(_FACTOR * self._step, _RARELY)
            self._due = frame.time + self._step
            self._learn_next.set()

    def _keep_learning(self) -> None:
        task = _Learn(self._extractor, self._rig, self._laser)
        try:
            while True:
                self._learn_next.wait()
                self._learn_next.clear()
                if self.found.is_done or self.frames.is_done:
                    return
                # Nothing is found yet that the first learning could hold up, and a process takes
                # longer to start than it takes to learn.
                learner = Serial() if self.background is None else self._learner
                frames = self._spread.frames()
                learnt = next(learner.map(task, [frames]))
                if self.background is None:
                    self._practise(frames, learnt)
                    # A process begins as the thread that starts it, and imports for seconds.
                    give_way(_NICE)
                self.background = learnt
        except Exception as error:  # whatever it is, the recording goes on
            self.failure = f"The preview has ended ({error}); the recording goes on."

    def _practise(self, frames: Sequence[Frame], background: Background) -> None:
        """Find in frames that are known, for nothing: loops take a second on their first use."""
        found = self._extractor.extract_soon(frames, self._rig, background, laser=self._laser)
        for stripe in found:
            triangulate(stripe, self._rig, self._method)
