"""From what was seen lately to what a gauge shows."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..types.background import Attenuation
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.profile import Profile
from .sharpness import measure_stripe_width
from .status import Disk, Speed, StandOff, StripeStrength, WaterGauge
from .working_range import FARTHEST

HIDDEN = 5.0
"""Standard deviations of a pixel's noise below which a stripe may be lost in it; as the report
has it."""
_WEAK = 2.0
"""How many times that a median stripe should be: every tenth point is weaker by such a factor."""
_SEEN = 0.02
"""Share of the scan lines below which a frame shows no stripe; particles make some points."""
_MARGIN = 0.05
"""Share of the working range at either end in which the stand-off is not good, counted in inverse
depth: as the stripe moves across the picture."""
_LOW = 600.0
"""Time of recording below which room is short [s]."""
FULL = 200e6
"""Room that is left to the recording alone [bytes]: a minute of 25 Mbit/s."""
_ROOM = 2e9
"""Room below which it is short, whatever the bit rate [bytes]."""


@dataclass(frozen=True)
class Look:
    """What one frame showed."""

    time: float
    """Recording time [s]."""
    points: int
    num_lines: int
    """Scan lines that the frame has."""
    depth: float
    """Median z of its points in the camera frame [m]; NaN without any."""
    range: float
    """Median distance of its points from the camera [m]; NaN without any."""
    signal: float
    """Median height of its stripe [grey levels]; NaN without any."""
    width: float = math.nan
    """How wide the stripe is in the picture [px]; NaN without one."""

    @classmethod
    def of(cls, frame: Frame, profile: Profile, axis: Axis) -> "Look":
        """Summarise what was found in a frame.

        Args:
            frame: The frame.
            profile: Its points.
            axis: The camera axis along which the laser sits.
        """
        lines = frame.image.shape[1 if axis == "y" else 0]
        if not len(profile):
            return cls(frame.time, 0, lines, math.nan, math.nan, math.nan)
        return cls(
            frame.time,
            len(profile),
            lines,
            float(np.median(profile.points[:, 2])),
            float(np.median(np.linalg.norm(profile.points, axis=1))),
            float(np.median(profile.signal)),
            measure_stripe_width(frame, profile.pixels, axis),
        )

    @property
    def is_seen(self) -> bool:
        """Tell whether the frame shows the stripe, and not only a particle or two."""
        return self.points >= _SEEN * self.num_lines


def gauge_stand_off(
    looks: Sequence[Look], working: tuple[float, float], reach: float | None
) -> StandOff:
    """Compare the surface's distance with what the rig shows.

    Args:
        looks: What the latest frames showed.
        working: Nearest and farthest depth that the rig shows [m].
        reach: How far the water lets it see [m]; None where that is not known.
    """
    near, far = working
    far = far if reach is None else max(min(far, reach), near)
    depths = [look.depth for look in looks if look.points]
    if not depths:
        return StandOff(None, near, far)
    value = float(np.median(depths))
    place = (1 / value - 1 / far) / (1 / near - 1 / far) if near < far else 0.5
    if place > 1 - _MARGIN:
        return StandOff(value, near, far, "too near")
    return StandOff(value, near, far, "too far" if place < _MARGIN else "good")


def gauge_speed(value: float | None, rate: float | None, wanted: float) -> Speed:
    """Compare the camera's speed with what the spacing needs.

    Args:
        value: How fast it goes [m/s].
        rate: Frames a second that come [1/s].
        wanted: Wanted distance from profile to profile [m].
    """
    highest = None if rate is None else rate * wanted
    if value is None or highest is None:
        return Speed(_milli(value), _milli(highest))
    return Speed(_milli(value), _milli(highest), "good" if abs(value) <= highest else "too fast")


def gauge_stripe(looks: Sequence[Look], noise: float) -> StripeStrength:
    """Say how well the stripe stands out of the noise.

    Args:
        looks: What the latest frames showed.
        noise: Standard deviation of a pixel [grey levels].
    """
    if not looks:
        return StripeStrength(noise=noise)
    share = float(np.mean([look.points / max(look.num_lines, 1) for look in looks]))
    signals = [look.signal for look in looks if look.points]
    signal = float(np.median(signals)) if signals else None
    if share < _SEEN or signal is None:
        return StripeStrength(signal, noise, share, "lost")
    is_weak = signal < _WEAK * HIDDEN * noise
    return StripeStrength(signal, noise, share, "weak" if is_weak else "good")


def gauge_water(attenuation: Attenuation | None, looks: Sequence[Look], noise: float) -> WaterGauge:
    """Say how far the water lets this stripe be seen.

    Light fades by the attenuation on both ways, and a line of light spreads as its distance.

    Args:
        attenuation: What the glow told; None where it told nothing.
        looks: What the latest frames showed.
        noise: Standard deviation of a pixel [grey levels].
    """
    if attenuation is None:
        return WaterGauge()
    murk = attenuation.effective, attenuation.low, attenuation.high
    seen = [look for look in looks if look.points]
    if not seen or not noise > 0:
        return WaterGauge(*murk)
    here = float(np.median([look.range for look in seen]))
    signal = float(np.median([look.signal for look in seen]))
    return WaterGauge(*murk, _fade(here, signal / (HIDDEN * noise), attenuation.effective))


def _fade(here: float, headroom: float, attenuation: float) -> float:
    """Find the range at which a stripe of a headroom at a range is at the limit [m]."""
    low, high = 0.0, FARTHEST
    for _ in range(50):
        middle = (low + high) / 2
        left = math.log(max(headroom, 1e-9)) - 2 * attenuation * (middle - here)
        low, high = (middle, high) if left > math.log(middle / here) else (low, middle)
    return low


def gauge_disk(free: int, written: int, seconds: float) -> Disk:
    """Say how long the room that is left lasts.

    Args:
        free: Room [bytes].
        written: What was recorded [bytes] …
        seconds: … in which time [s].
    """
    left = free * seconds / written if written and seconds > 0 else None
    if free < FULL:
        return Disk(free, left, "full")
    is_low = free < _ROOM or (left is not None and left < _LOW)
    return Disk(free, left, "low" if is_low else "good")


def warn_of_disk(disk: Disk) -> tuple[str, ...]:
    """Say in a sentence that room is short; nothing where it is not."""
    if disk.free is None or disk.state == "good":
        return ()
    if disk.state == "full":
        return (
            f"The disk is full ({disk.free / 1e6:.0f} MB left): the preview halts so that the "
            "recording goes on; make room now.",
        )
    left = "" if disk.time_left is None else f", enough for {disk.time_left / 60:.0f} min"
    return (f"The disk is nearly full: {disk.free / 1e9:.1f} GB left{left}; make room.",)


def _milli(value: float | None) -> float | None:
    return None if value is None else 1e3 * value
