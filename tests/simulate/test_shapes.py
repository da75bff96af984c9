"""Objects to scan: their surfaces are closed, face outwards and lie where their sizes say."""

import math
from functools import cache

import numpy as np
import pytest
import trimesh

from murkscan.errors import InputError
from murkscan.simulate.shapes import (
    AbstractShape,
    Chessboard,
    Cylinder,
    Hull,
    Plane,
    Sphere,
    Stairs,
)
from murkscan.simulate.shapes.hull_form import HullForm

SOLIDS = [
    Sphere(0.1),
    Cylinder(0.05, 0.3),
    Cylinder(0.01, 5.0),
    Stairs(0.3, 0.06, (0.0, 0.01, 0.03, 0.03, 0.005)),
    Stairs(heights=(0.02,)),
    Hull(),
    Hull(1.6, 0.5, 0.26),
]
BOARDS = [Plane(0.4, 0.3), Chessboard(9, 6, 0.03)]


@cache
def _solid(shape: AbstractShape) -> trimesh.Trimesh:
    mesh = shape.mesh()
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


@cache
def _parts(shape: AbstractShape) -> np.ndarray:
    """The number of each triangle's closed part; 0 is the largest."""
    solid = _solid(shape)
    adjacency, count = solid.face_adjacency, len(solid.faces)
    labels = trimesh.graph.connected_component_labels(adjacency, node_count=count)
    return np.argsort(np.argsort(-np.bincount(labels), kind="stable"))[labels]


def _corners(shape: AbstractShape) -> np.ndarray:
    return np.asarray(_solid(shape).triangles)


@pytest.mark.parametrize("shape", SOLIDS, ids=repr)
def test_a_solid_is_closed_and_faces_outwards_in_every_part(shape):
    solid = _solid(shape)
    assert solid.is_watertight
    assert solid.is_winding_consistent
    a, b, c = np.moveaxis(_corners(shape), 1, 0)
    volumes = np.bincount(_parts(shape), np.einsum("ij,ij->i", a, np.cross(b, c)) / 6)
    assert volumes.min() > 0
    assert len(volumes) == (13 if isinstance(shape, Hull) else 1)


@pytest.mark.parametrize("shape", BOARDS, ids=repr)
def test_a_board_lies_in_its_plane_and_faces_the_camera(shape):
    a, b, c = np.moveaxis(_corners(shape), 1, 0)
    assert np.all(a[:, 2] == 0)
    assert np.all(np.cross(b - a, c - a)[:, 2] < 0)


@pytest.mark.parametrize("shape", SOLIDS + BOARDS, ids=repr)
def test_every_triangle_has_an_area_and_every_vertex_a_triangle(shape):
    solid = _solid(shape)
    assert solid.area_faces.min() > 1e-12 * solid.area
    assert len(np.unique(solid.faces)) == len(solid.vertices)


@pytest.mark.parametrize("shape", [Sphere(0.1), Stairs(), Hull()], ids=repr)
def test_nearly_all_triangles_are_well_shaped(shape):
    angles = np.degrees(trimesh.triangles.angles(_corners(shape)).min(axis=1))
    # Narrow ones are left where the hull runs out at stem and stern, and on its deck.
    assert np.mean(angles > 15) > 0.9


@pytest.mark.parametrize("shape", SOLIDS + BOARDS, ids=repr)
def test_a_shape_has_a_bounded_number_of_triangles_and_is_the_same_each_time(shape):
    first, second = shape.mesh(), shape.mesh()
    assert len(first.faces) <= 500_000
    assert np.array_equal(first.vertices, second.vertices)
    assert np.array_equal(first.faces, second.faces)


def test_a_sphere_is_true_to_two_micrometres():
    corners = _corners(Sphere(0.1))
    np.testing.assert_allclose(np.linalg.norm(corners, axis=-1), 0.1, atol=1e-12)
    # A flat triangle is deepest near its middle.
    depth = 0.1 - np.linalg.norm(corners.mean(axis=1), axis=-1)
    assert 0 < depth.max() < 2e-6


