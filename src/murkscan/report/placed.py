"""Where the model lies on the Earth or on a ship, and how well it meets its control points."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..page import Note, Section, Table


@dataclass(frozen=True)
class ControlRow:
    """One control point."""

    name: str
    residual: tuple[float, ...]
    """Control point less model, along east, north and up, or the ship's axes [m]."""
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
    on_ship: bool = False
    """Whether the axes are a ship's: aft, to starboard and up."""


def placed_sections(placed: Placed | None) -> list[Section]:
    """Show the control points; nothing where there are none."""
    if placed is None:
        return []
    text = (
        f"The model was laid on {len(placed.rows)} control points in {placed.crs}. What is "
        "exported lies there, and measures, walls and the model's page tell places there; numbers "
        "called x, y and z stay in the model's own world. The residuals are "
        f"{1e3 * placed.rms:.2f} mm (RMS of their lengths)."
    )
    rows = [(one.name, *_as_mm(one.residual), *_as_mm((one.sigma,))) for one in placed.rows]
    axes = ("aft", "to starboard") if placed.on_ship else ("east", "north")
    head = ("control point", *(f"{axis} [mm]" for axis in (*axes, "up")), "stated sigma [mm]")
    odd = [Note(remark, "warning") for remark in placed.remarks]
    title = "Place on the ship" if placed.on_ship else "Place on the Earth"
    return [Section(title, [Note(text), *odd, Table(rows, head=head)])]


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
                "aft_starboard_up_mm" if placed.on_ship else "east_north_up_mm": [
                    1e3 * part for part in one.residual
                ],
                "sigma_mm": 1e3 * one.sigma,
            }
            for one in placed.rows
        ],
    }


def _as_mm(lengths: tuple[float, ...]) -> list[str]:
    return [f"{1e3 * length:.2f}" for length in lengths]
