"""Pictures of what was found: about twelve frames of a recording, among them the poorest."""

from collections.abc import Sequence
from pathlib import Path

from ..extract import draw_stripe
from ..project import Project
from ..types.frame import Frame
from ..types.stripe import Stripe

_POOR = "_poor"
"""What the names of the poorest frames' pictures end in."""
_REGULAR = 8
"""Overlays kept from all over the recording."""
_POOREST = 4
"""Overlays kept of frames with the fewest points."""


def draw_overlays(project: Project, found: Sequence[tuple[Frame, Stripe]], *, step: int) -> None:
    """Draw every step-th frame of a chunk, and its poorest one that is not among them."""
    regular = [pair for pair in found if pair[0].index % step == step // 2]
    for frame, stripe in regular:
        project.save_overlay(f"{frame.index:06d}", draw_stripe(frame, stripe))
    others = [pair for pair in found if pair[0].index % step != step // 2]
    if others:
        frame, stripe = min(others, key=lambda pair: len(pair[1]))
        project.save_overlay(f"{frame.index:06d}{_POOR}", draw_stripe(frame, stripe))


def keep_overlays(project: Project) -> None:
    """Of all that were drawn keep some, evenly, and of the poorest frames the poorest few.

    A frame without a stripe says little: those that have one come first.
    """
    notes = [note for _, note in project.load_stripe_notes()]
    points = {
        index: count
        for note in notes
        for index, count in zip(note["frames"], note["points"], strict=True)
    }
    drawn = project.find_overlays()
    poor = [file for file in drawn if file.stem.endswith(_POOR)]
    poor.sort(key=lambda file: points[_frame_of(file)] or len(points) * 1_000_000)
    regular = [file for file in drawn if not file.stem.endswith(_POOR)]
    step = -(-len(regular) // _REGULAR) or 1
    for file in {*poor[_POOREST:], *regular} - set(regular[step // 2 :: step]):
        file.unlink()


def _frame_of(overlay: Path) -> int:
    return int(overlay.stem.removesuffix(_POOR))
