"""What a correction of a motion is, in sentences."""

import math

from ..types.lengths import in_mm
from .adjust.sureness import Sureness
from .corrected import Correction
from .sheets_apart import SheetsApart

_NAMES = {
    "velocity_bias_x": ("velocity forward", "mm/s", 1e3),
    "velocity_bias_y": ("velocity to starboard", "mm/s", 1e3),
    "velocity_bias_z": ("velocity downwards", "mm/s", 1e3),
    "speed_factor": ("the speed", "%", 1e2),
    "roll_bias": ("roll", "°", math.degrees(1)),
    "pitch_bias": ("pitch", "°", math.degrees(1)),
    "heading_drift": ("heading", "° a minute", 60 * math.degrees(1)),
}
"""Errors of instruments that are told where the scan has found them."""
_FOUND = 0.5
"""Share of the stated standard deviation below which an error counts as found."""
_CLOCK = 0.02
"""Standard deviation up to which a clock's offset counts as found [s]: at 0.1 m/s, 2 mm."""


def tell_correction(correction: Correction) -> tuple[str, ...]:
    """Say how far the log was corrected, how sure each direction is, and what stayed open."""
    return (
        f"corrected from what the scan saw twice, by {_tell_moved(correction)}",
        *_tell_known(correction, _SECOND),
    )


def tell_correction_of_pass(correction: Correction) -> tuple[str, ...]:
    """Say the same of a pass that was corrected together with others."""
    lines = [
        f"corrected along its way from what the passes saw of the same places, by "
        f"{_tell_moved(correction)} from where it lay as a rigid body",
        *_tell_known(correction, _CROSSING),
    ]
    if correction.is_astray:
        lines.append(
            f"over {correction.astray:.1f} s of it, bumps do not lie on those that other passes "
            "saw there: its way may be wrong there by more than is stated, or the surface has "
            "changed; a log that knows it better, a second laser or passes that overlap more "
            "would tell"
        )
    return tuple(lines)


_SECOND = (
    "a second pass at right angles near the middle, laid on this one by `murkscan merge`, would "
    "tell"
)
_CROSSING = "a pass that crosses this one at right angles near its middle would tell"


def _tell_moved(correction: Correction) -> str:
    moved, times = correction.moved, correction.trajectory.times
    usual, most = math.sqrt((moved**2).mean()), float(moved.max())
    return (
        f"{in_mm(usual, digits=3)} mm (RMS), {in_mm(most, digits=3)} mm at most, "
        f"{times[moved.argmax()] - times[0]:.1f} s after the beginning"
    )


def _tell_known(correction: Correction, cure: str) -> list[str]:
    """Say how sure each direction is, and what stayed open."""
    lines = [
        "known now to (1σ, but for the ends; in brackets by the log alone): "
        + ", ".join(map(_tell_sureness, correction.sureness)),
    ]
    lines += _tell_instruments(correction)
    if clock := _tell_clock(correction):
        lines.append(clock)
    is_open = [one.name for one in correction.sureness if one.is_open]
    if is_open:
        lines.append(f"from the log alone: {', '.join(is_open)}; {cure}")
    if not correction.num_tiles:
        lines.append(
            "the surface is too plain to show the shift along it: the way's length and place are "
            "those of the log"
        )
    return lines


def tell_doubt(correction: Correction) -> str:
    """Say why a correction is not believed."""
    return (
        "the trajectory is the log's alone: correcting it from the scan came to rest in a wrong "
        f"place. Over {correction.blind:.1f} s of it, surface that was seen twice did not lie on "
        "its like. Is the log of this recording, as good as [navigation] says, and are the lasers "
        "calibrated?"
    )


def tell_sheets(apart: SheetsApart) -> str:
    """Say how far two lasers' surfaces lie apart by poses that are not to be changed."""
    far = (
        f"where both lasers passed, their surfaces lie {in_mm(apart.between.rms)} mm (RMS) "
        f"apart, {in_mm(apart.between.within_95)} mm at 95 % of the places"
    )
    if apart.is_noise:
        return f"{far}: no more than noise, so poses and calibration agree"
    return (
        f"{far}: so far are the poses, or the lasers' calibration, off between the two looks. The "
        "poses are left as they are; say in [navigation] of the rig file how good they are, and "
        "the scan corrects them"
    )


def _tell_sureness(one: Sureness) -> str:
    if one.unit == "rad":
        return f"{one.name} {math.degrees(one.found):.2g}° ({math.degrees(one.logged):.2g}°)"
    return f"{one.name} {in_mm(one.found)} mm ({in_mm(one.logged)} mm)"


def _tell_instruments(correction: Correction) -> list[str]:
    found = [
        f"{name} {scale * value:+.2g} ± {scale * sigma:.1g} {unit}"
        for key, (name, unit, scale) in _NAMES.items()
        for value, sigma, stated in [correction.instruments.get(key, (0.0, 1.0, 1.0))]
        if sigma < _FOUND * stated
    ]
    return [f"the instruments are off, as found: {', '.join(found)}"] if found else []


def _tell_clock(correction: Correction) -> str:
    """Say how far the log's clock is off, or that the scan does not tell."""
    if "clock_offset" not in correction.instruments:
        return ""
    value, sigma, stated = correction.instruments["clock_offset"]
    if sigma > min(_CLOCK, _FOUND * stated):
        return (
            f"the log's clock is not determined by the scan: {value:+.3f} ± {sigma:.3f} s (1σ); "
            "where the vehicle rolls or pitches by a degree or more, it is"
        )
    late = "behind" if value > 0 else "ahead of"
    return (
        f"the log's clock is {abs(value):.3f} ± {sigma:.3f} s {late} the recording's (1σ), and is "
        "corrected by that"
    )
