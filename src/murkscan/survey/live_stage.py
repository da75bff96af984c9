"""Show a dive, tick by tick, from what its source and its finder give."""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..capture import DiveFolder
from ..errors import MurkscanError
from ..live import LiveFolder, LiveStatus, LogWatch, gauge_disk, warn_of_disk
from ..live.gauges import FULL
from ..live.status import ScanProgress, State
from ..motion.following import AbstractFollower
from ..types.rig import Rig
from .live_finder import LiveFinder
from .live_settings import LiveSettings
from .live_source import LiveSource
from .live_view import LiveView

TICK = 0.25
"""Time from one status to the next [s]."""
_POINTS = 4
"""Ticks from one part of the points to the next."""
Tell = Callable[[LiveStatus], None]
"""Is told the status each time that it is written."""


class LiveStage:
    """What is shown of a dive, from where it is taken."""

    def __init__(
        self,
        source: str,
        pictures: LiveSource,
        finder: LiveFinder,
        *,
        show: LiveFolder,
        folder: DiveFolder,
        rig: Rig,
        settings: LiveSettings,
        tell: Tell,
    ) -> None:
        """Begin with nothing shown.

        Args:
            source: What the user calls it.
            pictures: Where its frames come from.
            finder: Who finds the stripe in them.
            show: Where to write.
            folder: Where the recording goes.
            rig: The rig.
            settings: How the dive is shown.
            tell: Told each status.
        """
        self.pictures, self._finder, self._show = pictures, finder, show
        self._folder, self._settings, self._tell = folder, settings, tell
        self._basis = LiveStatus(source=source)
        self._view = LiveView(
            show,
            rig,
            self._follow,
            laser=settings.laser,
            spacing=settings.spacing,
            working=settings.working,
        )
        self._log = LogWatch(is_replayed=pictures.is_replayed)
        self._ticks, self._failure, self._is_over = 0, "", False

    def tick(self) -> None:
        """Show what has come; that the preview fails ends no recording."""
        self._ticks += 1
        try:
            view, free = self._view, self._free()
            if self.pictures.recorded.pictures and self._basis.began is None:
                self._basis = replace(self._basis, began=self._began() or time.time())
            if free > FULL:
                view.draw(self._finder)
                if self._ticks % _POINTS == 0 or self._is_over:
                    view.add(self._finder.found.take_all(), self._finder)
                    self._watch_log()
            state, message = self._say()
            status = view.tell(
                state,
                message,
                recorded=self.pictures.recorded,
                finder=self._finder,
                free=free,
                warnings=self._warn(free),
                basis=self._basis,
            )
            self._tell(status)
        except MurkscanError as error:
            self._failure = f"The preview halts ({error}); the recording goes on."
            self._tell(replace(self._basis, state="live", warnings=(self._failure,)))

    def finish(self) -> None:
        """Show the rest, and the map as it is at the end."""
        self._is_over = True
        for _ in range(2):
            self._ticks = -1
            self.tick()
            background = self._finder.background
            self._view.draw_map(0.0 if background is None else background.noise)

    def _follow(self) -> AbstractFollower:
        follower = self._settings.follow(self._began())
        # The way begins where the recording does, as that of the scan will.
        follower.follow(np.array([self.pictures.start]), np.zeros(1))
        return follower

    def _watch_log(self) -> None:
        """See whether the log that is followed and the pictures go by the same clock."""
        follower, newest = self._view.follower, self._view.newest
        if follower is not None and newest is not None:
            self._log.look(newest, follower.known_from, follower.known_until)

    def _began(self) -> float:
        """Tell when the recording began; a replayed one has no clock."""
        record = self._folder.record
        return 0.0 if record is None else record.began

    def _free(self) -> int:
        return self._settings.find_room(self._show.root.parent)

    def _say(self) -> tuple[State, str]:
        recorded, silence = self.pictures.recorded, self.pictures.silence
        if recorded.pictures == 0:
            return "waiting", "Waiting for the first picture."
        if self._is_over:
            return "live", "The dive is over, and all of it is recorded."
        if silence:
            return "lost", (
                f"No picture has come for {silence:.0f} s; the stream is waited for, and what came "
                "is kept."
            )
        if self._finder.background is None:
            return "learning", "Pictures come and are recorded; learning what they look like."
        return "live", self.pictures.word

    def _warn(self, free: int) -> list[str]:
        warnings = [text for text in (self._finder.failure, self._failure) if text]
        warnings += self._log.warnings()
        recorded = self.pictures.recorded
        return [*warnings, *warn_of_disk(gauge_disk(free, recorded.bytes, recorded.time))]


class ScanTeller:
    """Writes into the status how far the scan is, and how long its stage will take."""

    def __init__(self, show: LiveFolder, status: LiveStatus) -> None:
        """Go on from a status."""
        self._show, self.status = show, status
        self._stage, self._since, self._told = "", 0.0, 0.0

    def __call__(self, stage: str, done: int, total: int | None) -> None:
        """Take note of a step; see `Progress`."""
        now = time.monotonic()
        if stage != self._stage:
            self._stage, self._since, self._told = stage, now, 0.0
        if now - self._told < TICK:
            return
        self._told = now
        left = (now - self._since) * (total - done) / done if total and done else None
        step = ScanProgress(stage, done, total, left)
        self.status = replace(self.status, updated=time.time(), scan=step)
        self._show.save_status(self.status)
