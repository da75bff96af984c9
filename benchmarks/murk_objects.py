"""Objects on which smooth guessing does not pay: anodes, plates and holes of 30 scan lines."""

import numpy as np
from scipy.spatial.transform import Rotation

from murkscan.geometry.ray_casting import RayCaster
from murkscan.simulate import Body
from murkscan.simulate.shapes import Stairs
from murkscan.simulate.shapes.solids import grid_faces, join_meshes
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


def grating(width: float, spacing: float, depths: tuple[float, ...]) -> Mesh:
    """Make layers of upright bars, one behind the other at these distances [m].

    In each layer every other bar stands a little farther away.
    """
    bars = []
    for layer, depth in enumerate(depths):
        for number, x in enumerate(np.arange(-24, 25) * spacing):
            place = [x + layer * spacing / len(depths), -1.6, depth + 0.01 * (number % 2)]
            bars.append(_moved(Stairs(width, 3.2, (width,)).mesh(), place, back=width))
    return join_meshes(bars)


def chains() -> Mesh:
    """Make chains that hang at 0.8 m, of links of 8 mm steel, 56 mm long."""
    link = _link(0.004, 0.012, 0.010)
    upright = Rotation.from_euler("y", 90, degrees=True).as_matrix()
    links = []
    for x in np.arange(-6, 7) * 0.09:
        for number, y in enumerate(np.arange(-1.5, 1.5, 0.036)):
            turn = np.eye(3) if number % 2 else upright
            links.append(Mesh(link.vertices @ turn.T + [x, y, 0.8], link.faces))
    return join_meshes(links)


def blades() -> Mesh:
    """Make propellers of six thin blades on a boss, 0.36 m across, side by side along the way."""
    blade = Stairs(0.07, 0.15, (0.003,)).mesh()
    blade = Mesh(blade.vertices * [1, 1, 0.04], blade.faces)
    pitch = Rotation.from_euler("y", 35, degrees=True).as_matrix()
    boss = _link(0.012, 0.012, 0.0)
    parts = []
    for y in np.arange(-1.4, 1.5, 0.4):
        place = np.array([0, y, 0.82])
        parts.append(Mesh(boss.vertices + place, boss.faces))
        for number in range(6):
            around = Rotation.from_euler("z", 60 * number, degrees=True).as_matrix()
            vertices = (blade.vertices @ pitch.T + [0, 0.03, 0]) @ around.T
            parts.append(Mesh(vertices + place, blade.faces))
    return join_meshes(parts)


def _link(wire: float, radius: float, straight: float) -> Mesh:
    """Make a ring of round wire in x and y, drawn out along y by a straight piece on both sides."""
    around = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    about = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    out = radius + wire * np.cos(about)
    x = np.cos(around)[:, None] * out
    y = np.sin(around)[:, None] * out + straight * np.sign(np.sin(around + 1e-9))[:, None]
    z = np.broadcast_to(wire * np.sin(about), x.shape)
    number = np.arange(x.size).reshape(x.shape)
    number = np.pad(number, ((0, 1), (0, 1)), mode="wrap")
    return Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), grid_faces(number))


def _moved(mesh: Mesh, to: list[float], *, back: float) -> Mesh:
    """Move a block, and cut it off so far behind its face: its own back is as long as its tread."""
    vertices = mesh.vertices.copy()
    vertices[:, 2] = np.minimum(vertices[:, 2], back)
    return Mesh(vertices + to, mesh.faces)
