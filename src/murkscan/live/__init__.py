"""What a dive shows while it goes on: gauges, a preview that grows, and a map of its gaps."""

from .folder import LiveFolder as LiveFolder
from .folder import LivePoints as LivePoints
from .gap_map import GapMap as GapMap
from .status import LiveStatus as LiveStatus
