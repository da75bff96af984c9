"""Geometry on arrays: no files, no images, no settings."""

from .intersect import intersect_rays_with_plane as intersect_rays_with_plane
from .plane_fit import PlaneFit as PlaneFit
from .plane_fit import fit_plane as fit_plane
