"""Pictures of what was found: about twelve frames of a recording, among them the poorest.

Which frames are drawn, and which of the drawings stay, follows from the notes of the parts alone:
so a run that was killed, or lost a part, ends with the same pictures as any other.
"""

from collections.abc import Iterable

from ..types.frame import Frame
from ..types.part_note import PartNote
from ..types.stripe import Stripe

_POOR = "_poor"
"""What the names of the poorest frames' pictures end in."""
_REGULAR = 8
"""Overlays kept from all over the recording."""
_POOREST = 4
"""Overlays kept of frames with the fewest points."""


class Candidates:
    """The frames of a part whose drawings may be chosen to stay: no others are held."""

    def __init__(self, step: int) -> None:
        """Begin with none.

        Args:
            step: See `name_candidates`.
        """
        self._step = step
        self._regular = list[tuple[Frame, Stripe]]()
        self._poorest: tuple[Frame, Stripe] | None = None

    def add(self, frame: Frame, stripe: Stripe) -> None:
        """Look at the part's next frame."""
        if _is_regular(frame.index, self._step):
            self._regular.append((frame, stripe))
        elif self._poorest is None or len(stripe) < len(self._poorest[1]):
            self._poorest = frame, stripe

    def by_name(self) -> dict[str, tuple[Frame, Stripe]]:
        """List them by the names of their pictures; see `name_candidates`."""
        named = {f"{frame.index:06d}": (frame, stripe) for frame, stripe in self._regular}
        if self._poorest is not None:
            named[f"{self._poorest[0].index:06d}{_POOR}"] = self._poorest
        return named


def name_candidates(note: PartNote, *, step: int) -> list[str]:
    """Name every step-th frame of a part, and its poorest one that is not among them."""
    regular = [index for index in note.frames if _is_regular(index, step)]
    others = [
        (count, index)
        for index, count in zip(note.frames, note.points, strict=True)
        if index not in regular
    ]
    poorest = [min(others)[1]] if others else []
    return [f"{index:06d}" for index in regular] + [f"{index:06d}{_POOR}" for index in poorest]


def choose_overlays(notes: Iterable[PartNote], *, step: int) -> set[str]:
    """Choose of all candidates some, evenly, and of the poorest frames the poorest few.

    A frame without a stripe says little: those that have one come first.
    """
    points: dict[int, int] = {}
    drawn: list[str] = []
    for note in notes:
        points.update(zip(note.frames, note.points, strict=True))
        drawn += name_candidates(note, step=step)
    poor = [name for name in sorted(drawn) if name.endswith(_POOR)]
    poor.sort(key=lambda name: (points[_frame_of(name)] == 0, points[_frame_of(name)]))
    regular = [name for name in sorted(drawn) if not name.endswith(_POOR)]
    stride = -(-len(regular) // _REGULAR) or 1
    return {*poor[:_POOREST], *regular[stride // 2 :: stride]}


def _is_regular(index: int, step: int) -> bool:
    return index % step == step // 2


def _frame_of(overlay: str) -> int:
    return int(overlay.removesuffix(_POOR))
