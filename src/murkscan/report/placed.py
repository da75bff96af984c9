"""Where the model lies on the Earth, and how well it meets its control points."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..page import Note, Section, Table


@dataclass(frozen=True)
class ControlRow:
    """One control point."""

    name: str
    residual: tuple[float, ...]
    """Control point less model, along east, north and up [m]."""
    sigma: float
    """As its table states it [m]."""


@dataclass(frozen=True)
class Placed:
    """A model that was laid on control points."""

    crs: str
    """Their coordinate system."""
    rows: Sequence[ControlRow]
    rms: float
    """Root mean square of the residuals' lengths [m]."""
    remarks: Sequence[str]


def placed_sections(placed: Placed | None) -> list[Section]:
    """Show the control points; nothing where there are none."""
    if placed is None:
        return []
    text = (
        f"The model was laid on {len(placed.rows)} control points in {placed.crs}. What is "
        "exported lies there; pictures, measures and the model's page stay in the model's own "
        f"world. The residuals are {1e3 * placed.rms:.2f} mm (RMS of their lengths)."
    )
    rows = [(one.name, *_as_mm(one.residual), *_as_mm((one.sigma,))) for one in placed.rows]
    head = ("control point", "east [mm]", "north [mm]", "up [mm]", "stated sigma [mm]")
    odd = [Note(remark, "warning") for remark in placed.remarks]
    return [Section("Place on the Earth", [Note(text), *odd, Table(rows, head=head)])]


def placed_as_plain(placed: Placed | None) -> dict[str, Any] | None:
    """Give the same as plain values."""
    if placed is None:
        return None
    return {
        "crs": placed.crs,
        "rms_mm": 1e3 * placed.rms,
        "remarks": list(placed.remarks),
        "control_points": [
            {
                "name": one.name,
                "east_north_up_mm": [1e3 * part for part in one.residual],
                "sigma_mm": 1e3 * one.sigma,
            }
            for one in placed.rows
        ],
    }


def _as_mm(lengths: tuple[float, ...]) -> list[str]:
    return [f"{1e3 * length:.2f}" for length in lengths]
