"""Several lasers in one recording: who can tell their lines apart, and what is said of them."""

from collections.abc import Mapping, Sequence

from ..errors import InputError
from .base import AbstractExtractor


def check_extractor(extractor: AbstractExtractor, lasers: Sequence[int]) -> None:
    """Refuse several lasers where an extractor would take each one's line for the other's."""
    if len(lasers) > 1 and not extractor.tells_lasers_apart:
        raise InputError(
            f"{type(extractor).__name__} cannot tell the lines of {len(lasers)} lasers apart; use "
            "murk, or say with --laser N whose line it is where one of them was on."
        )


def join_remarks(remarks: Mapping[int, Sequence[str]], points: Sequence[int]) -> tuple[str, ...]:
    """Join what was odd about a recording as each laser's line showed it.

    Args:
        remarks: What was said for each laser, by its number.
        points: Stripe centres found of each.

    Returns:
        The sentences; one that is not said for all lasers names its own.
    """
    every = list(dict.fromkeys(words for said in remarks.values() for words in said))
    joined = []
    for words in every:
        of = [number for number, said in remarks.items() if words in said]
        named = "" if len(of) == len(remarks) else f"laser {', '.join(map(str, of))}: "
        joined.append(named + words)
    if any(points):
        joined += [
            f"No frame shows the line of laser {number}: was it on, is its sheet in the picture, "
            "and is it the one in the rig file? The scan is that of the other lasers."
            for number, count in zip(remarks, points, strict=True)
            if not count
        ]
    return tuple(joined)
