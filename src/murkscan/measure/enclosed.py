"""The volume inside a closed surface."""

import math

import numpy as np

from ..errors import InputError
from ..geometry.closest import open_sides
from ..types.measurement import Measurement
from ..types.mesh import Mesh
from ..types.quantity import Quantity
from .sample import Sample
from .surface import area_vectors, rig_modes


def measure_enclosed(mesh: Mesh, sample: Sample) -> Measurement:
    """Give the volume that a closed surface encloses.

    Args:
        mesh: The surface.
        sample: The points it was made of.

    Raises:
        InputError: The surface is not closed.
    """
    rim = int(open_sides(mesh.faces).sum())
    if rim:
        raise InputError(
            f"The surface is open: {rim} of its triangles' {3 * len(mesh.faces)} sides have no "
            "neighbour, so it encloses no volume. Give a plane to measure the volume between the "
            "two, with --point-m and --normal, or --base-near-m and --base-within-mm."
        )
    vectors, middle = area_vectors(mesh), mesh.vertices.mean(axis=0)
    centres = mesh.vertices[mesh.faces].mean(axis=1) - middle
    volume = abs(float(np.einsum("ij,ij->", vectors, centres)) / 3)
    noise = sample.usual_noise
    own = noise * math.sqrt(float((vectors**2).sum()))
    modes = rig_modes(sample)
    common = None
    if modes is not None:
        common = volume * float(np.linalg.norm(np.trace(modes[:, :3], axis1=1, axis2=2)))
    found = Quantity("enclosed_volume", volume, "m3", own, common)
    return Measurement("volume", (found,), {"triangles": len(mesh.faces)})
