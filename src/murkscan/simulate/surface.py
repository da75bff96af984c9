"""What stands before the rig: shapes with their paint, placed in the world."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import InputError
from ..geometry.ray_casting import RayCaster
from ..types.arrays import Indices, Points, Scalars
from ..types.mesh import Mesh
from ..types.pose import Pose
from .textures import AbstractTexture, Plain


@dataclass(frozen=True, eq=False)
class Body:
    """One object of a scene."""

    mesh: Mesh
    """Its surface, in its own frame [m]."""
    world_from_object: Pose
    texture: AbstractTexture = field(default_factory=Plain)
    """Albedo by place, in the object's frame."""
    gloss: float = 0.0
    """Share of the light that is mirrored, 0 (mat) to 1."""
    translucency: float = 0.0
    """How far light goes on under the surface before it comes out, across the sheet [m], 1σ: in
    plastic, marble and sponges, which turn a thin line into a broad band.

    References:
        Jensen, Marschner, Levoy and Hanrahan, A practical model for subsurface light transport,
        SIGGRAPH 2001.
    """

    def __post_init__(self) -> None:
        """Refuse an object without a surface."""
        if len(self.mesh.faces) == 0:
            raise InputError("object.mesh has no faces; give a mesh of triangles.")
        if not np.isfinite(self.mesh.vertices).all():
            raise InputError("object.mesh has vertices that are not finite; mend the mesh.")
        if not 0 <= self.gloss <= 1:
            raise InputError(f"surface.gloss must lie between 0 and 1, got {self.gloss:g}.")
        if not 0 <= self.translucency <= 0.1:
            raise InputError(
                f"surface.translucency_mm must lie between 0 and 100, got "
                f"{1e3 * self.translucency:g}."
            )


@dataclass(frozen=True, eq=False)
class Surroundings:
    """All objects of a scene as one mesh in the world frame, and whose each triangle is."""

    bodies: tuple[Body, ...]

    @cached_property
    def mesh(self) -> Mesh:
        """The triangles of all objects, in the world frame [m]."""
        if not self.bodies:
            return Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
        starts = np.cumsum([0, *(len(body.mesh.vertices) for body in self.bodies)])
        return Mesh(
            np.concatenate([body.world_from_object @ body.mesh.vertices for body in self.bodies]),
            np.concatenate([b.mesh.faces + s for b, s in zip(self.bodies, starts, strict=False)]),
        )

    @cached_property
    def caster(self) -> RayCaster:
        """The same, ready for rays of the world frame."""
        return RayCaster(self.mesh)

    def albedo(self, points: Points, face: Indices) -> Scalars:
        """Give the albedo of points [m, world frame] on these triangles."""
        values, owner = np.zeros(len(points)), self._owner[face]
        for number, body in enumerate(self.bodies):
            mine = np.flatnonzero(owner == number)
            values[mine] = body.texture.albedo(body.world_from_object.inverse() @ points[mine])
        return values

    def gloss(self, face: Indices) -> Scalars:
        """Give the share of light that these triangles mirror."""
        return np.array([body.gloss for body in self.bodies])[self._owner[face]]

    def translucency(self, face: Indices) -> Scalars:
        """Give how far light goes on under these triangles [m], 1σ."""
        return np.array([body.translucency for body in self.bodies])[self._owner[face]]

    @cached_property
    def _owner(self) -> Indices:
        counts = np.array([len(body.mesh.faces) for body in self.bodies], int)
        return np.repeat(np.arange(len(self.bodies)), counts)
