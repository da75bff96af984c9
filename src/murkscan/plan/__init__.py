"""What a rig will see in a water, before it is built or lowered."""

from .conditions import Conditions as Conditions
from .conditions import attenuation_from_secchi as attenuation_from_secchi
from .conditions import attenuation_from_visibility as attenuation_from_visibility
from .conditions import visibility_from_attenuation as visibility_from_attenuation
from .forecast import VISIBLE as VISIBLE
from .forecast import Forecast as Forecast
from .forecast import forecast as forecast
from .placement import Placement as Placement
from .placement import as_if as as_if
from .placement import judge_present as judge_present
from .placement import place_laser as place_laser
from .placement import present_place as present_place
