"""How much light arrives, and where: laws that hold whatever draws it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate import Chessboard as Board
from murkscan.calibrate import find_board
from murkscan.optics import project
from murkscan.optics.medium import Medium
from murkscan.simulate import Body, Lamp, Light, Sensor, Simulator, load_scene
from murkscan.simulate.shapes import Chessboard, Plane, Sphere
from murkscan.simulate.textures import Checkered, Plain
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig

from ..scenes import air_rig, body, smaller, standing, wall


def test_a_mat_wall_gives_back_the_laser_s_power():
    """All of the fan falls on the wall; its radiance times area times pi over albedo is power."""
    from murkscan.types.laser import Fan, Laser

    lean = np.array([0.0, 0.25, 0.5])
    fan = Fan.spread(np.array([0.0, -0.25, 0.0]), lean, np.array([1.0, 0, 0]), math.radians(20))
    rig = Rig(air_rig().camera, (Laser.from_sheet(fan),))
    scene = standing(wall(0.5, albedo=0.3), rig=rig, light=Light(power=0.02))
    light = Simulator.of(scene).draw_light(0).lasers[0].stripe
    area = (0.5 / 554.0) ** 2  # of the wall that a pixel sees
    # The lens's blur, cut at five widths, and the Powell fan's tables leave 0.1 %.
    assert light.sum() * area * math.pi / 0.3 == pytest.approx(0.02, rel=2e-3)


def test_water_takes_light_on_both_ways():
    clear, murky = (
        Simulator.of(standing(wall(0.6), medium=medium, forward_scattering=False))
        .draw_light(0).lasers[0]
        for medium in (None, Medium(2.0))
    )  # fmt: skip
    k = 360
    point = clear.line.points[k]
    way = np.linalg.norm(point) + np.linalg.norm(point - [0, -0.25, 0])
    ratio = murky.stripe[:, k].sum() / clear.stripe[:, k].sum()
    assert ratio == pytest.approx(math.exp(-2.0 * way), rel=1e-3)


def test_glow_ends_at_the_stripe():
    scene = standing(wall(0.6), medium=Medium(1.5), forward_scattering=False)
    light = Simulator.of(scene).draw_light(0).lasers[0]
    v = round(light.line.positions[360])
    column = light.glow[:, 360]
    assert column[v - 10] > 0
    assert column[v + 10] == 0
    assert column[v] == pytest.approx(column[v - 10] / 2, rel=0.5)


def test_forward_scattering_only_adds_light_on_both_sides():
    sharp, spread = (
        Simulator.of(standing(wall(0.6), medium=Medium(3.0), forward_scattering=on))
        .draw_light(0).lasers[0]
        for on in (False, True)
    )  # fmt: skip
    v = round(sharp.line.positions[360])
    assert (spread.stripe >= sharp.stripe * (1 - 1e-5)).all()
    assert spread.stripe[v - 30, 360] > 0
    assert spread.stripe[v + 30, 360] > 0
    # Most of what is scattered is scattered ahead: it comes back, but for absorption.
    lost = math.exp(-3.0 * 0.83 * 2 * 0.6)
    assert sharp.stripe.sum() < 0.5 * spread.stripe.sum() < sharp.stripe.sum() / lost


def test_ambient_light_on_a_wall_is_lambert_s():
    scene = standing(wall(0.6, albedo=0.4), light=Light(ambient=2.0))
    ambient = Simulator.of(scene).draw_light(0).ambient
    cosine = 554 / math.hypot(554, 200)
    assert ambient[287, 360] == pytest.approx(2.0 * 0.4 / math.pi, rel=1e-4)
    assert ambient[287, 560] == pytest.approx(2.0 * 0.4 / math.pi * (0.5 + 0.5 * cosine), rel=1e-3)


def test_a_rendered_board_s_corners_lie_where_they_are():
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec([0.35, -0.25, 0.1]).as_matrix()
    board = Body(Chessboard().mesh(), Pose(turn, np.array([-0.12, -0.07, 0.5])), Checkered())
    camera = air_rig().camera
    scene = standing(
        board, rig=Rig(camera), light=Light(ambient=1.0),
        sensor=Sensor(peak_grey=200.0, full_well=1e5, read_noise=5.0),
    )  # fmt: skip
    found = find_board(Simulator.of(scene).draw_frame(0).frame.image, Board(9, 6, 0.03))
    x, y = np.meshgrid(np.arange(9) * 0.03, np.arange(6) * 0.03)
    corners = np.stack([x.ravel(), y.ravel(), np.zeros(54)], axis=1)
    true = project(camera, board.world_from_object @ corners)
    away = np.linalg.norm(found.corners[:, None] - true, axis=2).min(axis=1)
    # What sub-pixel corner finders reach on real photos is 0.1 px.
    assert np.sqrt(np.mean(away**2)) < 0.06


def test_a_second_line_is_lit_wherever_its_truth_says_so():
    glossy = body(Sphere(0.08), (0.0, 0.05, 0.5), texture=Plain(0.1), gloss=0.5)
    frame = Simulator.of(standing(glossy, wall(0.7, albedo=0.5))).draw_frame(0)
    plain = body(Sphere(0.08), (0.0, 0.05, 0.5), texture=Plain(0.1))
    without = Simulator.of(standing(plain, wall(0.7, albedo=0.5))).draw_light(0).lasers[0].stripe
    second = frame.stripe.is_reflected
    assert np.count_nonzero(second) > 50
    u, v = np.rint(frame.stripe.pixels[second]).astype(int).T
    added = frame.light.lasers[0].stripe - without
    assert (added[np.clip(v, 0, 575), u] > 0).mean() > 0.97
    np.testing.assert_allclose(frame.stripe.points[second, 2].max(), 0.7, atol=1e-6)


def test_a_mirror_gives_back_no_more_than_it_gets():
    mat = Simulator.of(standing(wall(0.6, albedo=1.0))).draw_light(0).lasers[0].stripe.sum()
    half = standing(wall(0.6, albedo=1.0, gloss=1.0))
    assert Simulator.of(half).draw_light(0).lasers[0].stripe.sum() < mat


def test_fields_show_their_own_rows():
    scene = load_scene("plane-c1.5")
    simulator = Simulator.of(scene)
    light = simulator.draw_light(7)
    frame = simulator.draw_frame(7).frame
    assert (frame.first_row, frame.row_step, frame.image.shape) == (1, 2, (288, 720))
    expected = (light.total * simulator.camera.electrons)[1::2] * scene.sensor.grey_per_electron + 4
    away = frame.image - np.clip(expected, 0, 255)
    assert abs(np.median(away)) < 1


@pytest.mark.parametrize("colour", ["rggb", "gbrg"])
def test_a_mosaic_sees_the_laser_in_its_green_pixels(colour):
    from murkscan.simulate import as_colour

    sensor = Sensor(peak_grey=150.0, colour=colour, read_noise=1.0, psf=2.0)
    image = Simulator.of(standing(wall(0.6), sensor=sensor)).draw_frame(0).frame.image
    red, green, blue = (float(as_colour(image, colour)[:, :, k].mean()) - 4 for k in range(3))
    assert green > 2 * blue > 2 * red > 0


def test_a_mosaic_sees_daylight_in_its_own_colour_and_mono_as_before():
    from murkscan.simulate import as_colour

    light = Light(ambient=50.0, colour=(0.6, 1.0, 0.8), is_on=False)
    sensor = Sensor(peak_grey=20.0, colour="rggb", read_noise=0.5)
    image = Simulator.of(standing(wall(0.6), sensor=sensor, light=light)).draw_frame(0).frame.image
    red, green, blue = (float(as_colour(image, "rggb")[:, :, k].mean()) - 4 for k in range(3))
    assert (red / green, blue / green) == pytest.approx((0.6, 0.8), abs=0.02)
    mono = [
        Simulator.of(standing(wall(0.6), light=one)).draw_light(0).ambient
        for one in (light, replace(light, colour=None))
    ]
    np.testing.assert_array_equal(*mono)


def test_deep_pictures_keep_their_depth():
    sensor = Sensor(peak_grey=3000.0, bits=12, full_well=1e5)
    image = Simulator.of(standing(wall(0.6), sensor=sensor)).draw_frame(0).frame.image
    assert image.dtype == np.uint16
    assert 2500 < image.max() < 4096


def test_two_lasers_draw_two_lines():
    first, second = air_rig(0.25).lasers[0], air_rig(-0.2).lasers[0]
    scene = standing(body(Plane(8.0, 8.0), (0, 0, 0.6)), rig=Rig(air_rig().camera, (first, second)))
    stripe = Simulator.of(scene).draw_frame(0).stripe
    assert np.bincount(stripe.laser).tolist() == [720, 720]


def test_a_lamp_lights_a_wall_by_the_inverse_square_and_lambert():
    lamp = Lamp(power=3.0, position=(0.0, 0.0, 0.0), half_angle=math.radians(60))
    scene = standing(wall(0.6, albedo=0.4), light=Light(lamp=lamp))
    seen = Simulator.of(scene).draw_light(0).ambient
    # Half as bright at 60 degrees: intensity is 3 W / pi times the cosine, as of a mat disc.
    for u in (360, 560):
        cosine = 554 / math.hypot(554, u - 359.5, 0.5)
        expected = 0.4 / math.pi * 3.0 / math.pi * cosine**4 / 0.6**2
        assert seen[287, u] == pytest.approx(expected, rel=1e-3)


def test_water_before_a_lamp_shines_and_takes_its_light():
    lamp = Lamp(power=3.0)
    clear, murky = (
        Simulator.of(standing(wall(0.6, albedo=albedo), light=Light(lamp=lamp), medium=medium))
        .draw_light(0).ambient[287, 360]
        for albedo, medium in ((0.4, None), (0.4, Medium(2.0)))
    )  # fmt: skip
    black = standing(wall(0.6, albedo=1e-9), light=Light(lamp=lamp), medium=Medium(2.0))
    veil = Simulator.of(replace(black, rig=Rig(air_rig().camera))).draw_light(0).ambient[287, 360]
    assert veil > 0
    way = 0.6 + math.hypot(0.25, 0.1, 0.6)
    assert murky - veil == pytest.approx(clear * math.exp(-2.0 * way), rel=2e-3)


def test_a_rolled_sheet_that_leaves_the_picture_is_drawn_with_its_particles():
    """Some pixels see no sheet at all: particles are not looked for there."""
    from scipy.spatial.transform import Rotation

    from murkscan.simulate import Particles
    from murkscan.types.laser import Fan, Laser

    turn = Rotation.from_euler("z", 63, degrees=True).as_matrix()
    fan = Fan.spread(
        turn @ [0, -0.25, 0], turn @ [0, 0.25, 0.5], turn @ [1.0, 0, 0], math.radians(30)
    )
    rig = Rig(air_rig().camera, (Laser(fan, "y"),))
    scene = smaller(standing(wall(0.6), rig=rig, medium=Medium(1.5), particles=Particles(30.0)))
    frame = Simulator.of(scene).draw_frame(0)
    steps = np.diff(frame.stripe.pixels, axis=0)
    assert abs(np.median(steps[:, 1])) == pytest.approx(math.tan(math.radians(63)), rel=0.15)
    assert (frame.light.lasers[0].glow > 0).any()
