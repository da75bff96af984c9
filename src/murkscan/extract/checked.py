"""What an extractor gave, looked at before it is believed: it may be one's own."""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from ..errors import InputError
from ..types.frame import Frame
from ..types.stripe import Stripe
from .base import AbstractExtractor

_ONE_EACH = "{name} must give one stripe a frame, of length 0 where there is none; "
_TOO_FEW = _ONE_EACH + "it gave {given} and none for frame {frame}."
_TOO_MANY = _ONE_EACH + "of {frames} frames it gave more."
_EDGE = 0.5
"""How far a pixel reaches from its centre [px]."""


def require_extractor(extractor: AbstractExtractor) -> None:
    """Refuse an extractor whose settings cannot be written down.

    Raises:
        InputError: It is no frozen dataclass.
    """
    if not dataclasses.is_dataclass(extractor):
        raise InputError(
            f"{type(extractor).__name__} must be a dataclass (@dataclass(frozen=True)): its fields "
            "are its settings, by which a scan knows whether it is up to date."
        )


def check_stripes(
    extractor: AbstractExtractor,
    stripes: Iterable[Stripe],
    frames: Iterable[Frame],
    *,
    size: tuple[int, int],
    laser: int,
) -> Iterator[Stripe]:
    """Pass stripes on, one a frame, as long as they can be.

    Args:
        extractor: Who gives them, for the message.
        stripes: What it gives.
        frames: What it was given.
        size: Width and height of the full frame [px].
        laser: Number of the laser whose stripe was looked for.

    Yields:
        The same.

    Raises:
        InputError: One of them cannot be; the message names the extractor, the frame and the fault.
    """
    name, given, number = type(extractor).__name__, iter(stripes), 0
    for number, frame in enumerate(frames, 1):
        if (stripe := next(given, None)) is None:
            raise InputError(_TOO_FEW.format(name=name, frame=frame.index, given=number - 1))
        if not isinstance(stripe, Stripe):
            fault = f"is a {type(stripe).__name__}, no Stripe"
        else:
            fault = _find_fault(stripe, frame, size, laser)
        if fault:
            raise InputError(f"{name}: what it gave for frame {frame.index} {fault}.")
        yield stripe
    if next(given, None) is not None:
        raise InputError(_TOO_MANY.format(name=name, frames=number))


def _find_fault(stripe: Stripe, frame: Frame, size: tuple[int, int], laser: int) -> str:
    """Say in half a sentence why a stripe cannot be; nothing where it can."""
    columns = {f.name: getattr(stripe, f.name) for f in dataclasses.fields(stripe)}
    for name, values in columns.items():
        if not np.isfinite(values).all():
            return f"has a {name} that is no finite number"
    inside = (columns["pixels"] >= -_EDGE) & (columns["pixels"] <= np.array(size) - _EDGE)
    faults = {
        "belongs to another frame": (columns["frame"] != frame.index).any(),
        "has another time": (columns["time"] != frame.time).any(),
        f"has another laser than {laser}": (columns["laser"] != laser).any(),
        f"lies outside of the picture of {size[0]} × {size[1]} px": not inside.all(),
        "has a sigma that is not above 0": (columns["sigma"] <= 0).any(),
        "has a posterior that is no probability": not _are_shares(columns["posterior"]),
    }
    return next((fault for fault, is_there in faults.items() if is_there), "")


def _are_shares(values: np.ndarray) -> bool:
    return bool(((values >= 0) & (values <= 1)).all())
