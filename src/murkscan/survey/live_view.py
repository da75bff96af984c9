"""Show a dive while it goes on: points, gauges, warnings, the map of gaps, into OUT/live."""

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..io.images import write_image
from ..live import (
    PATIENCE,
    GapMap,
    LiveFolder,
    LiveStatus,
    RecentLooks,
    draw_picture,
    find_working_range,
    gauge_disk,
    gauge_speed,
    gauge_stand_off,
    gauge_stripe,
    gauge_water,
    speed_of,
    thin_points,
)
from ..live.status import Covered, Disk, PointCount, Preview, Recorded, State
from ..motion.following import AbstractFollower
from ..report import (
    CAUSES,
    CellSums,
    Coverage,
    EvenSample,
    GrowingCoverage,
    Reach,
    SurfaceDirections,
)
from ..report.swath_layout import SwathLayout
from ..types.background import Attenuation, Background
from ..types.frame_times import FrameTimes
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .live_finder import Found, LiveFinder

_SAMPLE = 50_000
"""Points from which it is learnt how far the light goes."""
_CELLS = 1_000_000
"""Cells of the map above which they become larger: 25 m² in cells of 5 mm."""
_LEAST_WAY = 0.1
"""Way from which it is known where a camera that follows a log is heading [m]."""
_BUSY = 10.0
"""The map is drawn anew after so many times as long as that takes: it slows down as it grows."""


