"""Correct a vehicle's trajectory by what its scans show of the same places.

`adjust_passes` is the door; `docs/motion.md` tells the method.
"""

from .adjust import Adjusted as Adjusted
from .adjust import adjust_passes as adjust_passes
from .checks import Seams as Seams
from .legs import Pass as Pass
from .settings import AdjustSettings as AdjustSettings
