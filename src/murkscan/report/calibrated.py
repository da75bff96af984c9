"""What the rig's file says of its calibration, one step a value."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import date
from typing import Any

_RESIDUALS = {
    "rms_px": "corners off by {} px (RMS)",
    "corner_sigma_px": "corners off by {} px (1 σ)",
    "rms_mm": "sheet off by {} mm (RMS)",
    "angle_sigma_deg": "sheet's direction known to {}°",
    "closure_mm": "poses close to {} mm",
    "dispersion": "photos scatter {} times their points' noise",
}
"""Numbers of a step's record that tell how good it is."""
_DOUBTS = ("Usable, but", "Not usable")
"""How the verdict of a step with advice begins."""


@dataclass(frozen=True)
class CalibrationStep:
    """One step of the calibration, as it was recorded."""

    name: str
    """Such as camera, port, laser 0, mount."""
    date: date | None
    age_days: int | None
    """Days from the calibration to the recording; None where one of them has no date."""
    verdict: str
    """Empty where it was not recorded."""
    evidence: str
    """Photos and residuals, in words."""

    @property
    def is_good(self) -> bool:
        """Tell whether the calibration left nothing to be wished for."""
        return bool(self.verdict) and not self.verdict.startswith(_DOUBTS)

    @property
    def is_usable(self) -> bool:
        """Tell whether the calibration said that it may be scanned with, or said nothing."""
        return not self.verdict.startswith(_DOUBTS[1])


def read_steps(record: Mapping[str, Any], *, recorded: date | None) -> list[CalibrationStep]:
    """Read [calibration] of a rig file; what is no step's record is passed over.

    Args:
        record: The table, as plain values.
        recorded: When the recording was made.
    """
    return [_read(name, step, recorded) for name, step in _steps(record)]


def _steps(record: Mapping[str, Any], parent: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    for name, value in record.items():
        if not isinstance(value, Mapping) or name == "covariance":
            continue
        full = f"{parent} {name}".strip()
        if "date" in value or "verdict" in value:
            yield full, value
        else:
            yield from _steps(value, full)


def _read(name: str, step: Mapping[str, Any], recorded: date | None) -> CalibrationStep:
    made = _as_date(step.get("date"))
    age = (recorded - made).days if recorded and made else None
    words = []
    if "views" in step:
        of = f" of {step['photos']}" if "photos" in step else ""
        words.append(f"{step['views']}{of} photos")
    words += [text.format(step[key]) for key, text in _RESIDUALS.items() if key in step]
    return CalibrationStep(name, made, age, str(step.get("verdict", "")), ", ".join(words))


def _as_date(value: Any) -> date | None:
    if isinstance(value, date):
        return value
    try:
        return date.fromisoformat(str(value)[:10])
    except ValueError:
        return None
