"""How well a rig's parameters are known, and how their errors go together."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from ..errors import InputError
from .arrays import Scalars
from .short_repr import ShortRepr


def _no_matrix() -> Float[np.ndarray, "n n"]:
    return np.zeros((0, 0))


@dataclass(frozen=True, eq=False, repr=False)
class RigCovariance(ShortRepr):
    """Covariance of some of a rig's parameters; the others are taken as exact.

    Names follow rig.toml; units are px, m, rad and none. `murkscan.optics.perturb_rig` says what a
    change of each means, and `parameters_of` lists those that a rig has.
    """

    names: tuple[str, ...] = ()
    """Which parameters, such as `camera.focal_length[0]`."""
    matrix: Float[np.ndarray, "n n"] = field(default_factory=_no_matrix)
    """How they vary together; rows and columns in the order of the names."""

    def __post_init__(self) -> None:
        """Refuse what is no covariance."""
        count = len(self.names)
        if len(set(self.names)) < count or self.matrix.shape != (count, count):
            raise InputError(
                f"A covariance of {count} parameters needs {count} different names and a matrix "
                f"{count} x {count}, got one {' x '.join(map(str, self.matrix.shape))} of "
                f"{', '.join(self.names)}."
            )
        if count and not np.isfinite(self.matrix).all():
            raise InputError("A covariance must hold numbers only, got NaN or infinity.")
        sigma = np.sqrt(np.abs(np.diag(self.matrix)))
        slack = 1e-6 * np.outer(sigma, sigma)
        if np.any(np.abs(self.matrix - self.matrix.T) > slack) or np.any(np.diag(self.matrix) < 0):
            raise InputError(
                "A covariance must be symmetric, with variances of 0 or more; got another matrix "
                f"for {', '.join(self.names)}."
            )

    @property
    def sigma(self) -> Scalars:
        """Standard deviation of each parameter."""
        return np.sqrt(np.diag(self.matrix))

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each parameter: px, m, rad, or nothing for a ratio."""
        return tuple(unit_of(name) for name in self.names)

    @property
    def correlation(self) -> Float[np.ndarray, "n n"]:
        """Correlation of each pair; 0 for a parameter that does not vary."""
        sigma = self.sigma
        scale = np.divide(1.0, sigma, out=np.zeros_like(sigma), where=sigma > 0)
        return self.matrix * np.outer(scale, scale)

    def select(self, names: Sequence[str]) -> "RigCovariance":
        """Give the covariance of these parameters; one that is not in it is exact, with zeros."""
        picked = np.zeros((len(names), len(names)))
        place = {name: i for i, name in enumerate(self.names)}
        known = [i for i, name in enumerate(names) if name in place]
        rows = [place[names[i]] for i in known]
        picked[np.ix_(known, known)] = self.matrix[np.ix_(rows, rows)]
        return RigCovariance(tuple(names), picked)

    def without(self, prefix: str) -> "RigCovariance":
        """Leave out all parameters whose name begins so."""
        return self.select([name for name in self.names if not name.startswith(prefix)])


def unit_of(name: str) -> str:
    """Give the unit of a rig's parameter: px, m, rad, or nothing for a ratio."""
    last = name.rsplit(".", 1)[-1].split("[")[0]
    if last in ("focal_length", "principal_point"):
        return "px"
    if last in ("normal", "turn"):
        return "rad"
    return "" if last in ("distortion", "index") else "m"