class LiveView:
    """Is fed with what the frames showed, and writes what a pilot looks at."""

    def __init__(
        self,
        folder: LiveFolder,
        rig: Rig,
        follow: Callable[[], AbstractFollower],
        *,
        laser: int,
        spacing: float,
        working: tuple[float, float] | None = None,
    ) -> None:
        """Begin with nothing seen; points of an earlier run of the same dive stay.

        Args:
            folder: Where to write.
            rig: The rig.
            follow: Makes what follows the camera, when its first frame has been looked at.
            laser: Number of the laser.
            spacing: Wanted spacing of the points [m].
            working: Nearest and farthest depth at which the rig was calibrated [m]; None: as far
                as its sheet crosses the picture.
        """
        self._folder, self._rig, self._make_follower = folder, rig, follow
        self.follower: AbstractFollower | None = None
        """What follows the camera; None until there is a frame to be placed."""
        self.newest: float | None = None
        """Time of the newest frame that was looked at [s]."""
        self._laser, self._spacing = laser, spacing
        self._axis = rig.laser(laser).axis
        self._working = _narrow(find_working_range(rig, laser), working)
        self._recent, self._waiting = RecentLooks(), list[Found]()
        self._frames = FrameTimes(np.zeros(0, np.uint32), np.zeros(0))
        self._ranges, self._signals = EvenSample(_SAMPLE), EvenSample(_SAMPLE)
        self._directions: SurfaceDirections | None = None
        self._early: list[tuple[Profile, Trajectory]] = []
        self._coverage = GrowingCoverage(wanted=spacing, cell=spacing, most=_CELLS)
        self._go_on()
        self._speed: float | None = None
        self._covered, self._draw_next = Covered(), 0.0
        self._drawn, self._shown = -1, -1
        there = folder.find_points()
        self._points = PointCount(max(there, default=-1) + 1)
        self._fields = 1

    def add(self, found: Sequence[Found], finder: LiveFinder) -> None:
        """Take note of frames, in order, and write the points whose poses are known by now."""
        for one in found:
            self._recent.add(one.look, one.index, one.latency)
            self._fields = one.row_step
        self._waiting += found
        if not self._waiting:
            return
        self.follower = self.follower or self._make_follower()
        self.follower.refresh()
        self.newest = self._waiting[-1].time
        until = max(self.follower.known_until, self.newest - PATIENCE)
        ready = [one for one in self._waiting if one.time <= until]
        self._waiting = self._waiting[len(ready) :]
        if ready:
            self._place(
                ready, self.follower, 0.0 if finder.background is None else finder.background.noise
            )

    def draw(self, finder: LiveFinder) -> None:
        """Write the newest picture, and the newest one in which the stripe was looked for."""
        newest = finder.newest
        if newest is not None and newest.index != self._drawn:
            self._drawn = newest.index
            write_image(self._folder.picture, draw_picture(newest))
        if finder.drawable is not None and finder.drawable[0].index != self._shown:
            frame, stripe = finder.drawable
            self._shown = frame.index
            write_image(self._folder.stripe, draw_picture(frame, stripe.pixels))

    def tell(
        self,
        state: State,
        message: str,
        *,
        recorded: Recorded,
        finder: LiveFinder,
        free: int,
        warnings: Sequence[str],
        basis: LiveStatus,
    ) -> LiveStatus:
        """Write the status.

        Args:
            state: What goes on.
            message: The same in words.
            recorded: What is on the disk.
            finder: Who finds the stripe.
            free: Room on the disk [bytes].
            warnings: What is wrong beside what the pictures show.
            basis: What stays the same.
        """
        background, looks = finder.background, self._recent.looks
        noise = 0.0 if background is None else background.noise
        water = gauge_water(_murk(background), looks, noise)
        rate = self._recent.rate
        status = replace(
            basis,
            state=state,
            message=message,
            updated=time.time(),
            pid=os.getpid(),
            recorded=recorded,
            preview=Preview(
                finder.looked,
                finder.dropped + finder.frames.dropped + finder.undecoded * self._fields,
                self._recent.latency,
                rate,
            ),
            stand_off=gauge_stand_off(looks, self._working, water.reach),
            speed=gauge_speed(self._speed, rate, self._spacing),
            stripe=gauge_stripe(looks, noise),
            water=water,
            disk=gauge_disk(free, recorded.bytes, recorded.time) if free >= 0 else Disk(),
            coverage=self._covered,
            warnings=(*warnings, *finder.watch.warnings()),
            points=self._points,
        )
        self._folder.save_status(status)
        return status

    def _place(self, found: Sequence[Found], follower: AbstractFollower, noise: float) -> None:
        """Carry what was found into the world, and add it to points and map."""
        times = np.array([one.time for one in found])
        numbers = np.array([one.index for one in found], np.uint32)
        way = follower.follow(times, numbers / self._fields)
        if way is None:
            return
        placed = way.has(times)
        self._frames = FrameTimes(
            np.append(self._frames.frame, numbers[placed]),
            np.append(self._frames.time, times[placed]),
        )
        self._speed = speed_of(way)
        profile = Profile.concatenate(
            [one.profile for one, known in zip(found, placed, strict=True) if known]
        )
        if len(profile):
            self._save_points(profile, way)
            self._ranges.add(np.linalg.norm(profile.points, axis=1))
            self._signals.add(profile.signal)
            self._add_to_map(profile, way, noise)

    def _go_on(self) -> None:
        """Take up the map of an earlier run of the same dive."""
        gaps, cells = self._folder.load_gaps(), self._folder.load_cells()
        if gaps is None or cells is None or len(cells["edge_m"]) == 0:
            return
        self._coverage.go_on(CellSums.from_columns(cells), float(cells["edge_m"][0]))
        # Of heights only differences count, so that either side is towards the scanner.
        towards = np.cross(gaps.along, gaps.across)
        self._directions = SurfaceDirections(gaps.along, gaps.across, towards)

    def _save_points(self, profile: Profile, way: Trajectory) -> None:
        world = way.transform(profile.points, profile.time)
        points = thin_points(profile, world, self._spacing)
        self._folder.save_points(self._points.parts, points)
        self._points = PointCount(self._points.parts + 1, self._points.count + len(points))

    def _add_to_map(self, profile: Profile, way: Trajectory, noise: float) -> None:
        self._early.append((profile, way))
        if self._directions is None:
            whole = Trajectory.concatenate([one for _, one in self._early])
            reach = np.linalg.norm(whole.positions[-1] - whole.positions[0])
            if reach < _LEAST_WAY:
                return
            self._directions = SurfaceDirections.from_trajectory(whole, self._axis)
        for one, passed in self._early:
            layout = SwathLayout(
                self._frames,
                passed,
                self._axis,
                self._rig.camera.size,
                self._fields,
                self._directions,
            )
            self._coverage.add([one], layout, self._reach(noise))
        self._early = []
        if time.monotonic() >= self._draw_next:
            self.draw_map(noise)

    def draw_map(self, noise: float) -> None:
        """Write the map of gaps as it is by now."""
        if self._directions is None:
            return
        began = time.monotonic()
        coverage = self._coverage.as_map()
        if coverage is not None:
            gaps = _as_gaps(coverage)
            self._folder.save_gaps(gaps)
            self._save_cells()
            self._covered = Covered(gaps.covered, gaps.missing, gaps.share)
        now = time.monotonic()
        self._draw_next = now + max(2.0, _BUSY * (now - began))

    def _save_cells(self) -> None:
        sums = self._coverage.sums
        if sums is not None:
            columns = sums[0].as_columns()
            self._folder.save_cells(columns | {"edge_m": np.full(len(columns["along"]), sums[1])})

    def _reach(self, noise: float) -> Reach:
        return Reach.from_points(self._ranges.values(), self._signals.values(), noise=noise)


def _narrow(
    crossed: tuple[float, float], proven: tuple[float, float] | None
) -> tuple[float, float]:
    """Keep of the depths at which the sheet crosses the picture those that were proven."""
    if proven is None or not max(crossed[0], proven[0]) < min(crossed[1], proven[1]):
        return crossed
    return max(crossed[0], proven[0]), min(crossed[1], proven[1])


def _murk(background: Background | None) -> Attenuation | None:
    return None if background is None else background.water


def _as_gaps(coverage: Coverage) -> GapMap:
    """Give a coverage the form in which it is shown.

    What the preview had no time for counts as covered where both its neighbours are: a gap of the
    preview is none of the dive.
    """
    unseen = CAUSES.index("unreadable") + 1
    areas = coverage.areas.copy()
    areas[0] += areas[unseen]
    areas[unseen] = 0.0
    covered = coverage.covered + coverage.missing["unreadable"]
    return GapMap(
        replace(coverage, areas=areas).state().astype(np.uint8),  # -1, nothing, becomes 255
        CAUSES,
        coverage.cell,
        coverage.corner,
        coverage.directions.along,
        coverage.directions.across,
        covered,
        coverage.mapped - covered,
    )
