"""Take measures of a scan, each with its uncertainty."""

from .dents import DentSearch as DentSearch
from .dents import find_dents as find_dents
from .departure import measure_departure as measure_departure
from .departure import sigma_of_points as sigma_of_points
from .deviation import deviation_from_mesh as deviation_from_mesh
from .deviation import deviation_from_smooth as deviation_from_smooth
from .distance import measure_distance as measure_distance
from .enclosed import measure_enclosed as measure_enclosed
from .extent import cut_out as cut_out
from .extent import measure_area as measure_area
from .extent import measure_volume as measure_volume
from .fits import measure_cylinder as measure_cylinder
from .fits import measure_plane as measure_plane
from .fits import measure_sphere as measure_sphere
from .fits import trust_plane as trust_plane
from .histogram import draw_histogram as draw_histogram
from .lengths import require_dent_sizes as require_dent_sizes
from .sample import Sample as Sample
from .section import cut_section as cut_section
from .section import measure_section as measure_section
from .selection import Ball as Ball
from .selection import Box as Box
from .selection import Selection as Selection
from .step import measure_step as measure_step
