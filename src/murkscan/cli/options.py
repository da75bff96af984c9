"""Flags that several commands share."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Group, Parameter

from ..errors import InputError
from ..ui.values import read_start_time
from .paths import MaybeLogPath
from .words import tell

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..capture import AbstractRecording
    from ..distribute import AbstractExecutor
    from ..motion import AbstractMotion
    from ..types.rig import Rig
    from ..types.trajectory import Trajectory


def _require_attenuation(_: object, value: float | None) -> None:
    if value is not None and not 0 <= value < float("inf"):
        raise InputError(f"--attenuation-per-m must be 0 or more, got {value:g}.")


Place = Annotated[str, Parameter(allow_leading_hyphen=True)]
"""Coordinates parted by commas, of which the first may be negative."""
MaybePlace = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
"""The same, which may be left out."""
Attenuation = Annotated[
    float | None,
    Parameter(
        help="Beam attenuation of the water per metre, by which the points' reflectance is "
        "corrected; as the laser's glow tells it unless said.",
        validator=_require_attenuation,
    ),
]
MOTION = Group("How the camera moved", sort_key=11)
READING = Group("How to read the recording", sort_key=12)
WORK = Group("Who does the work", sort_key=13)
"""Every command shows its own flags first, then these, in this order."""

Settings = Annotated[tuple[str, ...], Parameter(name="--set", negative=())]
"""Settings of a Choice, each as NAME=NUMBER."""
NoAdjust = Annotated[bool, Parameter(negative=())]
"""Whether a trajectory stays as it is logged."""
Lasers = Annotated[tuple[int, ...], Parameter(negative=())]
"""Numbers of lasers of the rig; none for all."""


@Parameter(name="*", group=READING)
@dataclass(frozen=True)
class RecordingFlags:
    """How to read the recording."""

    fps: float | None = None
    """Pictures a second, for a folder of images without times.csv."""
    fields: Literal["auto", "progressive", "top-first", "bottom-first"] = "auto"
    """Whether a picture holds two fields of an interlaced camera; found if not said."""
    topic: str | None = None
    """Topic of the pictures in an MCAP or a bag; asked for where there are several."""

    def open(self, paths: Sequence[Path], rig: "Rig") -> "AbstractRecording":
        """Open the recording of a rig: one path, or chapters in order."""
        from ..capture import open_recording

        recording = open_recording(
            paths, wavelength=rig.wavelength, fps=self.fps, fields=self.fields, topic=self.topic
        )
        for remark in recording.remarks:
            tell("recording", f"{paths[0].name}: {remark}")
        return recording


@Parameter(name="*", group=WORK)
@dataclass(frozen=True)
class ExecutorFlags:
    """Who does the work; the result is the same."""

    executor: Literal["serial", "threads", "processes", "dask"] = "threads"
    """One thread, several, several processes, or the workers of a Dask cluster."""
    workers: int | None = None
    """How many threads or processes; as many as there are cores unless said."""
    dask_address: str | None = None
    """Where a Dask cluster's scheduler listens, as tcp://host:8786; without it one is begun."""

    def make(self) -> "AbstractExecutor":
        """Make the executor that these flags describe."""
        from ..distribute import Dask, Processes, Serial, Threads

        if self.dask_address is not None and self.executor != "dask":
            raise InputError("--dask-address goes with --executor dask; leave it out.")
        if self.executor == "dask":
            return Dask(self.dask_address, self.workers)
        if self.executor == "serial":
            if self.workers is not None:
                raise InputError("--workers does not go with --executor serial; leave it out.")
            return Serial()
        return Processes(self.workers) if self.executor == "processes" else Threads(self.workers)


_OF_LOGS = {"start_time": "0", "time_offset_s": 0.0, "gap_s": 0.5, "crs": None}
"""Flags that mean something to a log only, and what they are unless given."""
_OF_POSES = ("log_time", "log_quaternion", "log_axes", "log_angles")
"""Flags that mean something to a log of poses only."""


