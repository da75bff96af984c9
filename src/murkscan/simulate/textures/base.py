"""What every texture can do."""

import abc

from ...errors import InputError
from ...types.arrays import Points, Scalars


class AbstractTexture(abc.ABC):
    """A way in which a surface is painted. Subclasses are final: wrap one, do not subclass it."""

    @abc.abstractmethod
    def albedo(self, points: Points) -> Scalars:
        """Give the share of the light that each place throws back, from 0 to 1.

        Args:
            points: Places on the surface, in the object's own frame [m].

        Returns:
            The albedo of each; a place always has the same.
        """


def check_albedos(what: str, **albedos: float) -> None:
    """Refuse an albedo that is no share.

    Args:
        what: What has these albedos, with its article: "A chessboard".
        albedos: The albedos by the names of their fields.

    Raises:
        InputError: One lies outside 0 to 1, or is not a number.
    """
    for name, albedo in albedos.items():
        if not 0 <= albedo <= 1:
            raise InputError(
                f"{what} throws back a share of the light from 0 to 1, got {name} = {albedo:g}."
            )
