"""Make recordings whose truth is known: light through water and glass, as a camera keeps it."""

from ..optics.beam import Light as Light
from ..optics.lamp import Lamp as Lamp
from ..optics.sensor import Sensor as Sensor
from .frames import LightImage as LightImage
from .frames import SimulatedFrame as SimulatedFrame
from .frames import Simulator as Simulator
from .frames import simulate_frames as simulate_frames
from .line_image import LineImage as LineImage
from .overlay import Overlay as Overlay
from .particles import Particles as Particles
from .processing import Processing as Processing
from .recorder import Recorder as Recorder
from .scene import Scene as Scene
from .scene_file import as_standalone as as_standalone
from .scene_file import list_scenes as list_scenes
from .scene_file import load_scene as load_scene
from .scene_file import parse_scene as parse_scene
from .scene_file import read_scene as read_scene
from .sensor import as_colour as as_colour
from .surface import Body as Body
from .vehicle import Navigation as Navigation
from .vehicle import Unrest as Unrest
from .vehicle import drive as drive
from .vehicle import log_navigation as log_navigation
from .window import Window as Window
