"""A ship model seen from below, with what a ship has under water."""

from dataclasses import dataclass
from typing import final

from ...errors import InputError
from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes
from .hull_body import hull_body
from .hull_form import HullForm
from .keels import bar_keel, bilge_keel
from .propeller import propeller
from .solids import join_meshes
from .through_hull import ThroughHull


@final
@dataclass(frozen=True)
class Hull(AbstractShape):
    """Wigley's hull with a bar keel, two bilge keels, a through-hull and a propeller.

    The origin is the middle of the waterline; the bow points along + y, the keel towards the camera
    (- z), the deck lies in z = 0, and starboard is + x. The propeller stands behind the stern,
    beyond the length. Every part is a closed surface of its own, sunk into its neighbour. In the
    default proportions they have about 380 000 triangles, whatever the size.

    References:
        Wigley, Calculated and measured wave resistance of a series of forms defined
        algebraically, Trans. Institution of Naval Architects 84, 1942.
    """

    length: float = 0.9
    """Of the waterline, along y [m]."""
    beam: float = 0.28
    """Largest breadth, along x [m]."""
    draft: float = 0.11
    """From the waterline to the bottom amidships, without the keel [m]."""

    def __post_init__(self) -> None:
        """Refuse what is no ship."""
        check_sizes("A hull", length=self.length, beam=self.beam, draft=self.draft)
        if not (2 <= self.length / self.beam <= 8 and 1.5 <= self.beam / self.draft <= 5):
            raise InputError(
                f"A hull is 2 to 8 beams long and 1.5 to 5 drafts broad, got length = "
                f"{self.length:g}, beam = {self.beam:g} and draft = {self.draft:g} m."
            )

    def mesh(self) -> Mesh:
        """Make shell and deck, keels, through-hull and propeller."""
        form = HullForm(self.length, self.beam, self.draft)
        through_hull = ThroughHull.on_starboard(form)
        return join_meshes(
            [
                hull_body(form, through_hull),
                bar_keel(form),
                bilge_keel(form, 1.0),
                bilge_keel(form, -1.0),
                through_hull.mesh(),
                propeller(form),
            ]
        )
