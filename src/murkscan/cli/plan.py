"""murkscan plan: what a rig will see in a water, before it is built or lowered."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter
from cyclopts.types import PositiveFloat

from ..errors import InputError
from .paths import RigFile
from .progress import progress_bars
from .words import print_table, say, tell

_MEANING = (
    "σ is one standard deviation: along the ray by the picture's noise and by speckle, across it "
    "by the width of a scan line, common by the calibration, which all points share"
)

if TYPE_CHECKING:
    from ..survey.plan import Plan
    from ..types.rig import Rig


def plan(
    *,
    rig: RigFile,
    attenuation_per_m: PositiveFloat | None = None,
    visibility_m: PositiveFloat | None = None,
    secchi_m: PositiveFloat | None = None,
    scattered: float = 0.83,
    from_m: PositiveFloat | None = None,
    to_m: PositiveFloat | None = None,
    spacing_mm: PositiveFloat = 5.0,
    frame_rate_hz: PositiveFloat = 25.0,
    albedo: float = 0.1,
    power_mw: PositiveFloat = 30.0,
    exposure_ms: PositiveFloat = 10.0,
    f_number: PositiveFloat = 2.0,
    pixel_size_um: PositiveFloat = 5.0,
    full_well_e: PositiveFloat = 9000.0,
    read_noise_e: float = 9.0,
    bits: int = 8,
    interlaced: Annotated[bool, Parameter(negative=())] = False,
    daylight_w_m2: float = 0.0,
    longest_baseline_mm: PositiveFloat | None = None,
    baseline_mm: PositiveFloat | None = None,
    angle_deg: PositiveFloat | None = None,
    laser: int = 0,
    out: Path = Path("plan"),
) -> None:
    """Say what a rig will see in a water: how far, how well, how fast.

    One of --attenuation-per-m, --visibility-m and --secchi-m says how murky the water is. The
    surface is a plain wall that faces the camera; σ is the least that one scan line's noise allows,
    beside what speckle adds.

    Parameters
    ----------
    rig
        The rig file.
    attenuation_per_m
        Beam attenuation c of the water at the laser's colour [1/m].
    visibility_m
        How far a diver sees [m]; c is 4.8 over that.
    secchi_m
        Depth at which a Secchi disc disappears [m].
    scattered
        Share of the attenuation that is scattering, not absorption.
    from_m
        Nearest distance of the surface from the camera [m]; as near as the rig sees unless given.
    to_m
        Its farthest distance [m]; as far as the rig sees unless given.
    spacing_mm
        Wanted distance from profile to profile [mm].
    frame_rate_hz
        Frames a second; fields of an interlaced camera.
    albedo
        Share of light that the surface throws back; antifouling paint 0.03 to 0.1.
    power_mw
        Power of the laser's line [mW].
    exposure_ms
        Exposure of a frame [ms].
    f_number
        Focal length over aperture of the lens.
    pixel_size_um
        Edge of a pixel [µm].
    full_well_e
        Electrons at which a pixel is white.
    read_noise_e
        Noise of reading a pixel [electrons, 1σ].
    bits
        Bits of a grey level.
    interlaced
        Every second row belongs to another field, as of an analogue camera.
    daylight_w_m2
        Daylight in the laser's colour on the surface [W/m²].
    longest_baseline_mm
        Longest baseline that the vehicle can carry [mm], for the best place of the laser; twice
        the present one unless given.
    baseline_mm
        As if the laser sat so far from the camera, on its side [mm]; as it is unless given.
    angle_deg
        As if its sheet made this angle with the baseline [degrees]; as it is unless given.
    laser
        Number of the laser, from 0.
    out
        Folder for index.html and plan.json.
    """
    murk = _only_one(attenuation_per_m, visibility_m, secchi_m)
    if from_m is not None and to_m is not None and not from_m < to_m:
        raise InputError(f"--from-m {from_m:g} must be below --to-m {to_m:g}.")
    with progress_bars():
        from ..io.rig_toml import load_rig
        from ..optics.beam import Light
        from ..optics.medium import Medium
        from ..optics.sensor import Sensor
        from ..plan import Conditions
        from ..survey.plan import make_plan

        light = Light(power=power_mw / 1e3, ambient=daylight_w_m2)
        sensor = Sensor(
            exposure=exposure_ms / 1e3,
            f_number=f_number,
            pixel_size=pixel_size_um / 1e6,
            full_well=full_well_e,
            read_noise=read_noise_e,
            bits=bits,
            interlaced=interlaced,
        )
        made = make_plan(
            _as_if(load_rig(rig), baseline_mm, angle_deg, laser),
            Conditions(Medium(_attenuation(*murk), scattered), light, sensor, albedo),
            out=out,
            working_range=(from_m, to_m),
            spacing=spacing_mm / 1e3,
            frame_rate=frame_rate_hz,
            longest=None if longest_baseline_mm is None else longest_baseline_mm / 1e3,
            laser=laser,
        )
    _print(made, out)


def _only_one(
    attenuation: float | None, visibility: float | None, secchi: float | None
) -> tuple[str, float]:
    given = {"attenuation": attenuation, "visibility": visibility, "secchi": secchi}
    said = [(name, value) for name, value in given.items() if value is not None]
    if len(said) != 1:
        raise InputError(
            "Say how murky the water is by exactly one of --attenuation-per-m, --visibility-m and "
            "--secchi-m; how far a diver sees is enough."
        )
    return said[0]


def _as_if(rig: "Rig", baseline_mm: float | None, angle_deg: float | None, laser: int) -> "Rig":
    """Put the laser where it is asked about; leave it where nothing is said."""
    from ..plan import as_if

    return as_if(
        rig,
        None if baseline_mm is None else baseline_mm / 1e3,
        None if angle_deg is None else math.radians(angle_deg),
        laser,
    )


def _attenuation(name: str, value: float) -> float:
    from ..plan import attenuation_from_secchi, attenuation_from_visibility

    known = {"visibility": attenuation_from_visibility, "secchi": attenuation_from_secchi}
    return known[name](value) if name in known else value


def _print(made: "Plan", out: Path) -> None:
    print_table("What this rig will see (σ and spacing in mm)", made.head, made.rows)
    for sentence in made.sentences:
        say(sentence)
    tell("meaning", _MEANING)
    tell("made", f"{out / 'index.html'}, with charts; {out / 'plan.json'}, the numbers")
    tell("next", "open the page; try other flags, then write the rig file of what you will build")
