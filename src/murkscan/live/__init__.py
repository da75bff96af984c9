"""What a dive shows while it goes on: gauges, a preview that grows, and a map of its gaps."""

from .drawing import draw_picture as draw_picture
from .folder import LiveFolder as LiveFolder
from .folder import LivePoints as LivePoints
from .gap_map import GapMap as GapMap
from .gauges import Look as Look
from .gauges import gauge_disk as gauge_disk
from .gauges import gauge_speed as gauge_speed
from .gauges import gauge_stand_off as gauge_stand_off
from .gauges import gauge_stripe as gauge_stripe
from .gauges import gauge_water as gauge_water
from .gauges import warn_of_disk as warn_of_disk
from .log_watch import PATIENCE as PATIENCE
from .log_watch import LogWatch as LogWatch
from .mailbox import Mailbox as Mailbox
from .recent import RecentLooks as RecentLooks
from .recent import speed_of as speed_of
from .sharpness import measure_stripe_width as measure_stripe_width
from .spread import SpreadFrames as SpreadFrames
from .status import LiveStatus as LiveStatus
from .thinned import thin_points as thin_points
from .watch import PictureWatch as PictureWatch
from .working_range import find_calibrated_range as find_calibrated_range
from .working_range import find_working_range as find_working_range
