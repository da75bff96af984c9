"""Bring all profiles of a scan into one frame, with normals, and take out what is no surface."""

from .base import AbstractOutlierRule as AbstractOutlierRule
from .base import SeenCloud as SeenCloud
from .doubtful import Doubtful as Doubtful
from .merge import merge_profiles as merge_profiles
from .outliers import OUTLIER_RULES as OUTLIER_RULES
from .outliers import find_outliers as find_outliers
from .outliers import remove_outliers as remove_outliers
from .outside import Outside as Outside
from .seen_through import SeenThrough as SeenThrough
from .sparse import Sparse as Sparse
from .thinning import thin_cloud as thin_cloud
from .thinning import thin_clouds as thin_clouds
