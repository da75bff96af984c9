"""What users write of a board, a port or lasers to calibrate, read."""

import re
from typing import TYPE_CHECKING

from ..errors import InputError
from .values import read_numbers

if TYPE_CHECKING:
    from ..calibrate import Margin
    from ..survey.calibrate_port import Measured

_NUMBER = r"[0-9]*\.?[0-9]+"


def read_lasers(text: str) -> tuple[int, ...]:
    """Read the numbers of --laser.

    Raises:
        InputError: They are none.
    """
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isdigit() for part in parts) or len(set(parts)) < len(parts):
        raise InputError(f"--laser {text!r} is no laser; give its number from 0, or several: 0,1.")
    return tuple(sorted(int(part) for part in parts))


def read_margin(text: str) -> "Margin":
    """Read the margin of --margin-mm.

    Raises:
        InputError: It is no four numbers.
    """
    sides = read_numbers(text, 4)
    if sides is None:
        raise InputError(
            f"--margin-mm {text!r} is not LEFT,RIGHT,TOP,BOTTOM; give four numbers of millimetres, "
            "such as 120,80,60,60."
        )
    from ..calibrate import Margin

    return Margin(*(side / 1e3 for side in sides))


def read_measured(text: str) -> "Measured":
    """Read a text such as 30±2 in millimetres [m].

    Raises:
        InputError: It is no value with its standard deviation.
    """
    match = re.fullmatch(rf"\s*({_NUMBER})\s*(?:±|\+/?-)\s*({_NUMBER})\s*", text)
    if match is None or not float(match[2]) > 0:
        raise InputError(
            f"--distance-mm {text!r} is not a value with its standard deviation; write it as 30±2 "
            "or 30+-2, in millimetres."
        )
    from ..survey.calibrate_port import Measured

    return Measured(float(match[1]) / 1e3, float(match[2]) / 1e3)
