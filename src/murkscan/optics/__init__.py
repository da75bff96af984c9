"""How light travels: no files, no images, no settings.

Where light crosses a window, what lies outside is given as its refractive `index`: ask
`refractive_index(rig.water, rig.wavelength)` once and hand it on. Without windows it may be left
out, and everything is the pinhole and the plane.
"""

from .rig_parameters import parameters_of as parameters_of
from .rig_parameters import perturb_rig as perturb_rig
from .rig_parameters import tilt_directions as tilt_directions
from .sheet import as_fan as as_fan
from .sheet import distance_to_sheet as distance_to_sheet
from .sheet import equivalent_plane as equivalent_plane
from .sheet import intersect_rays_with_sheet as intersect_rays_with_sheet
from .sheet import light_across as light_across
from .sheet import locate_on_fan as locate_on_fan
from .sheet import trace_fan as trace_fan
from .view import back_project as back_project
from .view import normalise as normalise
from .view import project as project
from .water import refractive_index as refractive_index