@Parameter(name="*", group=MOTION)
@dataclass(frozen=True)
class MotionFlags:
    """How the camera moved: --speed-mm-s, --step-mm, --poses, or what the vehicle measured."""

    speed_mm_s: float | None = None
    """Constant speed [mm/s]; negative for the other way."""
    step_mm: float | None = None
    """Constant step [mm] from one recorded picture to the next; negative for the other way."""
    poses: MaybeLogPath = None
    """Log of poses: CSV by its columns' names, EuRoC, rostopic echo -p, or TUM; docs/motion.md."""
    navigation: MaybeLogPath = None
    """What the vehicle's instruments measured: MCAP, bag, .tlog, NMEA, or CSV; docs/dive.md."""
    no_navigation: Annotated[bool, Parameter(negative=())] = False
    """Take only the pictures of an MCAP or a bag."""
    crs: str | None = None
    """System in which latitude and longitude become metres, as EPSG:32632; else UTM's zone."""
    along: Literal["x", "y", "z"] | None = None
    """Camera axis of a constant speed or step; the laser's axis unless said."""
    speed_sigma_percent: float | None = None
    """Standard deviation of the speed or the step [%]; unless said, speed_percent of the rig file's
    [navigation], else 10 of a speed and 1 of a step."""
    start_time: str = "0"
    """When the video began, by the log's clock: seconds, or ISO 8601."""
    time_offset_s: float = 0.0
    """Added to recording times [s]."""
    gap_s: float = 0.5
    """Longest time between two poses of the log that is bridged [s]."""
    log_time: Literal["s", "ms", "us", "ns"] | None = None
    """What the log's times count; found from the column's name or the size of the numbers."""
    log_quaternion: Literal["wxyz", "xyzw"] | None = None
    """Order of the quaternion in a log whose columns have no names; xyzw, as TUM, unless said."""
    log_axes: Literal["ned", "enu"] | None = None
    """Axes by which the log's roll, pitch and heading turn: north-east-down unless said."""
    log_angles: Literal["deg", "rad"] | None = None
    """Unit of the log's roll, pitch and heading; found from the column's name, else degrees."""

    def check(self, recording: Path | None = None) -> None:
        """Refuse flags that describe no motion, before anything else is done.

        Args:
            recording: The recording; an MCAP or a bag holds a log itself.

        Raises:
            InputError: There is none, or more than one, or a flag that changes nothing.
        """
        given = [flag for flag in (self.speed_mm_s, self.step_mm, self.poses) if flag is not None]
        log = self._find_log(recording)
        if len(given) > 1 or (not given and log is None):
            raise InputError(
                f"Give exactly one of --speed-mm-s, --step-mm and --poses; {len(given) or 'none'} "
                f"{'were' if given else 'was'} given, and without knowing how the camera moved "
                "there is no model. A vehicle's own log goes with --navigation."
            )
        if self.navigation is not None and (self.no_navigation or log is None):
            raise InputError("--navigation goes with no other flag but --speed-mm-s; leave it out.")
        if 0 in given:
            raise InputError(
                "--speed-mm-s and --step-mm take a number other than 0; a camera that stands still "
                "sees one profile."
            )
        self._check_effect(log)
        read_start_time(self.start_time)

    def make(self, rig: "Rig", laser: int, recording: Path | None = None) -> "AbstractMotion":
        """Make the motion that these flags describe."""
        from ..motion import ConstantSpeed, ConstantStep, PoseLog
        from ..types.pose import Pose

        self.check(recording)
        along = self.along or rig.laser(laser).axis
        log = self._find_log(recording)
        stated = None if rig.navigation is None else rig.navigation.speed
        sigma = stated if self.speed_sigma_percent is None else self.speed_sigma_percent / 100
        known = {} if sigma is None else {"sigma": sigma}
        if log is not None:
            return self._follow(log, rig, along, known)
        if self.speed_mm_s is not None:
            return ConstantSpeed(self.speed_mm_s / 1e3, along, **known)
        if self.step_mm is not None:
            return ConstantStep(self.step_mm / 1e3, along, **known)
        assert self.poses is not None
        mount = rig.vehicle_from_camera or Pose.identity()
        return PoseLog(
            self._read_log(self.poses),
            mount,
            read_start_time(self.start_time),
            self.time_offset_s,
            self.gap_s,
            stated=rig.navigation,
            name=str(self.poses),
        )

    def _find_log(self, recording: Path | None) -> Path | None:
        """Give the log of measurements that is to be followed, if there is any."""
        if self.step_mm is not None or self.poses is not None or self.no_navigation:
            return None
        if self.navigation is not None:
            return self.navigation
        from ..io.dive.names import is_dive

        return recording if recording is not None and is_dive(recording) else None

    def _follow(
        self,
        log: Path,
        rig: "Rig",
        along: 'Literal["x", "y", "z"]',
        known: "Mapping[str, float]",
    ) -> "AbstractMotion":
        """Follow a log of measurements, and say how it was understood."""
        from ..motion.navigated import follow_navigation

        motion, said = follow_navigation(
            log,
            rig,
            speed=None if self.speed_mm_s is None else self.speed_mm_s / 1e3,
            along=along,
            **known,
            crs=self.crs,
            start_time=read_start_time(self.start_time),
            time_offset=self.time_offset_s,
            gap=self.gap_s,
        )
        tell("navigation", f"{log.name}: {said[0]}")
        for words in said[1:]:
            tell("note", words)
        return motion

    def _read_log(self, path: Path) -> "Trajectory":
        """Read the log of poses, and say how it was understood."""
        from ..io.pose_reading import PoseConvention
        from ..io.poses import read_pose_log

        said = (self.log_time, self.log_quaternion, self.log_axes, self.log_angles)
        read = read_pose_log(path, PoseConvention(*said))
        tell("poses", f"{path}: {len(read.log.times):,}, {read.understood}")
        if read.left_out:
            tell("note", read.tell_left_out())
        return read.log

    def _check_effect(self, log: Path | None) -> None:
        unused = [] if log or self.poses else list(_OF_LOGS)
        if self.poses is None:
            unused += _OF_POSES
        for name in unused:
            if getattr(self, name) != _OF_LOGS.get(name):
                flag = f"--{name.replace('_', '-')}"
                raise InputError(f"{flag} goes with --poses; leave it out.")
        for name in ("along", "speed_sigma_percent"):
            is_idle = self.poses or (log and self.speed_mm_s is None)
            if is_idle and getattr(self, name) is not None:
                flag = f"--{name.replace('_', '-')}"
                raise InputError(f"{flag} goes with --speed-mm-s or --step-mm; leave it out.")
