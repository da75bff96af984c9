"""Pictures of what was found: about twelve frames of a recording, among them the poorest."""

from collections.abc import Sequence
from pathlib import Path

from ..extract import draw_stripe
from ..io.images import write_image
from ..project import Project
from ..types.frame import Frame
from ..types.stripe import Stripe

_POOR = "_poor"
"""What the names of the poorest frames' pictures end in."""
_POOREST = 4
"""Overlays kept of frames with the fewest points."""


def draw_overlays(project: Project, found: Sequence[tuple[Frame, Stripe]], *, step: int) -> None:
    """Draw every step-th frame of a chunk, and its poorest one that is not among them."""
    regular = [pair for pair in found if pair[0].index % step == step // 2]
    for frame, stripe in regular:
        write_image(_folder(project) / f"{frame.index:06d}.png", draw_stripe(frame, stripe))
    others = [pair for pair in found if pair[0].index % step != step // 2]
    if others:
        frame, stripe = min(others, key=lambda pair: len(pair[1]))
        path = _folder(project) / f"{frame.index:06d}{_POOR}.png"
        write_image(path, draw_stripe(frame, stripe))


def keep_overlays(project: Project) -> None:
    """Of the poorest frames of all chunks keep the poorest few."""
    notes = [note for _, note in project.load_stripe_notes()]
    points = {
        index: count
        for note in notes
        for index, count in zip(note["frames"], note["points"], strict=True)
    }
    poor = list(_folder(project).glob(f"*{_POOR}.png"))
    poor.sort(key=lambda file: points.get(int(file.stem.removesuffix(_POOR)), 0))
    for file in poor[_POOREST:]:
        file.unlink()


def _folder(project: Project) -> Path:
    return project.root / "extract" / "overlay"
