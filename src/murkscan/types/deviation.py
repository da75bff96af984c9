"""How far a scan lies from a reference surface."""

from dataclasses import dataclass

from .arrays import Directions, Mask, Scalars
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Deviation(ShortRepr):
    """Signed distance of each point of a scan from a reference; one a row."""

    values: Scalars
    """Distance [m], positive where the scan stands out towards the camera, negative in a dent; NaN
    where the reference has nothing beside the point."""
    normals: Directions
    """Unit normal of the reference at each point, turned to the camera."""
    sigma_reference: Scalars
    """Standard deviation of the reference's own place along that normal [m]."""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.values)

    def __getitem__(self, which: Mask) -> "Deviation":
        """Pick some of the points."""
        return Deviation(self.values[which], self.normals[which], self.sigma_reference[which])
