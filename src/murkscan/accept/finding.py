"""One number of an acceptance test, and what is decided of it."""

import math
from dataclasses import dataclass
from enum import Enum

from ..types.quantity import Quantity


class Decision(Enum):
    """What a limit and an interval come to."""

    PASSED = "passed"
    FAILED = "failed"
    UNDECIDED = "undecided"
    NO_LIMIT = "no limit stated"


@dataclass(frozen=True)
class Finding:
    """A number that a scan gave of an artefact, beside what it should be."""

    what: str
    """Such as probing form or sphere spacing."""
    artefact: str
    """Such as ball A."""
    calibrated: float
    """What it should be [m]; 0 for errors of form."""
    sigma_calibrated: float
    """Standard deviation of that [m]."""
    measured: Quantity
    """What the scan gave [m]."""
    limit: float | None
    """The largest error that the client allows [m]; None where no limit was stated."""

    @property
    def error(self) -> float:
        """What the scan gave less what it should be [m]."""
        return self.measured.value - self.calibrated

    @property
    def half_width(self) -> float:
        """Half the 95 % interval of the error [m], by which is decided.

        It holds the noise of the points and the calibration of the artefact. What the rig's own
        calibration and the motion are unsure of is not in it: that is what the test puts to the
        test, and it is in the error.

        References:
            ISO/TS 23165:2006 (the uncertainty of a test is that of what tests, not of what is
            tested).
        """
        return self._quantity(self.sigma_calibrated).half_width

    @property
    def stated_half_width(self) -> float:
        """Half the 95 % interval that the scan itself states, with the artefact's [m]."""
        return self._quantity(
            math.hypot(self.measured.sigma_common or 0.0, self.sigma_calibrated)
        ).half_width

    @property
    def decision(self) -> Decision:
        """What is decided: in the client's favour and in the maker's only beyond doubt.

        References:
            ISO 14253-1:2017, sections 5.2 and 5.3: acceptance and rejection zones that the expanded
            uncertainty guards on either side of the limit.
        """
        if self.limit is None:
            return Decision.NO_LIMIT
        if abs(self.error) + self.half_width <= self.limit:
            return Decision.PASSED
        if abs(self.error) - self.half_width > self.limit:
            return Decision.FAILED
        return Decision.UNDECIDED

    def _quantity(self, sigma_common: float) -> Quantity:
        found = self.measured
        return Quantity(
            found.name, self.error, "m", found.sigma_independent, sigma_common, found.degrees
        )
