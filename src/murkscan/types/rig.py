"""The whole instrument: a camera and the lasers beside it."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from ..errors import InputError
from .camera import Camera
from .laser import Axis, Laser
from .navigation import NavigationAccuracy
from .pose import Pose
from .rig_covariance import RigCovariance
from .short_repr import ShortRepr
from .water import Water


@dataclass(frozen=True, eq=False, repr=False)
class Rig(ShortRepr):
    """A camera and its lasers, rigidly joined."""

    camera: Camera
    lasers: tuple[Laser, ...] = ()
    """The lasers; none before `calibrate laser` has run."""
    wavelength: float = 532e-9
    """Wavelength of the lasers [m]."""
    water: Water | None = None
    """What the rig is in, behind its ports; None for air."""
    vehicle_from_camera: Pose | None = None
    """The mount, where the rig sits on a vehicle whose own poses are logged."""
    navigation: NavigationAccuracy | None = None
    """How good the log of that vehicle is; None where nothing is stated."""
    covariance: RigCovariance = field(default_factory=RigCovariance)
    """How well its parameters are known; of none where no calibration says so."""

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The camera axis along which each laser sits."""
        return tuple(laser.axis for laser in self.lasers)

    def laser(self, number: int) -> Laser:
        """Give a laser by its number, from 0.

        Raises:
            InputError: The rig has no such laser.
        """
        if not self.lasers:
            raise InputError("The rig has no laser yet; run `murkscan calibrate laser` first.")
        if not 0 <= number < len(self.lasers):
            raise InputError(
                f"The rig has {len(self.lasers)} laser(s), numbered from 0; there is no laser "
                f"{number}."
            )
        return self.lasers[number]

    def choose_lasers(self, numbers: Sequence[int] = ()) -> tuple[int, ...]:
        """Give the numbers of some lasers in order, each once; of all where none is named.

        Raises:
            InputError: The rig has no laser, or not one of these.
        """
        chosen = sorted({*numbers}) or range(max(len(self.lasers), 1))
        for number in chosen:
            self.laser(number)
        return tuple(chosen)
