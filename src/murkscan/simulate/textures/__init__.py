"""How surfaces are painted: each is a frozen dataclass, and `albedo` is its one verb."""

from .bands import Bands as Bands
from .base import AbstractTexture as AbstractTexture
from .checkered import Checkered as Checkered
from .growth import Growth as Growth
from .plain import Plain as Plain
