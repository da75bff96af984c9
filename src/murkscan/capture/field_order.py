"""Whether a recording's pictures are fields: as said, as they show, or as they are marked."""

from collections.abc import Callable, Iterable, Sequence
from typing import Literal

from ..types.arrays import Image
from .fields import FieldOrder, FieldVerdict, find_field_order

Fields = Literal["auto", "progressive", "top-first", "bottom-first"]
"""What the pictures are made of: found from the pictures, or said."""
RUN = 5
"""Pictures in a run that is looked at for fields."""
RUNS = (5, 20)
"""Runs to look at; the second number where the first left it open, or showed fields."""


def decide_order(
    fields: Fields,
    runs: Callable[[int], Iterable[Sequence[Image]]],
    flag: FieldOrder = "progressive",
) -> FieldOrder:
    """Take what the user says; else what the pictures tell; else, where nothing moves, the flag.

    That they are fields must be told by the second, longer look, too. Fields of an order that
    nothing tells are taken as the flag says, or top first, as PAL has them.
    """
    if fields != "auto":
        return fields
    verdict: FieldVerdict = "undecided"
    for count in RUNS:
        # A stripe that creeps makes a few pictures lean as fields do: those get a second look.
        verdict = find_field_order(runs(count))
        if verdict == "progressive":
            return verdict
    if verdict == "top-first" or verdict == "bottom-first":
        return verdict
    return "top-first" if verdict == "interlaced" and flag == "progressive" else flag


def say_order(order: FieldOrder, fields: Fields) -> tuple[str, ...]:
    """Say that pictures are split into fields, where nobody has asked for it."""
    if fields != "auto" or order == "progressive":
        return ()
    first = "upper" if order == "top-first" else "lower"
    return (
        f"its pictures hold two fields each, the {first} one first: each field is a frame; if that "
        "is wrong, say --fields progressive",
    )
