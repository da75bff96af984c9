"""Take measures of a scan, each with its uncertainty."""

from .distance import measure_distance as measure_distance
from .fits import measure_cylinder as measure_cylinder
from .fits import measure_plane as measure_plane
from .fits import measure_sphere as measure_sphere
from .sample import Sample as Sample
from .section import cut_section as cut_section
from .section import measure_section as measure_section
from .selection import Ball as Ball
from .selection import Box as Box
from .selection import Selection as Selection
