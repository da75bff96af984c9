"""What real cameras, windows and lasers have, as changes to a scene of the package."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from murk_objects import blades, chains, fit_things, grating, plate
from scipy.spatial.transform import Rotation

from murkscan.simulate import Body, Lamp, Recorder, Scene, Simulator, load_scene
from murkscan.simulate.particles import Particles
from murkscan.simulate.textures import Plain
from murkscan.simulate.textures.growth import Growth
from murkscan.types.laser import Laser
from murkscan.types.mesh import Mesh
from murkscan.types.pose import Pose

Change = Callable[[Scene], Scene]

_TEXT = ("HDG 273  PITCH -2", "DPT 12.4 m", "{time}", "CAM 1  LAMP 40 %")
_WALL = 0.85
"""Distance of the wall on which the stripe stands still [m]."""
HULL_ENDS = 1.3
"""What is farther than this is the wall [m]."""
_LIT = 90.0
"""Grey level of a background in the lamp's light."""
_PIXEL = 0.00115
"""What a pixel of PAL sees of the hull, across the sheet [m]."""
_PLASTIC = 0.004
"""How far light goes on under white plastic [m]."""
_HOPELESS = 6.0
"""Beam attenuation at which the camera's exposure is at its end [1/m]."""


def with_things(scene: Scene) -> Scene:
    """Give the hull its anodes, plates and holes."""
    hull, *others = scene.bodies
    return replace(scene, bodies=(*fit_things(_repaint(hull, scene.seed), scene.seed), *others))


def before_a_wall(scene: Scene) -> Scene:
    """Put a flat wall with holes in the hull's place: the stripe stands still on it."""
    texture = Growth(0.03, 0.11, seed=scene.seed)
    wall = Body(plate(1.2, 2.4), Pose(np.eye(3), np.array([0.0, 0.95, _WALL])), texture)
    wall = replace(wall, mesh=fit_things(wall, scene.seed)[0].mesh)
    return replace(scene, bodies=(wall,))


def in_an_empty_sea(scene: Scene) -> Scene:
    """Take all objects away; the exposure stays."""
    return replace(_as_exposed(scene), bodies=())


def in_hopeless_murk(scene: Scene) -> Scene:
    """Keep the exposure of the murkiest water in which the lamp still reaches the hull."""
    brightest = replace(load_scene(f"hull-c{_HOPELESS:g}"), seed=scene.seed)
    return replace(scene, sensor=_as_exposed(brightest).sensor)


def with_white_things(scene: Scene) -> Scene:
    """Make anodes and plates of white plastic: bands of 18 px beside a line of 2 px."""
    hull, *others = scene.bodies
    cut, *things = fit_things(_repaint(hull, scene.seed), scene.seed)
    white = [replace(t, texture=Plain(0.8), translucency=_PLASTIC, gloss=0.1) for t in things]
    return replace(scene, bodies=(cut, *white, *others))


def before_a_grating(scene: Scene) -> Scene:
    """Put three layers of upright bars before a wall: some ten scan lines each."""
    return _among(scene, grating(0.012, 0.06, (0.65, 0.8, 0.95)), _wall_behind(1.1))


def before_pieces(scene: Scene) -> Scene:
    """Put thin bars before nothing: pieces of 5 to 10 scan lines."""
    return _among(scene, grating(0.008, 0.03, (0.8,)))


def before_chains(scene: Scene) -> Scene:
    """Hang chains before a wall."""
    return _among(scene, chains(), _wall_behind(1.1))


def before_blades(scene: Scene) -> Scene:
    """Put propellers of six blades before a wall."""
    return _among(scene, blades(), _wall_behind(1.2))


def among_bubbles(scene: Scene) -> Scene:
    """Let bubbles of 2 mm rise past the camera, along the picture's columns."""
    bubbles = Particles(150.0, diameter=2e-3, albedo=0.3, drift=(0.02, -0.25, 0.0))
    return replace(scene, particles=bubbles)


def _among(scene: Scene, *meshes: Mesh) -> Scene:
    """Stand meshes of the world frame, whose middle is the hull's, in the hull's place."""
    paint = Plain(0.08)
    at = Pose(np.eye(3), np.array([0.0, 0.95, 0.0]))
    return replace(scene, bodies=tuple(Body(mesh, at, paint) for mesh in meshes))


def _wall_behind(distance: float) -> Mesh:
    wall = plate(2.4, 3.2, step=0.05)
    return Mesh(wall.vertices + np.array([0, 0, distance]), wall.faces)


def with_laser_off(scene: Scene) -> Scene:
    """Switch the laser off; the exposure stays."""
    return replace(scene, light=replace(scene.light, is_on=False))


def _as_exposed(scene: Scene) -> Scene:
    """Say the exposure that the stripe's grey level stands for by its time."""
    sensor = replace(scene.sensor, peak_grey=None, vignetting=False)
    simulator = Simulator.of(replace(scene, sensor=replace(scene.sensor, vignetting=False)))
    wanted = float(np.median(simulator.camera.electrons))
    given = sensor.electrons_per_radiance(scene.rig.wavelength) / scene.index**2
    exposure = sensor.exposure * wanted / given
    return replace(scene, sensor=replace(sensor, exposure=exposure, vignetting=True))


