"""How a dive is recorded, shown and scanned."""

import shutil
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

from ..capture.field_order import Fields
from ..distribute import AbstractExecutor, Processes
from ..extract import AbstractExtractor
from ..motion import AbstractMotion
from ..motion.following import AbstractFollower
from ..triangulate import AbstractTriangulation


@dataclass(frozen=True, eq=False)
class LiveSettings:
    """How a dive is recorded, shown and scanned."""

    follow: Callable[[float], AbstractFollower]
    """Makes what follows the camera, given when the recording began [s since 1970]."""
    move: Callable[[float], AbstractMotion]
    """Makes the motion of the scan, given the same, when the dive is over."""
    extractor: AbstractExtractor
    method: AbstractTriangulation
    lasers: tuple[int, ...] = ()
    """Numbers of the lasers whose stripes the scan follows, all of the rig unless given; the
    preview follows the first of them."""
    spacing: float = 5e-3
    """Wanted spacing of the points [m]."""
    working: tuple[float, float] | None = None
    """Nearest and farthest depth at which the rig was calibrated [m], if that is known."""
    fields: Fields = "auto"
    timeout: float = 10.0
    """Longest wait for the stream and for its next picture [s]."""
    patience: float = 60.0
    """How long a lost stream is waited for [s]."""
    beside: Callable[[], AbstractContextManager[None]] = nullcontext
    """Makes what is done while the dive goes on, such as the writing of the vehicle's log."""
    learner: AbstractExecutor = field(default_factory=lambda: Processes(1, niceness=19))
    """Who learns while the dive goes on: what it needs of the processor is what others leave."""
    find_room: Callable[[Path], int] = lambda folder: shutil.disk_usage(folder).free
    """Tells how much room a folder's disk has [bytes]."""

    @property
    def laser(self) -> int:
        """Number of the laser whose stripe the preview follows."""
        return min(self.lasers, default=0)
