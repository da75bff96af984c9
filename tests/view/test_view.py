"""Pictures by their pixels: where things are, how bright, in which colour."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError, NotEnoughData
from murkscan.mesh import GridMesh
from murkscan.types.mesh import Mesh
from murkscan.types.trajectory import Trajectory
from murkscan.view import Depth, draw_pictures, render, standard_views
from murkscan.view.values import SignedValues
from murkscan.view.writing import round_down

from ..scans import scan_cloud, sphere

SIZE = (480, 360)
VIEWS = {view.name: view for view in standard_views()}


def box(width, height, depth, *, at=(0.0, 0.0, 1.0)):
    """A block whose triangles face outwards [m]."""
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float) - 0.5
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([[a, b, c] for a, b, c, _ in sides] + [[a, c, d] for a, _, c, d in sides])
    return Mesh(corner * [width, height, depth] + at, faces)


def object_pixels(picture):
    """What is neither background nor, in the middle of the picture, writing."""
    inner = np.zeros(picture.shape[:2], bool)
    h, w = inner.shape
    inner[round(0.075 * h) : round(0.852 * h), : round(0.97 * w)] = True
    return (picture.max(axis=2) < 245) & inner


def extent(mask):
    rows, columns = np.nonzero(mask)
    return np.ptp(columns) + 1, np.ptp(rows) + 1


@pytest.mark.parametrize(
    ("name", "across", "up"),
    [("front", 4, 2), ("back", 4, 2), ("left", 1, 2), ("right", 1, 2), ("top", 4, 1)],
)
def test_a_box_has_its_proportions_in_every_view(name, across, up):
    picture = render(box(0.4, 0.2, 0.1), VIEWS[name], size=SIZE)
    width, height = extent(object_pixels(picture))
    # A pixel more or less on either side of an extent of 100 pixels or more.
    assert width / height == pytest.approx(across / up, rel=0.03)


@pytest.mark.parametrize("name", VIEWS)
def test_the_model_fills_the_picture_and_is_not_cut_off(name):
    mask = object_pixels(render(box(0.3, 0.3, 0.3), VIEWS[name], size=SIZE))
    width, height = extent(mask)
    assert max(width / SIZE[0], height / SIZE[1]) > 0.7
    assert not mask[[0, -1]].any()
    assert not mask[:, [0, -1]].any()


def test_a_part_drawn_like_the_whole_lies_where_it_lies_there():
    whole, part = box(0.4, 0.2, 0.1), box(0.1, 0.05, 0.1, at=(0.1, 0.0, 1.0))
    columns = [
        np.nonzero(object_pixels(render(one, VIEWS["front"], like=whole)).any(axis=0))[0]
        for one in (whole, part)
    ]
    scale = np.ptp(columns[0]) / 0.4
    assert np.ptp(columns[1]) == pytest.approx(0.1 * scale, abs=2)
    aside = np.mean(columns[1]) - np.mean(columns[0])
    assert aside == pytest.approx(0.1 * scale, abs=2)
    beyond = box(0.4, 0.2, 0.1, at=(9.0, 0.0, 1.0))
    assert not object_pixels(render(beyond, VIEWS["front"], like=whole)).any()


def test_the_front_is_as_the_camera_sees_it():
    """A small box at the lower right of a big one is there in the picture too."""
    big, small = box(0.4, 0.3, 0.1), box(0.05, 0.05, 0.05, at=(0.3, 0.2, 1.0))
    both = Mesh(
        np.concatenate([big.vertices, small.vertices]), np.concatenate([big.faces, small.faces + 8])
    )
    mask = object_pixels(render(both, VIEWS["front"], size=SIZE))
    rows, columns = np.nonzero(mask)
    assert mask[rows.max(), columns.max()]
    assert not mask[rows.min(), columns.max()]


def test_front_follows_the_cameras_attitude_in_the_world():
    # A camera that looks down in a world whose z is up: its x is east, its y is south.
    down = Rotation.from_matrix(np.diag([1.0, -1.0, -1.0])).as_quat(scalar_first=True)
    trajectory = Trajectory(np.array([0.0, 1.0]), np.zeros((2, 3)), np.tile(down, (2, 1)))
    front = next(view for view in standard_views(trajectory) if view.name == "front")
    np.testing.assert_allclose(front.view_from_world, np.diag([1.0, -1.0, -1.0]), atol=1e-12)


def test_depth_is_told_from_where_the_camera_was_wherever_the_world_begins():
    """A camera that looks along the world's x from 98 m, at points 1 to 2 m before it."""
    times = np.arange(5) / 25
    positions = np.stack([98 + 0 * times, times, 0 * times], axis=1)
    attitude = Rotation.from_euler("y", 90, degrees=True).as_quat(scalar_first=True)
    trajectory = Trajectory(times, positions, np.tile(attitude, (5, 1)))
    front = next(view for view in standard_views(trajectory) if view.name == "front")
    x, y, z = (float(part) for part in front.view_from_world[2])
    points = np.array([99.0, 0, 0]) + np.linspace(0, 1, 1001)[:, None] * [1.0, 0, 0]
    legend = Depth((x, y, z), front.start).legend(points)
    assert (legend.low, legend.high) == pytest.approx((1005, 1995), abs=1)


@pytest.mark.parametrize("name", VIEWS)
def test_every_view_is_a_rotation(name):
    matrix = VIEWS[name].view_from_world
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix) == pytest.approx(1)


def test_light_comes_from_the_upper_left():
    picture = render(GridMesh().mesh(scan_cloud(sphere)), VIEWS["front"], size=SIZE)
    grey = picture.mean(axis=2)
    rows, columns = np.nonzero(object_pixels(picture))
    v, u = round(rows.mean()), round(columns.mean())
    reach = round(np.ptp(rows) * 0.2)
    assert grey[v - reach, u - reach] > grey[v, u] - 5 > grey[v + reach, u + reach] + 20