def _repaint(body: Body, seed: int) -> Body:
    return replace(body, texture=replace(body.texture, seed=seed))


def with_window(**changed: object) -> Change:
    return lambda scene: replace(scene, window=replace(scene.window, **changed))


def with_overlay(**changed: object) -> Change:
    return lambda scene: replace(scene, overlay=replace(scene.overlay, **changed))


def with_sensor(**changed: object) -> Change:
    return lambda scene: replace(scene, sensor=replace(scene.sensor, **changed))


def rolled(degrees: float) -> Change:
    """Turn the laser about the camera's axis; scan lines stay columns."""

    def change(scene: Scene) -> Scene:
        (laser,) = scene.rig.lasers
        turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
        return replace(scene, rig=replace(scene.rig, lasers=(_turned(laser, turn),)))

    return change


def with_second_laser(turn: np.ndarray) -> Change:
    """Add a laser: the first, turned about its own origin."""

    def change(scene: Scene) -> Scene:
        first = scene.rig.lasers[0]
        fan = first.sheet
        second = Laser(replace(_turned(first, turn).sheet, origin=fan.origin), "y")
        return replace(scene, rig=replace(scene.rig, lasers=(first, second)))

    return change


def _turned(laser: Laser, turn: np.ndarray) -> Laser:
    fan = laser.sheet
    fan = replace(
        fan,
        origin=turn @ fan.origin,
        direction=turn @ fan.direction,
        tangent=turn @ fan.tangent,
        port=replace(fan.port, normal=turn @ fan.port.normal),
    )
    return Laser(fan, "y")


_AHEAD = Rotation.from_euler("x", 6, degrees=True).as_matrix()
BESIDE = _AHEAD
"""A second sheet some sixty rows below the first."""
CROSSED = Rotation.from_rotvec(math.radians(20) * np.array([0.0, 0.316, 0.949])).as_matrix()
"""A second sheet that crosses the first in the middle of the picture."""


def lit(ratio: float, contrast: float) -> Change:
    """Switch a lamp on, over a hull and a wall whose paint is that uneven.

    Args:
        ratio: Median height of the stripe, as a share of the background it stands on.
        contrast: Of the paint: how far dark and light are from their mean, as a share.
    """

    def change(scene: Scene) -> Scene:
        dark, light = (0.08 * (1 + side * contrast) for side in (-1, 1))
        paint = Growth(dark, light, size=0.02, seed=scene.seed)
        bodies = tuple(replace(body, texture=paint) for body in scene.bodies)
        lamp = Lamp(power=1.0)
        scene = replace(scene, bodies=bodies, light=replace(scene.light, lamp=lamp))
        middle = Simulator.of(scene).draw_light(len(scene) // 2)
        line = middle.lasers[0]
        on_hull = line.line.points[:, 2] < HULL_ENDS
        at = np.rint(line.line.positions[on_hull]).astype(int), line.line.lines[on_hull]
        stripe, background = line.stripe[at], middle.ambient[at]
        lamp = replace(lamp, power=float(np.median(stripe) / np.median(background)) / ratio)
        grey = ratio * _LIT * float(np.quantile(stripe, 0.97) / np.median(stripe))
        return replace(
            scene,
            light=replace(scene.light, lamp=lamp),
            sensor=replace(scene.sensor, peak_grey=grey),
        )

    return change


def in_colour(scene: Scene) -> Scene:
    """Film with a colour camera: a green laser, and a lamp that is white but for the water."""
    return replace(
        scene,
        light=replace(scene.light, colour=(0.6, 1.0, 0.8)),
        sensor=replace(scene.sensor, colour="rggb", interlaced=False),
    )


def with_processing(**changed: object) -> Change:
    return lambda scene: replace(scene, processing=replace(scene.processing, **changed))


def with_recorder(**changed: object) -> Change:
    return lambda scene: replace(scene, recorder=Recorder(**changed))


def with_light(**changed: object) -> Change:
    return lambda scene: replace(scene, light=replace(scene.light, **changed))


def wide(sigma: float) -> Change:
    """Let the sheet be that thick on the hull [px] and white, and the hull of one paint.

    A lens out of focus would mix the scan lines, so that the plateau's middle is no truth.
    """
    light = with_light(waist=4 * sigma * _PIXEL)
    bright = with_sensor(peak_grey=900.0)

    def change(scene: Scene) -> Scene:
        hull, *others = scene.bodies
        hull = replace(hull, texture=Plain(0.08))
        return bright(light(replace(scene, bodies=(hull, *others))))

    return change


GHOST = with_window(ghost=40.0)
WINDOW = with_window(dirt=0.02, scratches=2)
SENSOR = with_sensor(response=0.01, hot_pixels=0.002, row_noise=1.0)
FAN = with_light(streaks=0.1)
WRITTEN = with_overlay(text=_TEXT)
FRAMED = with_overlay(border=150.0)
CLUTTER = (GHOST, WINDOW, SENSOR, FAN, WRITTEN, FRAMED)
"""All that is fixed to the picture, at once."""
