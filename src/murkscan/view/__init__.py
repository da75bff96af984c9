"""Pictures of a surface or of a cloud, drawn without a screen and without a graphics card."""

from .base import AbstractColours as AbstractColours
from .base import Legend as Legend
from .depth import Depth as Depth
from .gallery import PICTURES as PICTURES
from .gallery import draw_pictures as draw_pictures
from .plain import Plain as Plain
from .render import render as render
from .views import View as View
from .views import standard_views as standard_views
