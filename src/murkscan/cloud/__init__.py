"""Bring all profiles of a scan into one frame, with normals, and take out what is no surface."""

from .merge import merge_profiles as merge_profiles
from .outliers import remove_outliers as remove_outliers
