"""One surface of the sheets of several passes over it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.overlap import lies_on
from ..types.mesh import Mesh
from .base import drop_unused_vertices, empty_mesh


def join_sheets(sheets: Sequence[Mesh]) -> Mesh:
    """Keep of each sheet what lies on none of those before it, so that nothing is there twice.

    Where two meet, neither is moved: the seam is open, and jagged by half a triangle.

    Args:
        sheets: Surfaces in one frame, turned to the same side; the first stays as it is. Colours
            and filled holes are not looked at.
    """
    joined = empty_mesh()
    for sheet in sheets:
        kept = sheet
        if len(joined.faces) and len(sheet.faces):
            kept = drop_unused_vertices(replace(sheet, faces=sheet.faces[~lies_on(sheet, joined)]))
        faces = kept.faces + len(joined.vertices)
        joined = Mesh(
            np.concatenate([joined.vertices, kept.vertices]), np.concatenate([joined.faces, faces])
        )
    return joined
