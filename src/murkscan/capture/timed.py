"""A time for each picture of a video, later than that of the one before."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from .clock import Clock
from .decode import Loss, Picture, picture_time


@dataclass(frozen=True, eq=False)
class TimedPicture:
    """A picture whose time and distance to the next one are known."""

    number: int
    """Its number in the recording, counted with those that are lost."""
    decoded: Any
    """What PyAV decoded."""
    time: float
    """Recording time [s]; the number where the recording has no times."""
    period: float
    """Time by which the next picture may come [s], of which the second field takes half."""


def time_pictures(items: Iterable[Picture | Loss], clock: Clock) -> Iterator[TimedPicture | Loss]:
    """Give the pictures of a whole video their times, which strictly increase.

    A picture whose time is not after that of the last good one is a loss: where it belongs cannot
    be known, and a made-up time would put its profile at a made-up place. One picture is held
    back, because its second field must come before the next picture.

    Args:
        items: What `decode_pictures` gives of the video from its beginning.
        clock: What the container's times mean.
    """
    held: tuple[Picture, float] | None = None
    losses: list[Loss] = []  # Those behind the picture that is held.
    for item in items:
        if isinstance(item, Loss):
            losses.append(item)
            continue
        time = clock.time_of(item.number, picture_time(item.decoded))
        if held is not None and time <= held[1]:
            _add_untimed(losses, item.number)
            continue
        if held is not None:
            apart = (time - held[1]) / (item.number - held[0].number)
            yield _as_timed(held, clock.cut_period(apart))
        yield from losses
        held, losses = (item, time), []
    if held is not None:
        yield _as_timed(held, clock.period)
        yield from losses
        yield from _find_cut(held[0], losses, clock)
    else:
        yield from losses


def _as_timed(held: tuple[Picture, float], period: float) -> TimedPicture:
    return TimedPicture(held[0].number, held[0].decoded, held[1], period)


def _add_untimed(losses: list[Loss], number: int) -> None:
    """Note a picture out of time, together with those just before it that are so as well."""
    if losses and losses[-1].why == "untimed" and losses[-1].end == number:
        losses[-1] = Loss(losses[-1].first, losses[-1].count + 1, "untimed")
    else:
        losses.append(Loss(number, 1, "untimed"))


def _find_cut(last: Picture, losses: list[Loss], clock: Clock) -> Iterator[Loss]:
    """Find what the file promises behind its last picture, beyond the losses known already."""
    known = losses[-1].end if losses else last.number + 1
    promised = last.number + 1 + clock.count_missing(picture_time(last.decoded))
    if promised > known:
        yield Loss(known, promised - known, "cut")
