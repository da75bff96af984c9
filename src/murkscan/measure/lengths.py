"""Lengths that say what is looked for."""

import math

from ..errors import InputError


def require_length(name: str, length: float) -> None:
    """Refuse a length that is none.

    Args:
        name: What it is, as its flag is called: such as `reach`.
        length: The length [m].

    Raises:
        InputError: It is 0, negative, not finite or not a number.
    """
    if not 0 < length < math.inf:
        raise InputError(f"--{name}-mm must be above 0 and finite, got {length * 1e3:g} mm.")


def require_dent_sizes(
    *, smallest: float, largest: float | None = None, least_depth: float = 0.0
) -> None:
    """Refuse sizes that no dent has.

    Args:
        smallest: Width of the smallest dent looked for [m].
        largest: Width of the largest one [m]; None: not looked at.
        least_depth: Depth below which none is told [m].

    Raises:
        InputError: One is negative or not finite, or the largest is below the smallest.
    """
    require_length("smallest", smallest)
    if not 0 <= least_depth < math.inf:
        raise InputError(
            f"--least-depth-mm must be 0 or above and finite, got {least_depth * 1e3:g} mm."
        )
    if largest is None:
        return
    require_length("largest", largest)
    if largest < smallest:
        raise InputError(
            f"--largest-mm {largest * 1e3:g} is below --smallest-mm {smallest * 1e3:g}; give a "
            "larger one."
        )
