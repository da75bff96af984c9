"""How well a step knows what it was taken for, and how well is well enough."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..types.rig_covariance import unit_of
from .adjust.parameters import MOUNT
from .calibration import Calibration
from .laser import sheet_of
from .mount import circles_of
from .region import LocalError
from .words import as_read, describe

FOCAL_SIGMA = 0.01
"""Standard deviation of the focal length, over itself, up to which it is good: 1 % of scale."""
ANGLE_SIGMA = float(np.radians(0.2))
"""Standard deviation of a sheet's direction, or of a mount's turn, up to which it is good [rad]:
2 mm at half a metre from the boards."""
SHAPE = 5e-4
"""Error of shape over the range up to which a port is good."""
SHIFT_SIGMA = 0.005
"""Standard deviation of a mount's translation up to which it is good, over the distance of the
board."""


@dataclass(frozen=True)
class Precision:
    """How well one thing is known."""

    what: str
    """What it is, in words."""
    sigma: float
    """Standard deviation [m], [rad], or over the thing itself."""
    said: str
    """The same as people read it."""
    limit: float | None = None
    """Up to which it is good; None where nothing is asked of it."""

    @property
    def is_good(self) -> bool:
        """Tell whether it is known well enough."""
        return self.limit is None or self.sigma <= self.limit


def precisions_of(calibration: Calibration, errors: Sequence[LocalError]) -> tuple[Precision, ...]:
    """List what a step was taken for, what is judged first.

    Args:
        calibration: What was found.
        errors: The errors that are left where boards were seen, nearest first.
    """
    own = {"camera": _of_camera, "port": _of_port, "laser": _of_lasers, "mount": _of_mount}
    return tuple(own[calibration.step](calibration, errors))


def _of_camera(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[Precision]:
    sigma = float(calibration.sigma[0] / calibration.rig.camera.focal_length[0])
    yield Precision("focal length", sigma, f"{100 * sigma:.2g} %", FOCAL_SIGMA)


def _of_port(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[Precision]:
    middle = errors[1]
    yield Precision(
        f"shapes at {middle.depth * 1e3:.0f} mm", middle.sigma, f"{middle.sigma * 1e3:.2g} mm",
        SHAPE * middle.depth,
    )  # fmt: skip
    yield from _parameters(calibration)


def _of_lasers(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[Precision]:
    for number in calibration.lasers:
        sigma = sheet_of(calibration, number).angle_sigma
        said = f"{np.degrees(sigma):.2g} degrees"
        yield Precision(f"direction of laser {number}'s sheet", sigma, said, ANGLE_SIGMA)
    for error in errors:
        what = f"{error.what} at {error.depth * 1e3:.0f} mm"
        yield Precision(what, error.sigma, f"{error.sigma * 1e3:.2g} mm")
    yield from (one for one in _parameters(calibration) if one.what.startswith("distance"))


def _of_mount(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[Precision]:
    sigma = calibration.rig.covariance.select(MOUNT).sigma
    turn, shift = float(sigma[3:].max()), float(sigma[:3].max())
    yield Precision("camera's direction", turn, f"{np.degrees(turn):.2g} degrees", ANGLE_SIGMA)
    yield Precision(
        "camera's place", shift, f"{shift * 1e3:.2g} mm",
        SHIFT_SIGMA * circles_of(calibration).distance,
    )  # fmt: skip


def _parameters(calibration: Calibration) -> Iterator[Precision]:
    """List the lengths and tilts that the photos were taken for."""
    for name, sigma in zip(calibration.wanted, calibration.sigma.tolist(), strict=True):
        if unit_of(name) in ("m", "rad"):
            yield Precision(describe(calibration.rig, name), sigma, as_read(name, sigma))
