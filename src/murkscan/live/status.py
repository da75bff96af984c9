"""What a running dive says of itself, as OUT/live/status.json has it: gauges, counts, warnings."""

from dataclasses import dataclass, field
from typing import Literal

State = Literal["waiting", "learning", "live", "lost", "scanning", "done", "failed"]
"""No picture yet; pictures, but nothing learnt from them; the preview runs; the stream is silent;
the dive is over and the scan runs; all is done; it ended with an error."""


@dataclass(frozen=True)
class Recorded:
    """What is safe on the disk."""

    pictures: int = 0
    time: float = field(default=0.0, metadata={"unit": "s"})
    """Time of the last picture since the dive began [s]."""
    bytes: int = 0
    file: str = ""
    """The file that grows, in the scan's folder; empty where a recording is replayed."""
    losses: int = 0
    """How often the stream broke off."""


@dataclass(frozen=True)
class Preview:
    """How well the preview keeps up."""

    frames: int = 0
    """Frames in which the stripe was looked for."""
    dropped: int = 0
    """Frames that came faster than they could be looked at; the recording has them."""
    latency: float | None = field(default=None, metadata={"unit": "s"})
    """Time from a frame's arrival to its profile that 95 % of the latest frames kept [s]."""
    frame_rate: float | None = field(default=None, metadata={"unit": "hz"})
    """Frames a second that come, fields counted [1/s]."""


@dataclass(frozen=True)
class StandOff:
    """How far the surface is."""

    value: float | None = field(default=None, metadata={"unit": "m"})
    """Median z of the latest points in the camera frame [m]."""
    near: float | None = field(default=None, metadata={"unit": "m"})
    far: float | None = field(default=None, metadata={"unit": "m"})
    """Between these the rig and the water show the surface [m]."""
    state: Literal["too near", "good", "too far", "unknown"] = "unknown"


@dataclass(frozen=True)
class Speed:
    """How fast the camera goes, against what the wanted spacing needs."""

    value: float | None = field(default=None, metadata={"unit": "mm_s"})
    highest: float | None = field(default=None, metadata={"unit": "mm_s"})
    """Speed at which profiles lie as far apart as wanted [mm/s]."""
    state: Literal["good", "too fast", "unknown"] = "unknown"


@dataclass(frozen=True)
class StripeStrength:
    """How well the stripe stands out."""

    signal: float | None = None
    """Median height above its surroundings [grey levels]."""
    noise: float | None = None
    """Standard deviation of a pixel [grey levels]."""
    share: float | None = None
    """Share of the scan lines that show it."""
    state: Literal["good", "weak", "lost", "unknown"] = "unknown"


@dataclass(frozen=True)
class WaterGauge:
    """How murky it is, and how far that lets the rig see."""

    attenuation: float | None = field(default=None, metadata={"unit": "per_m"})
    """What the sheet's own glow fades by [1/m]."""
    low: float | None = field(default=None, metadata={"unit": "per_m"})
    high: float | None = field(default=None, metadata={"unit": "per_m"})
    """Ends of an interval that holds the beam attenuation [1/m]."""
    reach: float | None = field(default=None, metadata={"unit": "m"})
    """Range at which a stripe such as this one will be lost in the noise [m]."""


@dataclass(frozen=True)
class Disk:
    """What room is left."""

    free: int | None = field(default=None, metadata={"unit": "bytes"})
    time_left: float | None = field(default=None, metadata={"unit": "s"})
    """How long that lasts at the present bit rate [s]."""
    state: Literal["good", "low", "full"] = "good"


@dataclass(frozen=True)
class Covered:
    """How much of the surface that was passed is covered at the wanted spacing."""

    covered: float = field(default=0.0, metadata={"unit": "m2"})
    missing: float = field(default=0.0, metadata={"unit": "m2"})
    share: float | None = None
    """Of the two, the share that is covered; None where nothing was seen yet."""


@dataclass(frozen=True)
class PointCount:
    """How far the growing preview is."""

    parts: int = 0
    count: int = 0


@dataclass(frozen=True)
class ScanProgress:
    """How far the scan after the dive is."""

    stage: str
    done: int
    total: int | None
    time_left: float | None = field(metadata={"unit": "s"})


@dataclass(frozen=True)
class LiveStatus:
    """All of it. Keys may be added; what is not known is None."""

    format: int = 1
    state: State = "waiting"
    message: str = ""
    """What goes on, or what is wrong and its cure; one sentence."""
    updated: float = field(default=0.0, metadata={"unit": "s"})
    """When this was written, in seconds since 1970: long ago, the process is gone."""
    pid: int = 0
    source: str = ""
    began: float | None = field(default=None, metadata={"unit": "s"})
    """When the first picture came, in seconds since 1970."""
    recorded: Recorded = Recorded()
    preview: Preview = Preview()
    stand_off: StandOff = StandOff()
    speed: Speed = Speed()
    stripe: StripeStrength = StripeStrength()
    water: WaterGauge = WaterGauge()
    disk: Disk = Disk()
    coverage: Covered = Covered()
    warnings: tuple[str, ...] = ()
    """What the pilot should know now, in sentences; none on a good dive."""
    points: PointCount = PointCount()
    scan: ScanProgress | None = None
