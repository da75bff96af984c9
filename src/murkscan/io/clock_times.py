"""Times as logs write them: in one of four units, or as dates."""

from datetime import UTC, datetime
from typing import Literal

import numpy as np

from ..types.arrays import Scalars

TimeUnit = Literal["s", "ms", "us", "ns"]
"""What a number in a column of times counts."""
TICKS: dict[TimeUnit, float] = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
"""Ticks a second."""
UNIX = 1e8
"""Times above this count seconds since 1970, those below it a clock of their own [s]."""
_LARGEST = 1e11
"""Times of the years up to 5138 lie below this in seconds, above it in smaller units."""


def guess_unit(times: Scalars) -> TimeUnit:
    """Tell by their size in which unit times since 1970 are; small ones are seconds."""
    largest = float(np.nanmax(np.abs(times), initial=0.0))
    for unit, ticks in TICKS.items():
        if largest < _LARGEST * ticks:
            return unit
    return "ns"


def read_moment(text: str) -> float:
    """Read a date and time in ISO 8601 [s since 1970]; in UTC unless it says otherwise.

    Raises:
        ValueError: It is none.
    """
    moment = datetime.fromisoformat(text.strip().replace("/", "-"))
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def say_moment(time: float) -> str:
    """Write a time [s]: as a date and in UTC where it counts from 1970."""
    if time < UNIX:
        return f"{time:.3f} s"
    try:
        moment = datetime.fromtimestamp(time, UTC)
    except (OverflowError, ValueError, OSError):  # a clock that counts something else
        return f"{time:.3f} s"
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")
