"""What one measurement of a scan gave."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from .arrays import Vector
from .quantity import Quantity
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Measurement(ShortRepr):
    """Numbers that belong together, each with its uncertainty."""

    kind: str
    """What was measured: sphere, distance, section …"""
    quantities: tuple[Quantity, ...]
    """The numbers, in the order to show them."""
    details: Mapping[str, object] = field(default_factory=dict)
    """What else belongs to it: places and directions in the world [m], counts; plain values whose
    keys carry their unit."""
    remarks: tuple[str, ...] = ()
    """Why a number means less than its interval says, and what to do; sentences for the user."""
    places: Mapping[str, Vector] = field(default_factory=dict)
    """Where what was measured is, in the world [m], by names such as from and to."""

    def __getitem__(self, name: str) -> Quantity:
        """Give a quantity by its name.

        Raises:
            KeyError: There is none of that name.
        """
        for quantity in self.quantities:
            if quantity.name == name:
                return quantity
        raise KeyError(name)
