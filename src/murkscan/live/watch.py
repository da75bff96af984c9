"""What a pilot must know at once: no stripe, a lamp, a fogged window, an exposure that moves."""

import math
from collections import deque

import numpy as np
from jaxtyping import Float

from ..types.frame import Frame
from .gauges import Look

_LIT = 0.2
"""Share of white from which the darker half of a picture is lit by something else."""
_STEP = 1.3
"""Ratio of the picture's brightness to that of its first seconds from which the exposure has
changed: as the report's."""
_SEEN = 1.5
"""Grey levels above the darkest from which light in the water is told from none."""
_FEWEST = 200
"""Places that must show such light to be compared."""
_EVERY = 8
"""Pixels from one place to the next: brightness needs no more."""
_REFERENCE = 25
"""Frames whose median is what later ones are compared with."""
_WIDER = 1.6
"""Width of the stripe, over that of its first seconds, from which the picture is no longer sharp:
what is measured is across the line, where it is not overexposed, and nearness is allowed for."""
_LEAST_WIDTH = 2.0
"""Width that counts at least [px]: one pixel is no measure of a factor."""
_LASTING = 1.0
"""Time for which something must go on before it is told [s]: not for a fish."""

Levels = Float[np.ndarray, "places"]


class PictureWatch:
    """Looks at frames as they come, in order of time, for what spoils a scan."""

    def __init__(self) -> None:
        """Begin with nothing seen."""
        self._bits = 8
        self._first: dict[int, list[Levels]] = {}
        self._reference: dict[int, Levels] = {}
        self._since: dict[str, float] = {}
        self._now = 0.0
        self._factors: deque[float] = deque(maxlen=_REFERENCE)
        self._was_seen = False
        self._sharp: list[tuple[float, float]] = []
        self._spread: deque[float] = deque(maxlen=_REFERENCE)

    def look(self, frame: Frame, look: Look | None) -> None:
        """Take note of a frame.

        Args:
            frame: The frame.
            look: What was found in it; None where that was not looked for.
        """
        self._now = frame.time
        image = frame.image[::_EVERY, ::_EVERY]
        # Of 16 bits a camera may use 10 or 12: the brightest pixel so far tells.
        self._bits = max(self._bits, int(frame.image.max(initial=0)).bit_length())
        self._note("lamp", float(np.median(image)) > _LIT * self._white)
        if look is not None:
            self._note("stripe", not look.is_seen)
            self._was_seen |= look.is_seen
            if look.is_seen and math.isfinite(look.width * look.depth):
                self._note("fog", self._is_blurred(look))
        factor = self._compare(frame.first_row, image.astype(float).ravel())
        self._factors.append(factor)
        moved = float(np.median(self._factors))
        self._note("exposure", not 1 / _STEP <= moved <= _STEP)

    def warnings(self) -> tuple[str, ...]:
        """Say what is wrong by now; nothing on a good dive."""
        lost = (
            "The stripe is lost: turn back to where it was, come nearer, and see that the laser is "
            "on."
            if self._was_seen
            else "No stripe has been seen yet: is the laser on, and does it cross the picture?"
        )
        said = {
            "stripe": lost,
            "lamp": "A lamp is on, or daylight comes in: half of the picture is bright by it. Turn "
            "lamps off or shade the camera, since their light is noise.",
            "fog": "The stripe has become blurred: the window is fogged or dirty, or the lens is "
            "out of focus. Wipe it, or let it clear, before going on.",
            "exposure": "The exposure moves: the picture's brightness is no longer that of the "
            "first seconds. Fix exposure and gain, so that signals can be compared.",
        }
        told = [n for n in said if self._now - self._since.get(n, self._now) >= _LASTING]
        if {"fog", "stripe"} & set(self._since):
            # A blur spreads light over the picture, and a laser that is off takes it away.
            told = [name for name in told if name != "exposure"]
        return tuple(said[name] for name in told)

    @property
    def _white(self) -> float:
        return float(2**self._bits - 1)

    def _note(self, name: str, is_so: bool) -> None:
        if is_so:
            self._since.setdefault(name, self._now)
        else:
            self._since.pop(name, None)

    def _is_blurred(self, look: Look) -> bool:
        """Tell whether the stripe is wider than in the first seconds, nearness allowed for.

        A sheet's thickness in pixels goes as one over the distance; a lens's blur is constant.
        """
        if len(self._sharp) < _REFERENCE:
            self._sharp.append((look.width, look.depth))
            return False
        width, depth = np.median(self._sharp, axis=0)
        self._spread.append(look.width / max(width * max(1.0, depth / look.depth), _LEAST_WIDTH))
        return float(np.median(self._spread)) > _WIDER

    def _compare(self, kind: int, levels: Levels) -> float:
        """Give the factor of brightness against the first frames of the same rows; 1 unknown."""
        if kind not in self._reference:
            first = self._first.setdefault(kind, [])
            first.append(levels)
            if len(first) == _REFERENCE:
                self._reference[kind] = np.median(first, axis=0)
                del self._first[kind]
            return 1.0
        return _shared_factor(levels, self._reference[kind], self._white)


def _shared_factor(levels: Levels, reference: Levels, white: float) -> float:
    """Give the factor that dim, middling and bright places have in common.

    Exposure multiplies all alike; a surface that comes nearer hides light of the water in some.
    """
    dark = float(reference.min())
    usual = reference - dark
    lit = np.flatnonzero((usual > _SEEN) & (reference < white) & (levels < white))
    if len(lit) < _FEWEST:
        return 1.0
    thirds = np.array_split(lit[np.argsort(usual[lit])], 3)
    factors = [float(np.median((levels[third] - dark) / usual[third])) for third in thirds]
    return max(1.0, min(factors)) * min(1.0, max(factors))
