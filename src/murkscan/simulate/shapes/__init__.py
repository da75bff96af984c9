"""Objects to scan: each is a frozen dataclass of sizes in metres, and `mesh` is its one verb."""

from .base import AbstractShape as AbstractShape
from .chessboard import Chessboard as Chessboard
from .cylinder import Cylinder as Cylinder
from .grown import Grown as Grown
from .hull import Hull as Hull
from .plane import Plane as Plane
from .sheet_pile import SheetPile as SheetPile
from .sphere import Sphere as Sphere
from .stairs import Stairs as Stairs
