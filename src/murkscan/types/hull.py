"""How places on a ship are told: by frame or distance from the bow, height, and side."""

from dataclasses import dataclass, field
from typing import Literal

Cell = str | float

_ON_CENTRELINE = 5e-4
"""Distance from the centreline below which a place is on neither side [m]: half a millimetre."""


@dataclass(frozen=True)
class HullFrame:
    """The axes of a hull: aft from the bow, to starboard of the centreline, up from a datum [m]."""

    frame_spacing: float | None = field(default=None, metadata={"unit": "m"})
    """Distance between two frames [m]; None: places are told by their distance from the bow."""
    frames_from: Literal["stern", "bow"] = "stern"
    """The end at which frame 0 is, from which numbers count up."""
    heights_above: Literal["keel", "waterline"] = "keel"
    """What heights count from."""

    @property
    def heads(self) -> tuple[str, str, str, str]:
        """Names of the numbers of a place, as tables have them."""
        first = "from_bow_m" if self.frame_spacing is None else "frame"
        return first, f"above_{self.heights_above}_m", "side", "from_centreline_m"

    def aft_of(self, station: float) -> float:
        """Give how far aft a frame, or a distance from the bow, lies on the hull's axis [m].

        Where frames count from the stern, the axis' zero is at frame 0, and frames lie before it.
        """
        if self.frame_spacing is None:
            return station
        return self.frame_spacing * (station if self.frames_from == "bow" else -station)

    def station_of(self, aft: float) -> float:
        """Give the frame, or the distance from the bow, of a place on the hull's axis [m]."""
        if self.frame_spacing is None:
            return aft
        return (aft if self.frames_from == "bow" else -aft) / self.frame_spacing

    def tell(self, place: tuple[float, float, float]) -> tuple[Cell, ...]:
        """Give the numbers of a place, in the order of `heads`.

        Args:
            place: Aft, to starboard, and up [m].
        """
        aft, starboard, up = place
        side = "starboard" if starboard > 0 else "port"
        if abs(starboard) < _ON_CENTRELINE:
            side = "centreline"
        return round(self.station_of(aft), 4), round(up, 4), side, round(abs(starboard), 4)

    def describe(self, place: tuple[float, float, float]) -> str:
        """Say where a place is, for people."""
        station, up, side, off = self.tell(place)
        first = (
            f"{station:.3f} m from the bow"
            if self.frame_spacing is None
            else f"frame {station:.2f}"
        )
        aside = "on the centreline" if side == "centreline" else f"{off:.3f} m to {side}"
        return f"{first}, {up:.3f} m above the {self.heights_above}, {aside}"
