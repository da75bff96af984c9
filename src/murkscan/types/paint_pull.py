"""How far paint pulls the laser line."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class PaintPull:
    """By how much brighter paint ahead or behind the sheet pulls the centres of one laser.

    A sheet is not thin: paint that is brighter on one side of it draws the middle of its light
    there. The surface passes through the sheet, so paint across it is brightness over time.
    """

    laser: int
    """Number of the laser in the rig."""
    shift: float = field(metadata={"unit": "px"})
    """Along the scan line, where the stripe becomes brighter by the factor e from each frame to the
    next [px]. It is proportional to the frame rate over the speed."""
    sigma: float = field(metadata={"unit": "px"})
    """Standard deviation of that [px]."""
