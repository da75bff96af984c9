"""The whole instrument: a camera and the lasers beside it."""

from dataclasses import dataclass, field

from ..errors import InputError
from .camera import Camera
from .laser import Laser
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