def test_the_same_mesh_gives_the_same_picture():
    mesh = GridMesh().mesh(scan_cloud(sphere, spacing=2e-3, noise=2e-4))
    first, second = (render(mesh, VIEWS["isometric"], colours=Depth(), size=SIZE) for _ in "ab")
    np.testing.assert_array_equal(first, second)


def test_nearer_is_brighter_and_farther_is_bluer():
    slope = Mesh(
        np.array([[-0.2, -0.1, 1.0], [0.2, -0.1, 1.2], [0.2, 0.1, 1.2], [-0.2, 0.1, 1.0]]),
        np.array([[0, 2, 1], [0, 3, 2]]),
    )
    picture = render(slope, VIEWS["front"], colours=Depth(), size=SIZE).astype(int)
    rows, columns = np.nonzero(object_pixels(picture[:, : round(0.8 * SIZE[0])]))
    row = picture[round(rows.mean())]
    near, far = row[columns.min() + 5], row[columns.max() - 5]
    assert near.sum() > far.sum()
    assert far[2] > far[1]
    assert near[1] > near[2]


def test_a_deviation_towards_the_camera_is_red_and_red_is_on_top_of_the_bar():
    mesh = box(0.4, 0.2, 0.1)
    x = np.linspace(-0.2, 0.2, 81)
    at = np.stack([np.tile(x, 41), np.repeat(x[20:61], 81), np.full(3321, 0.95)], axis=1)
    values = SignedValues(at, np.where(at[:, 0] > 0, 1e-3, -1e-3))
    picture = render(mesh, VIEWS["front"], colours=values, size=SIZE).astype(int)
    redness = picture[..., 0] - picture[..., 2]
    model = redness[:, : round(0.8 * SIZE[0])]
    left, right = np.array_split(model, 2, axis=1)
    assert left.min() < -50 < 50 < right.max()
    # Where the colour bar stands; its ends are the strongest colours.
    bar = redness[round(0.2 * SIZE[1]) : round(0.7 * SIZE[1]), round(0.886 * SIZE[0])]
    assert bar[0] > 50 > -50 > bar[-1]


def test_where_no_value_is_near_the_surface_is_grey():
    at = np.stack([np.linspace(0, 0.1, 101), np.zeros(101), np.zeros(101)], axis=1)
    values = SignedValues(at, np.full(101, 1e-3))
    places = np.array([[0.05, 0.001, 0.0], [0.05, 0.5, 0.0]])
    near, far = values.paint(places, np.ones(2, bool), values.legend(at))
    assert near[0] > near[2] + 0.2
    assert far[0] == far[1] == far[2]


def test_the_back_of_a_surface_has_another_colour():
    mesh = GridMesh().mesh(scan_cloud(sphere))
    front, back = (render(mesh, VIEWS[name], size=SIZE).astype(int) for name in ("front", "back"))
    for picture, is_blue in ((front, False), (back, True)):
        colour = picture[object_pixels(picture)].mean(axis=0)
        assert (colour[2] > colour[0]) == is_blue


def test_the_scale_bar_is_as_long_as_it_says():
    # 400 mm over 92 % of 480 px: 1.104 px/mm, so a quarter of the width is 108.7 mm: 100 mm.
    picture = render(box(0.4, 0.1, 0.1), VIEWS["front"], size=SIZE)
    dark = picture.max(axis=2)[round(0.955 * SIZE[1])] < 128
    columns = np.flatnonzero(dark[: SIZE[0] // 2])
    assert np.ptp(columns) + 1 == pytest.approx(110.4, abs=2)


@pytest.mark.parametrize(
    ("value", "bar"), [(0.0999, 0.05), (0.1, 0.1), (7.0, 5.0), (0.0023, 0.002)]
)
def test_bars_have_round_lengths(value, bar):
    assert round_down(value) == bar


def test_a_cloud_without_a_mesh_is_drawn_as_discs():
    cloud = scan_cloud(sphere, spacing=2e-3)
    mask = object_pixels(render(cloud, VIEWS["front"], size=SIZE))
    assert mask.sum() > 5000


def test_every_scan_gets_nine_pictures():
    pictures = dict(draw_pictures(box(0.3, 0.2, 0.1), size=(160, 120)))
    assert list(pictures) == [
        *("isometric", "isometric-depth", "front", "front-depth"),
        *("back", "left", "right", "top", "bottom"),
    ]
    assert all(picture.shape == (120, 160, 3) for picture in pictures.values())


@pytest.mark.parametrize("offset", [0.0, 5e6])
def test_a_position_at_sea_does_not_coarsen_the_picture(offset):
    mesh = GridMesh().mesh(scan_cloud(sphere, spacing=2e-3))
    moved = Mesh(mesh.vertices + np.array([offset, -offset, 0.0]), mesh.faces)
    near, far = (object_pixels(render(m, VIEWS["front"], size=SIZE)) for m in (mesh, moved))
    # 5000 km leave a double 1e-9 m; samples on an edge may fall on its other side.
    assert np.mean(near != far) < 1e-3


def test_nothing_to_draw_is_said():
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    with pytest.raises(NotEnoughData, match="nothing to draw"):
        render(empty, VIEWS["front"])


def test_points_that_are_not_finite_are_refused():
    mesh = box(0.1, 0.1, 0.1)
    mesh.vertices[0, 0] = np.nan
    with pytest.raises(InputError, match="1 of 8 points"):
        render(mesh, VIEWS["front"])


def test_a_stamp_is_no_picture():
    with pytest.raises(InputError, match="64 x 64"):
        render(box(0.1, 0.1, 0.1), VIEWS["front"], size=(32, 32))
