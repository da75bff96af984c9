"""murkscan calibrate describe: a rig by what a data sheet, a ruler and a thermometer say."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from cyclopts.types import PositiveFloat

from ..errors import InputError
from .words import tell

if TYPE_CHECKING:
    from ..survey.describe import Described


def describe(
    *,
    rig: Path,
    size_px: str | None = None,
    view_deg: PositiveFloat | None = None,
    baseline_mm: float | None = None,
    angle_deg: PositiveFloat | None = None,
    axis: Literal["x", "y"] = "y",
    window_mm: PositiveFloat | None = None,
    dome_radius_mm: PositiveFloat | None = None,
    glass_mm: PositiveFloat | None = None,
    glass_index: PositiveFloat = 1.49,
    temperature_c: float | None = None,
    salinity_psu: float | None = None,
    wavelength_nm: PositiveFloat = 532.0,
) -> None:
    """Write into a rig file what is known of a rig without a calibration.

    It is enough to plan with, and to calibrate a window from. A camera, a laser or a window that
    was calibrated is not replaced; how well described ones are known is not stated.

    Parameters
    ----------
    rig
        The rig file; made where it is missing. Its other tables and comments stay.
    size_px
        Width and height of the camera's pictures [px], such as 720x576; with --view-deg.
    view_deg
        How wide the camera sees in air, from the left edge to the right one [degrees].
    baseline_mm
        Distance of the laser from the camera [mm], negative on the axis' other side; with
        --angle-deg.
    angle_deg
        Angle of the laser's sheet with the baseline [degrees]; 90 is straight ahead.
    axis
        Axis of the picture along which the laser sits: y where it is above or below the camera.
    window_mm
        From the optical centre to the inner face of a flat window [mm]; with --glass-mm.
    dome_radius_mm
        Inner radius of a dome around the optical centre [mm]; with --glass-mm.
    glass_mm
        Thickness of the window or the dome [mm].
    glass_index
        Its refractive index: 1.49 for acrylic, 1.52 for crown glass.
    temperature_c
        Temperature of the water [°C]; with --salinity-psu.
    salinity_psu
        Salinity of the water [PSU]: 0 fresh, about 35 at sea.
    wavelength_nm
        Wavelength of the laser [nm], for a new rig file.
    """
    _check_pair("--size-px", size_px, "--view-deg", view_deg)
    _check_pair("--baseline-mm", baseline_mm, "--angle-deg", angle_deg)
    _check_pair("--temperature-c", temperature_c, "--salinity-psu", salinity_psu)
    from ..survey.describe import Described, describe_rig

    given = Described(
        size=None if size_px is None else _size(size_px),
        view_deg=view_deg,
        baseline_mm=baseline_mm,
        angle_deg=angle_deg,
        axis=axis,
        window_mm=window_mm,
        dome_radius_mm=dome_radius_mm,
        glass_mm=glass_mm,
        glass_index=glass_index,
        temperature_c=temperature_c,
        salinity_psu=salinity_psu,
        wavelength_nm=wavelength_nm,
    )
    _check_window(given)
    describe_rig(rig, given)
    tell("made", str(rig))
    tell("next", f"murkscan plan --rig {rig} --visibility-m 3 says what it will see; murkscan "
         "calibrate says how well it is known")  # fmt: skip


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"\s*([1-9]\d{0,4})\s*[xX×]\s*([1-9]\d{0,4})\s*", text)
    if match is None:
        raise InputError(
            f"--size-px {text!r} is not the size of a picture; give it as WIDTHxHEIGHT, such as "
            "720x576."
        )
    return int(match[1]), int(match[2])


def _check_pair(name: str, value: object, other: str, partner: object) -> None:
    if (value is None) != (partner is None):
        raise InputError(f"{name} and {other} go together; give both or neither.")


def _check_window(given: "Described") -> None:
    if given.window_mm is not None and given.dome_radius_mm is not None:
        raise InputError("A camera looks through one window: give --window-mm or --dome-radius-mm.")
    is_window = given.window_mm is not None or given.dome_radius_mm is not None
    if is_window != (given.glass_mm is not None):
        raise InputError("A window needs --glass-mm, and --window-mm or --dome-radius-mm.")
