"""Turn stripes in the picture into profiles in space.

Every triangulation is a frozen dataclass; `locate` is its one verb, `triangulate` joins it to the
values.
"""

from .base import AbstractTriangulation as AbstractTriangulation
from .base import triangulate as triangulate
from .baseline_angle import BaselineAngle as BaselineAngle
from .paint_pull import learn_paint_pulls as learn_paint_pulls
from .paint_pull import undo_paint_pull as undo_paint_pull
from .ray_sheet import RaySheet as RaySheet
