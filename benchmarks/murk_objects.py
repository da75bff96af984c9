"""Objects on which smooth guessing does not pay: anodes, plates and holes of 30 scan lines."""

import numpy as np
from scipy.spatial.transform import Rotation

from murkscan.geometry.ray_casting import RayCaster
from murkscan.simulate import Body
from murkscan.simulate.shapes import Stairs
from murkscan.simulate.shapes.solids import grid_faces
from murkscan.simulate.textures import Plain
from murkscan.types.mesh import Mesh
from murkscan.types.pose import Pose
from murkscan.types.rays import Rays

_LINES_30 = 0.035
"""What 30 scan lines of PAL see at 0.85 m [m]."""
_CELL = np.array([0.09, 0.1])
"""One thing stands in each of these, across and along the way [m]."""
_CELLS = np.array([6, 15])
_HOLE = 0.045
"""Diameter of a hole [m]."""
_STANDING = ((_LINES_30, 0.08, 0.02), (0.06, 0.06, 0.012))
"""Width, length and height of an anode and of a plate [m]."""
_BURIED = 0.01
"""How deep they stand in the surface, which is not flat [m]."""
_ALBEDO = 0.09


def fit_things(body: Body, seed: int) -> list[Body]:
    """Stand anodes and plates on a body that faces the camera, and cut holes into it.

    In each cell of a grid there is an anode, a plate or nothing, with the same chance, or, twice as
    likely, a hole.
    """
    random = np.random.default_rng([seed, 5])
    caster = RayCaster(Mesh(body.world_from_object @ body.mesh.vertices, body.mesh.faces))
    middle = body.world_from_object.translation[:2]
    things, holes = [], []
    for cell in np.ndindex(*_CELLS):
        place = middle + (np.array(cell) - (_CELLS - 1) / 2) * _CELL
        place = place + random.uniform(-0.2, 0.2, 2) * _CELL
        kind = random.integers(0, 5)
        hit = _look_up(caster, place)
        if hit is None or kind == 4:
            continue
        if kind >= 2:
            holes.append(hit[0])
        else:
            things.append(_stand(*hit, _STANDING[kind]))
    return [Body(perforate(body, holes), body.world_from_object, body.texture, body.gloss), *things]


def perforate(body: Body, holes: list[np.ndarray]) -> Mesh:
    """Leave out the triangles whose middle lies in a round hole about one of these points."""
    corners = (body.world_from_object @ body.mesh.vertices)[body.mesh.faces]
    middles = corners.mean(axis=1)
    kept = np.ones(len(middles), bool)
    for hole in holes:
        kept &= np.linalg.norm(middles - hole, axis=1) > _HOLE / 2
    return Mesh(body.mesh.vertices, body.mesh.faces[kept])


def plate(width: float, height: float, *, step: float = 0.004) -> Mesh:
    """Make a flat rectangle of small triangles in z = 0 that faces the camera [m]."""
    x = np.arange(-width / 2, width / 2 + step, step)
    y = np.arange(-height / 2, height / 2 + step, step)
    grid = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1)
    faces = grid_faces(np.arange(len(x) * len(y)).reshape(len(y), len(x)))
    return Mesh(grid.reshape(-1, 3), faces[:, ::-1])


def _look_up(caster: RayCaster, place: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Give the point and the normal that the camera sees at x and y, if any."""
    start = np.array([[*place, 0.0]])
    hits = caster.first_hits(Rays(start, np.array([[0.0, 0.0, 1.0]])))
    if not hits.is_hit[0]:
        return None
    normal = caster.normals[hits.face[0]]
    return start[0] + [0, 0, hits.range[0]], normal if normal[2] < 0 else -normal


def _stand(point: np.ndarray, normal: np.ndarray, size: tuple[float, float, float]) -> Body:
    """Stand a block on the surface; its top faces along the normal."""
    width, length, height = size
    turn = Rotation.align_vectors([normal], [[0.0, 0.0, -1.0]])[0].as_matrix()
    origin = point - normal * _BURIED + turn @ np.array([0.0, -length / 2, 0.0])
    block = Stairs(width, length, (height + _BURIED,)).mesh()
    return Body(block, Pose(turn, origin), Plain(_ALBEDO))
