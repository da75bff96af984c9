"""Whether the log that is followed and the pictures go by the same clock."""

import math

PATIENCE = 5.0
"""How long a frame waits for its pose from a log [s]; then it is left out of the preview."""
_AHEAD = 1.5
"""Lead of a log over the pictures that their own delay does not explain [s]."""
_LASTING = 1.0
"""Time for which it must be so before it is told [s]."""


class LogWatch:
    """Looks now and then at which times are known of a log, and which pictures there are."""

    def __init__(self, *, is_replayed: bool) -> None:
        """Begin with nothing wrong.

        Args:
            is_replayed: Whether the pictures are of before; then the log may end after them.
        """
        self._is_replayed = is_replayed
        self._off: float | None = None
        self._since, self._now = math.inf, 0.0

    def look(self, newest: float, known_from: float, known_until: float) -> None:
        """Take note of where pictures and log are.

        Args:
            newest: Recording time of the newest picture [s].
            known_from: Recording time from which poses are known [s]; inf where none are.
            known_until: The same up to which they are; inf for a motion without a log.
        """
        self._now = newest
        self._off = self._find_offset(newest, known_from, known_until)
        self._since = math.inf if self._off is None else min(self._since, newest)

    def warnings(self) -> tuple[str, ...]:
        """Say how far apart both are; nothing where they agree."""
        if self._off is None or self._now - self._since < _LASTING:
            return ()
        if math.isinf(self._off):
            return ("The log has no pose yet: see that what writes it is running.",)
        side = "behind" if self._off > 0 else "ahead of"
        return (
            f"The log's clock does not fit: it is {_say(abs(self._off))} {side} the pictures. Set "
            "the clocks alike, see that the log is still written, or give --time-offset-s or "
            "--start-time.",
        )

    def _find_offset(self, newest: float, known_from: float, known_until: float) -> float | None:
        """Give how far the log is behind the pictures [s]; None where both agree."""
        if newest - known_until > PATIENCE:
            return newest - known_until
        if math.isfinite(known_from) and newest < known_from - _AHEAD:
            return newest - known_from
        is_ahead = math.isfinite(known_until) and known_until - newest > _AHEAD
        return newest - known_until if is_ahead and not self._is_replayed else None


def _say(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"
