"""What real cameras, windows and lasers have: the rows beside the ladder, and their bars."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from murk_objects import fit_things, plate

from murkscan.simulate import Body, Scene, Simulator, load_scene
from murkscan.simulate.textures.growth import Growth
from murkscan.types.pose import Pose

Change = Callable[[Scene], Scene]

_TEXT = ("HDG 273  PITCH -2", "DPT 12.4 m", "{time}", "CAM 1  LAMP 40 %")
_WALL = 0.85
"""Distance of the wall on which the stripe stands still [m]."""
_HOPELESS = 6.0
"""Beam attenuation at which the camera's exposure is at its end [1/m]."""


@dataclass(frozen=True)
class Row:
    """One condition: a scene of the package, what is changed, and what is asked for."""

    murk: float
    """Beam attenuation of the water [1/m]."""
    changes: tuple[Change, ...]
    recall: float | None = None
    """Bar [%]; None: nothing is there to be found."""
    precision: float | None = None
    """Bar [%]."""
    false: float | None = None
    """Bar: false points in 10 000 scan lines, where nothing is there to be found."""

    def scene(self, seed: int) -> Scene:
        """Make the scene."""
        scene = replace(load_scene(f"hull-c{self.murk:g}"), seed=seed)
        scene = replace(scene, sensor=replace(scene.sensor, codec="ffv1"))
        for change in self.changes:
            scene = change(scene)
        return scene


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


def with_laser_off(scene: Scene) -> Scene:
    """Switch the laser off; the exposure stays."""
    return replace(scene, light=replace(scene.light, is_on=False))


def _as_exposed(scene: Scene) -> Scene:
    """Say the exposure that the stripe's grey level stands for by its time."""
    sensor = replace(scene.sensor, peak_grey=None, vignetting=False)
    simulator = Simulator.of(replace(scene, sensor=replace(scene.sensor, vignetting=False)))
    wanted = float(np.median(simulator.electrons))
    given = sensor.electrons_per_radiance(scene.rig.wavelength) / scene.index**2
    exposure = sensor.exposure * wanted / given
    return replace(scene, sensor=replace(sensor, exposure=exposure, vignetting=True))


def _repaint(body: Body, seed: int) -> Body:
    return replace(body, texture=replace(body.texture, seed=seed))


def _with_window(**changed: object) -> Change:
    return lambda scene: replace(scene, window=replace(scene.window, **changed))


def _with_overlay(**changed: object) -> Change:
    return lambda scene: replace(scene, overlay=replace(scene.overlay, **changed))


def _with_sensor(**changed: object) -> Change:
    return lambda scene: replace(scene, sensor=replace(scene.sensor, **changed))


def _with_light(**changed: object) -> Change:
    return lambda scene: replace(scene, light=replace(scene.light, **changed))


_GHOST = _with_window(ghost=40.0)
_WINDOW = _with_window(dirt=0.02, scratches=2)
_SENSOR = _with_sensor(response=0.01, hot_pixels=0.002, row_noise=1.0)
_FAN = _with_light(streaks=0.1)
_WRITTEN = _with_overlay(text=_TEXT)
_FRAMED = _with_overlay(border=150.0)
CLUTTER = (_GHOST, _WINDOW, _SENSOR, _FAN, _WRITTEN, _FRAMED)
"""All that is fixed to the picture, at once."""
_HULL = (with_things,)

ROWS: dict[str, Row] = {
    "c3-things": Row(3, _HULL, 96, 98.5),
    "c3-ghost": Row(3, (*_HULL, _GHOST), 96, 98.5),
    "c3-text": Row(3, (*_HULL, _WRITTEN), 96, 98.5),
    "c3-window": Row(3, (*_HULL, _WINDOW), 96, 98.5),
    "c3-pixels": Row(3, (*_HULL, _SENSOR), 96, 98.5),
    "c3-streaks": Row(3, (*_HULL, _FAN), 96, 98.5),
    "c3-border": Row(3, (*_HULL, _FRAMED), 96, 98.5),
    "c3-clutter": Row(3, (*_HULL, *CLUTTER), 96, 98.5),
    "c5-clutter": Row(5, (*_HULL, *CLUTTER), 96, 98.5),
    "c3-still": Row(3, (before_a_wall, *CLUTTER), 95, 98),
    "c5-still": Row(5, (before_a_wall, *CLUTTER), 95, 98),
    "c3-off": Row(3, (*_HULL, *CLUTTER, with_laser_off), false=1),
    "c3-sea": Row(3, (in_an_empty_sea, *CLUTTER), false=1),
    "c10": Row(10, (*_HULL, in_hopeless_murk, *CLUTTER), false=1),
}
"""Cases beside the ladder, by name."""
