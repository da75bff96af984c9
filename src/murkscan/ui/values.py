"""What users write as the value of a flag or a field, read."""

import math
from typing import TYPE_CHECKING

from ..errors import InputError

if TYPE_CHECKING:
    from ..types.pose import Pose

Corner = tuple[float, float, float]


def read_numbers(text: str, count: int) -> list[float] | None:
    """Read finite numbers that commas part; None where they are no numbers, or not so many."""
    try:
        numbers = [float(number) for number in text.split(",")]
    except ValueError:
        return None
    return numbers if len(numbers) == count and all(map(math.isfinite, numbers)) else None


def read_box(flag: str, text: str) -> tuple[Corner, Corner]:
    """Read the lowest and the highest corner of a box from any two opposite ones [m].

    Raises:
        InputError: They are no numbers.
    """
    numbers = read_numbers(text, 6)
    if numbers is None:
        raise InputError(
            f"{flag} {text!r} is not X,Y,Z,X,Y,Z: give two corners of a box in metres."
        )
    pairs = [sorted(pair) for pair in zip(numbers[:3], numbers[3:], strict=True)]
    (x, x_high), (y, y_high), (z, z_high) = pairs
    return (x, y, z), (x_high, y_high, z_high)


def read_pose(flag: str, text: str) -> "Pose":
    """Read a place [m], or a place and a quaternion wxyz of any length but 0.

    Raises:
        InputError: They are no such numbers.
    """
    import numpy as np

    from ..types.pose import Pose

    numbers = read_numbers(text, 3) or read_numbers(text, 7)
    attitude = [1.0, 0.0, 0.0, 0.0] if numbers is None or len(numbers) == 3 else numbers[3:]
    if numbers is None or not any(attitude):
        raise InputError(
            f"{flag} {text!r} is neither X,Y,Z in metres nor X,Y,Z,QW,QX,QY,QZ with a quaternion."
        )
    return Pose.from_quaternion(np.array([attitude]), np.array(numbers[:3]))


def read_start_time(text: str) -> float:
    """Read --start-time [s]: seconds, or ISO 8601, in UTC unless it says otherwise."""
    from ..io.clock_times import read_moment

    try:
        return float(text)
    except ValueError:
        pass
    try:
        return read_moment(text)
    except (ValueError, OverflowError) as error:
        raise InputError(
            f"--start-time {text!r} is neither seconds nor a time such as 2026-05-01T09:30:00Z."
        ) from error
