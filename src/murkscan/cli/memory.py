"""What threads have let go of is there for all of them."""

import ctypes
from contextlib import suppress

_MOST_ARENAS = -8
"""`M_ARENA_MAX` of malloc.h in glibc."""


def share_freed_memory() -> None:
    """Let threads share what they free, where the C library is glibc; elsewhere nothing is done.

    Each thread has an arena of its own there, eight a core, which keeps the most that it has ever
    held: pictures of 1920 × 1200 px and their scores are 2 and 9 MB. With two for all of them,
    `extract` of such pictures holds 640 MB instead of 760, and takes no longer.

    References:
        mallopt(3), Linux man-pages.
    """
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).mallopt(_MOST_ARENAS, 2)
