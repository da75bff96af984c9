"""What an acceptance test is told: calibrated artefacts, where they lie, and what is allowed."""

from dataclasses import dataclass

Place = tuple[float, float, float]
"""X, Y and Z in the scan's world [m]."""


@dataclass(frozen=True)
class CalibratedBall:
    """A ball whose size is known."""

    name: str
    near: Place
    """A place on it or in it [m]."""
    diameter: float
    """As calibrated [m]."""
    diameter_sigma: float = 0.0
    """Standard deviation of the calibration [m]."""
    form: float = 0.0
    """Form error of the ball itself [m]."""


@dataclass(frozen=True)
class CalibratedBar:
    """Two balls whose distance is known."""

    first: str
    second: str
    """Their names."""
    length: float
    """From centre to centre, as calibrated [m]."""
    length_sigma: float = 0.0
    """Standard deviation of the calibration [m]."""


@dataclass(frozen=True)
class CalibratedPlate:
    """A plate that is known to be flat."""

    name: str
    near: Place
    """The middle of the part that is looked at [m]."""
    within: float
    """How far that part reaches from there [m]."""
    flatness: float = 0.0
    """Flatness error of the plate itself [m]."""


@dataclass(frozen=True)
class CalibratedStep:
    """Two parallel faces whose distance is known."""

    name: str
    first: Place
    second: Place
    """The middle of the part of each face that is looked at [m]."""
    within: float
    """How far these parts reach from there [m]."""
    height: float
    """As calibrated [m]; positive where the second stands nearer to the camera."""
    height_sigma: float = 0.0
    """Standard deviation of the calibration [m]."""


@dataclass(frozen=True)
class Limits:
    """What the client allows [m]; None where no limit was stated."""

    probing_form: float | None = None
    probing_size: float | None = None
    sphere_spacing: float | None = None
    flatness: float | None = None
    length: float | None = None


@dataclass(frozen=True)
class AcceptanceTest:
    """All that an acceptance test is told."""

    name: str
    """What the artefact is called."""
    certificate: str
    """By what it was calibrated, in words; may be empty."""
    balls: tuple[CalibratedBall, ...]
    bars: tuple[CalibratedBar, ...]
    plates: tuple[CalibratedPlate, ...]
    steps: tuple[CalibratedStep, ...]
    limits: Limits
