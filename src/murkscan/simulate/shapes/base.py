"""What every shape can do."""

import abc
import math

from ...errors import InputError
from ...types.mesh import Mesh


class AbstractShape(abc.ABC):
    """An object to scan, by its sizes. Subclasses are final: wrap one, do not subclass it.

    The object's own frame is that of a camera that looks at it: x right, y down, z away from the
    camera, which so stands on the side of - z.
    """

    @abc.abstractmethod
    def mesh(self) -> Mesh:
        """Make the object's surface.

        Returns:
            Triangles in the object's own frame [m], counter-clockwise seen from outside; the same
            sizes give the same numbers.
        """


def check_sizes(what: str, **sizes: float) -> None:
    """Refuse sizes [m] that are not above 0.

    Args:
        what: What has these sizes, with its article: "A sphere".
        sizes: The sizes by the names of their fields.

    Raises:
        InputError: A size is 0, negative or not finite.
    """
    for name, size in sizes.items():
        if not (math.isfinite(size) and size > 0):
            raise InputError(f"{what} needs a {name} above 0 m, got {name} = {size:g} m.")
