"""Make recordings whose truth is known, by plain ray-sheet geometry."""

from .base import AbstractSurface as AbstractSurface
from .demo import HULL_SPEED as HULL_SPEED
from .demo import hull_rig as hull_rig
from .demo import hull_scene as hull_scene
from .flat_wall import FlatWall as FlatWall
from .frames import SimulatedFrame as SimulatedFrame
from .frames import simulate_frames as simulate_frames
from .scene import Light as Light
from .scene import Scene as Scene
from .truth import distance_to_surface as distance_to_surface
from .truth import sample_mesh as sample_mesh
from .truth import surface_normals as surface_normals
from .wigley_hull import WigleyHull as WigleyHull
