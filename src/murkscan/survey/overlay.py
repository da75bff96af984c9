"""Pictures of what was found: about twelve frames of a recording, among them the poorest."""

from collections.abc import Sequence
from pathlib import Path

from ..extract import draw_stripe
from ..io.images import write_image
from ..project import Project
from ..types.frame import Frame
from ..types.stripe import Stripe

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
        name = f"poor_{len(stripe):06d}_points_{frame.index:06d}.png"
        write_image(_folder(project) / name, draw_stripe(frame, stripe))


def keep_overlays(project: Project) -> None:
    """Of the poorest frames of all chunks keep the poorest few."""
    for file in sorted(_folder(project).glob("poor_*.png"))[_POOREST:]:
        file.unlink()


def _folder(project: Project) -> Path:
    return project.root / "extract" / "overlay"
