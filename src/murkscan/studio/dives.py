"""The live page: what a running dive shows of itself."""

from contextlib import suppress
from typing import Any

import numpy as np

from ..errors import FormatError, InputError
from ..io.json_files import load_json
from ..live import LiveFolder
from .sandbox import Sandbox

_MOST_PARTS = 60
"""Parts of the preview that go into one answer: a minute's."""


def tell_dive(sandbox: Sandbox, name: str) -> dict[str, Any]:
    """Say what a dive says of itself, and which pictures there are, by the time of their change.

    Of one that has only just begun there is nothing yet.

    Raises:
        InputError: It would not lie in the folder.
    """
    live = LiveFolder(sandbox.resolve(name) / "live")
    files = {"picture": live.picture, "stripe": live.stripe, "gaps": live.root / "gaps.png"}
    told: dict[str, Any] = {"status": None, "map": None, "parts": len(live.find_points())}
    # A file that is just being renamed into place is asked for again by the page.
    with suppress(FormatError):
        told["status"] = load_json(live.root / "status.json")
    with suppress(FormatError):
        told["map"] = load_json(live.root / "gaps.json")
    for kind, path in files.items():
        with suppress(OSError):
            told[kind] = f"{sandbox.name(path)}?{path.stat().st_mtime_ns}"
    return told


def pack_points(sandbox: Sandbox, name: str, first: int) -> tuple[bytes, int]:
    """Give the preview's points from a part on, as little-endian float32 x, y, z [m] and signal.

    Args:
        sandbox: The folder.
        name: The dive's, within it.
        first: Place of the first part that is wanted.

    Returns:
        The numbers, and the place of the part that follows.

    Raises:
        InputError: It does not lie in the folder.
    """
    if first < 0:
        raise InputError("Parts of a preview are numbered from 0.")
    live = LiveFolder(sandbox.existing(name) / "live")
    parts, rows = live.find_points()[first : first + _MOST_PARTS], list[np.ndarray]()
    for part in parts:
        with suppress(FormatError):
            points = live.load_points(part)
            rows.append(np.column_stack([points.points, points.signal]))
    numbers = np.concatenate(rows) if rows else np.zeros((0, 4))
    return numbers.astype("<f4").tobytes(), first + len(parts)