def test_a_cylinder_is_true_to_a_micrometre():
    vertices = Cylinder(0.1, 0.4).mesh().vertices
    x, y, z = vertices.T
    on_side = np.hypot(x, z) > 0.05
    np.testing.assert_allclose(np.hypot(x, z)[on_side], 0.1, atol=1e-12)
    np.testing.assert_allclose(vertices[~on_side], [[0, -0.2, 0], [0, 0.2, 0]], atol=1e-12)
    around = np.sort(np.arctan2(z, x)[on_side & (y > 0.2 - 1e-9)])
    assert 0.1 * (1 - math.cos(np.diff(around).max() / 2)) < 1e-6


def test_stairs_have_their_heights_and_upright_risers():
    heights = (0.0, 0.01, 0.03, 0.03, 0.005)
    corners = _corners(Stairs(0.3, 0.06, heights))
    middle, (a, b, c) = corners.mean(axis=1), np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    # Blocks along the axes: each triangle looks exactly along one.
    np.testing.assert_allclose(np.abs(normal).max(axis=1), 1, atol=1e-12)
    facing = normal[:, 2] < -0.5
    expected = -np.array(heights)[(middle[facing, 1] // 0.06).astype(int)]
    np.testing.assert_allclose(middle[facing, 2], expected, atol=1e-12)
    risers = np.unique(np.round(middle[(normal[:, 1] < -0.5)][:, 1], 9))
    np.testing.assert_allclose(risers, [0.0, 0.06, 0.12], atol=1e-9)


def test_stairs_hold_the_volume_of_their_blocks():
    solid = _solid(Stairs(0.3, 0.06, (0.0, 0.01, 0.03)))
    assert solid.volume == pytest.approx(0.3 * 0.06 * (3 * 0.06 + 0.04), rel=1e-9)


@pytest.mark.parametrize(("columns", "rows"), [(9, 6), (5, 5)])
def test_a_chessboard_reaches_two_squares_beyond_its_inner_corners(columns, rows):
    vertices = Chessboard(columns, rows, 0.02).mesh().vertices
    np.testing.assert_allclose(vertices.min(axis=0), [-0.04, -0.04, 0], atol=1e-12)
    far = [(columns + 1) * 0.02, (rows + 1) * 0.02, 0]
    np.testing.assert_allclose(vertices.max(axis=0), far, atol=1e-12)


def _shell(hull: Hull) -> np.ndarray:
    """The vertices of the bare hull without those of the deck."""
    solid = _solid(hull)
    vertices = solid.vertices[np.unique(solid.faces[_parts(hull) == 0])]
    return np.asarray(vertices[vertices[:, 2] < 0])


def test_the_shell_is_wigleys_parabola_but_for_the_place_of_the_through_hull():
    shell = _shell(Hull(1.0, 0.3, 0.12))
    form = HullForm(1.0, 0.3, 0.12)
    station = shell[:, 1] / 0.5
    share = -shell[:, 2] / form.keel_depth(station)
    off = np.abs(shell[:, 0]) - form.half_breadth(station) * (1 - share**2)
    pushed_in = np.abs(off) > 1e-12
    # A disc of 20 mm among a shell of some 0.35 m²: 0.4 % of the vertices, all in one place.
    assert 0 < pushed_in.mean() < 0.01
    assert np.all(shell[pushed_in, 0] > -0.01)
    assert np.ptp(shell[pushed_in], axis=0).max() < 0.05


def test_the_forms_normals_are_square_to_the_shell_and_point_outwards():
    form = HullForm(0.9, 0.28, 0.11)
    station, share = (g.ravel() for g in np.mgrid[-0.9:0.95:0.1, 0.05:0.99:0.1])
    points, normals = form.points(station, share), form.normals(station, share)
    step = 1e-6
    for moved in (form.points(station + step, share), form.points(station, share + step)):
        along = (moved - points) / np.linalg.norm(moved - points, axis=1, keepdims=True)
        # The chord of a step of 1e-6 leaves its tangent by a few 1e-6.
        np.testing.assert_allclose(np.einsum("ij,ij->i", along, normals), 0, atol=1e-5)
    assert np.all(normals[:, 0] > 0)


def test_the_hull_has_keels_a_propeller_and_the_size_it_was_given():
    low, high = _solid(Hull(0.9, 0.28, 0.11)).bounds
    assert high == pytest.approx([0.14, 0.45, 0.0], abs=1e-9)
    assert low[0] == pytest.approx(-0.14, abs=1e-9)
    assert -0.125 < low[2] < -0.118, "the bar keel stands out of the bottom by about a centimetre"
    assert -0.53 < low[1] < -0.49, "the propeller stands behind the stern"


def test_all_but_the_through_hull_and_the_blades_is_the_same_on_both_sides():
    corners, parts = _corners(Hull()), _parts(Hull())
    # By size: the body, the bar keel, the boss with its shaft, two bilge keels.
    boxes = [(corners[parts == i].min((0, 1)), corners[parts == i].max((0, 1))) for i in range(5)]
    body, keel, boss, one, other = boxes
    for low, high in (body, keel, boss):
        # The boss has an odd number of facets, 1.2 mm wide: their arrow is 1.2² / (8 · 10.5) mm.
        assert low[0] == pytest.approx(-high[0], abs=1.8e-5)
    assert np.allclose(one[0][1:], other[0][1:], atol=1e-12)
    assert sorted([one[0][0], other[0][0]]) == pytest.approx(sorted([-one[1][0], -other[1][0]]))


@pytest.mark.parametrize("side", [-1, 1])
def test_a_ray_from_the_camera_meets_each_bilge_keel_before_the_shell(side):
    form, hull = HullForm(0.9, 0.28, 0.11), _solid(Hull())
    root = form.points(np.zeros(1), np.array([0.68]))[0]
    outwards = form.normals(np.zeros(1), np.array([0.68]))[0]
    tip = root + 0.0125 * outwards
    origin = np.array([[side * tip[0], 0.0, -1.0]])
    met, _, _ = hull.ray.intersects_location(origin, np.array([[0.0, 0.0, 1.0]]))
    # The keel is 13 mm high: its edge is met within its width of 3 mm.
    assert met[:, 2].min() == pytest.approx(tip[2], abs=0.003)
    assert met[:, 2].min() < root[2] - 0.008


def test_the_through_hull_is_a_recess_with_an_edge_before_the_shell():
    form, hull = HullForm(0.9, 0.28, 0.11), _solid(Hull())
    station, share = np.array([0.30]), np.array([0.85])
    place, outwards = form.points(station, share)[0], form.normals(station, share)[0]
    across = np.cross([0.0, 1.0, 0.0], outwards) / np.linalg.norm(np.cross([0, 1, 0], outwards))
    depths = []
    for offset in (0.004, 0.020, 0.030):
        origin = place + offset * across + 0.1 * outwards
        met, _, _ = hull.ray.intersects_location(origin[None], -outwards[None])
        depths.append(np.max((met - place) @ outwards))
    between_bars, flange, beside = depths
    assert between_bars == pytest.approx(-0.012, abs=1e-6)
    assert flange == pytest.approx(0.005, abs=1e-6)
    assert abs(beside) < 0.002


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Plane(0.0, 1.0), "width"),
        (lambda: Plane(1.0, math.nan), "height"),
        (lambda: Sphere(-0.1), "radius"),
        (lambda: Cylinder(0.1, math.inf), "length"),
        (lambda: Stairs(tread=0.0), "tread"),
        (lambda: Stairs(heights=()), "heights"),
        (lambda: Stairs(heights=tuple(k * 1e-6 for k in range(20_000))), "20000 treads"),
        (lambda: Stairs(tread=1e-6, heights=(0.0, 1e6)), "fewer treads, or longer ones"),
        (lambda: Stairs(heights=(0.01, -0.01)), "heights"),
        (lambda: Chessboard(1, 6, 0.03), "columns"),
        (lambda: Chessboard(9, 6, 0.0), "square"),
        (lambda: Hull(draft=0.0), "draft"),
        (lambda: Hull(length=9.0), "length = 9"),
        (lambda: Hull(beam=0.9), "beam = 0.9"),
    ],
)
def test_what_is_no_object_is_refused_by_the_name_of_its_size(make, word):
    with pytest.raises(InputError, match=word):
        make()
