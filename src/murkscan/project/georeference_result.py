"""What a georeference says of itself: where the model lies on the Earth, and how well."""

from dataclasses import dataclass, field

from ..types.hull import HullFrame


@dataclass(frozen=True)
class ControlResult:
    """How well the model meets one control point."""

    name: str
    residual: tuple[float, ...] = field(metadata={"unit": "m"})
    """Control point less model, along east, north and up [m]."""
    sigma: float = field(metadata={"unit": "m"})
    """As the file states it, with that of a marker's place on the model [m]."""
    standardised: float
    """Length of the residual in its own standard deviations; about 1.7 is usual."""


@dataclass(frozen=True)
class MarkerResult:
    """Where the marker of a control point was seen."""

    name: str
    """Of the control point."""
    marker: int
    """Its number in its dictionary."""
    place: tuple[float, ...] = field(metadata={"unit": "m"})
    """Its middle on the model [m]."""
    sigma: float = field(metadata={"unit": "m"})
    """Standard deviation of that along each axis [m]."""
    pictures: int
    """Pictures that it is the mean of."""
    points: int
    """Points of the scan on it."""


@dataclass(frozen=True)
class GeoreferenceResult:
    """Where a model lies on the Earth; see `Georeference`."""

    crs: str
    wkt: str
    scale: float
    """Length in the grid of a metre on the ground."""
    origin: tuple[float, ...] = field(metadata={"unit": "m"})
    """Easting, northing and height from which the ground counts [m]."""
    rotation: tuple[tuple[float, ...], ...]
    """Rotation matrix ground_from_model: east, north, up of the model's x, y, z."""
    translation: tuple[float, ...] = field(metadata={"unit": "m"})
    covariance_of_turn_and_shift: tuple[tuple[float, ...], ...]
    """About the origin [rad², rad·m, m²]."""
    points: tuple[ControlResult, ...]
    rms: float = field(metadata={"unit": "m"})
    """Root mean square of the residuals' lengths [m]."""
    inflation: float = 1.0
    """Factor by which the residuals are larger than the stated sigmas; the covariance has it."""
    remarks: tuple[str, ...] = ()
    """What is odd, with its cure; sentences for the user."""
    hull: HullFrame | None = None
    """Of a model that was laid on a ship: the axes are then aft, to starboard and up."""
    markers: tuple[MarkerResult, ...] = ()
    """Of those points that markers give; `sigma` of the points has theirs."""
