"""Find the stripe in the picture.

Every extractor is a frozen dataclass: its fields are its settings, `learn` and `extract` its verbs.
"""

from .base import AbstractExtractor as AbstractExtractor
from .checked import check_stripes as check_stripes
from .checked import require_extractor as require_extractor
from .gaussian_fit import GaussianFit as GaussianFit
from .gray_gravity import GrayGravity as GrayGravity
from .murk import Murk as Murk
from .noise import learn_noise as learn_noise
from .overlay import draw_stripe as draw_stripe
from .steger import Steger as Steger
from .threshold_skeleton import ThresholdSkeleton as ThresholdSkeleton
