"""Pictures of a surface or of a cloud, drawn without a screen, and a page to measure on."""

from .base import AbstractColours as AbstractColours
from .base import Legend as Legend
from .depth import Depth as Depth
from .gallery import PICTURES as PICTURES
from .gallery import draw_pictures as draw_pictures
from .joined import MOST as MOST
from .joined import model_of_scan as model_of_scan
from .model import Layer as Layer
from .model import Model as Model
from .model import model_of_points as model_of_points
from .plain import Plain as Plain
from .render import render as render
from .shift_field import ShiftField as ShiftField
from .shift_field import fit_shift_field as fit_shift_field
from .thinned import choose_fairly as choose_fairly
from .thinned import cluster_vertices as cluster_vertices
from .turn import TURN as TURN
from .turn import draw_turn as draw_turn
from .viewer_page import render_viewer as render_viewer
from .views import View as View
from .views import front_view as front_view
from .views import standard_views as standard_views
