"""Where the camera was in each frame.

Every motion is a frozen dataclass: its fields are its settings, `follow` is its one verb.
"""

from .base import AbstractMotion as AbstractMotion
from .base import Direction as Direction
from .constant_speed import ConstantSpeed as ConstantSpeed
from .constant_step import ConstantStep as ConstantStep
from .pose_log import PoseLog as PoseLog
from .turntable import turn_about_axis as turn_about_axis
