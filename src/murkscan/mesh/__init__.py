"""Make a surface of a cloud.

Every mesher is a frozen dataclass: its fields are its settings, `mesh` is its one verb.
"""

from .base import AbstractMesher as AbstractMesher
from .grid_mesh import GridMesh as GridMesh
from .poisson import Poisson as Poisson
