"""What every calibration says in the terminal: the verdict, what it means, then the details."""

import math
from collections.abc import Mapping
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from .words import print_table, say, say_verdict, tell

_NEXT = {
    "camera": (
        "in air: murkscan calibrate laser PHOTOS --board 9x6 --square-mm 30 --rig {rig}",
        "behind a window: write [camera.port] and [water] into {rig} as measured, then "
        "murkscan calibrate port PHOTOS --board 9x6 --square-mm 30 --rig {rig}",
    ),
    "port": ("murkscan calibrate laser PHOTOS --board 9x6 --square-mm 30 --rig {rig}",),
    "laser": (
        "murkscan calibrate check PHOTOS --board 9x6 --square-mm 30 --rig {rig}, in the water at "
        "hand",
        "murkscan scan RECORDING --rig {rig} --speed-mm-s V --out OUT",
    ),
    "mount": ("murkscan scan RECORDING --rig {rig} --poses LOG --out OUT",),
}
"""What follows each step; the board is whoever's it is."""

if TYPE_CHECKING:
    from ..calibrate import Calibration, CalibrationVerdict
    from ..survey.calibrate import CalibrationResult


def print_result(result: "CalibrationResult", rig: Path) -> None:
    """Print the result of a calibration that was written to a rig file."""
    from ..calibrate.words import MEANING

    found = result.calibration
    say_verdict(str(result.verdict), result.verdict.is_good, is_usable=result.verdict.is_usable)
    _print_errors(result.verdict)
    _print_parameters(found)
    for number in found.lasers:
        _print_sheet(found, number)
    _print_photos(found)
    say_unused(result.unused, used=len(found.sightings))
    for remark in result.remarks:
        tell("note", remark)
    tell("meaning", MEANING)
    tell("made", f"written to {rig}; as it is now it is kept as {result.record}")
    tell("look", f"open {result.page}: every photo, and what was found in it")
    tell("next", *_next_steps(found.step, result.verdict, rig))


def _next_steps(step: str, verdict: "CalibrationVerdict", rig: Path) -> list[str]:
    """Say what to do after a step of the calibration."""
    if not verdict.is_usable:
        return ["what the verdict asks for, and this command again"]
    following = [line.format(rig=quote(str(rig))) for line in _NEXT[step]]
    if verdict.is_good:
        return following
    return ["what the verdict asks for, and this command again; or go on:", *following]


def say_unused(unused: Mapping[str, str], *, used: int) -> None:
    """Say how many photos were used, and which were not and why."""
    tell("photos", f"{used} of {used + len(unused)} used")
    if unused:
        print_table("Not used", ("photo", "because it"), list(unused.items()))


def _print_errors(verdict: "CalibrationVerdict") -> None:
    rows: list[tuple[str, ...]] = [
        (error.what, f"{error.depth * 1e3:.0f} mm", f"{error.sigma * 1e3:.3f} mm")
        for error in verdict.errors
        if math.isfinite(error.sigma)
    ]
    print_table("Where boards were seen", ("what", "distance", "± 1σ"), rows)


def _print_parameters(calibration: "Calibration") -> None:
    from ..calibrate.words import as_read, describe, most_influential, strongest_pairs, value_of

    found = calibration.adjustment
    rows: list[tuple[str, ...]] = [
        (describe(found.rig, name), value_of(found.rig, name), as_read(name, float(sigma)),
         f"{max(share, 0):.0%}")
        for name, sigma, share in zip(
            found.names, found.sigma, found.worth.from_photos, strict=True)
    ]  # fmt: skip
    print_table("Parameters", ("parameter", "value", "± 1σ", "told by these photos"), rows)
    for sentence in strongest_pairs(found.rig):
        say(sentence)
    say(most_influential(found, [sighting.name for sighting in calibration.sightings]))


def _print_sheet(calibration: "Calibration", number: int) -> None:
    from ..calibrate import sheet_of
    from ..types.laser import Laser

    fit = sheet_of(calibration, number)
    n, d = fit.sheet.normal, fit.sheet.distance
    axis = calibration.rig.lasers[number].axis
    baseline, angle = Laser(fit.sheet, axis).as_baseline_angle()
    plane = f"{n[0]:+.6f} X {n[1]:+.6f} Y {n[2]:+.6f} Z {d * 1e3:+.3f} mm = 0"
    rows: list[tuple[str, ...]] = [
        ("equivalent plane", plane),
        ("direction, ± 1σ", f"{math.degrees(fit.angle_sigma):.3f} degrees"),
        ("axis", axis),
        ("equivalent b", f"{baseline * 1e3:.2f} mm"),
        ("equivalent θ", f"{math.degrees(angle):.3f} degrees"),
        ("RMS of the points on it", f"{fit.rms * 1e3:.3f} mm"),
        ("points on it", f"{fit.num_inliers} of {fit.num_points}"),
    ]
    print_table(f"Sheet of laser {number}", ("what", "value"), rows)


def _print_photos(calibration: "Calibration") -> None:
    from ..calibrate import circles_of

    names = [sighting.name for sighting in calibration.sightings]
    rows: list[tuple[str, ...]] = [
        (name, f"{rms:.3f}", f"{depth * 1e3:.0f}", str(len(sighting.stripe)))
        for name, rms, depth, sighting in zip(
            names, calibration.adjustment.view_rms, calibration.depths, calibration.sightings,
            strict=True)
    ]  # fmt: skip
    head = ["photo", "RMS [px]", "distance [mm]", "stripe points"]
    if not calibration.lasers:
        rows, head = [row[:3] for row in rows], head[:3]
    if calibration.logged is not None:
        circles = circles_of(calibration)
        rows = [
            (*row, f"{closure * 1e3:.3f}", f"{math.degrees(turn):.3f}")
            for row, closure, turn in zip(rows, circles.closures, circles.turns, strict=True)
        ]
        head += ["closes to [mm]", "and [degrees]"]
        w, x, y, z = _mount_of(calibration)
        say(f"quaternion w x y z: {w:.6f} {x:.6f} {y:.6f} {z:.6f}")
    print_table("Photos", tuple(head), rows)


def _mount_of(calibration: "Calibration") -> list[float]:
    mount = calibration.rig.vehicle_from_camera
    assert mount is not None
    return mount.as_quaternion()[0].tolist()
