"""What real cameras, windows and lasers have: the rows beside the ladder, and their bars."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from murk_match import VISIBLE
from murk_objects import fit_things, plate

from murkscan.simulate import Body, Recorder, Scene, Simulator, load_scene
from murkscan.simulate.textures import Plain
from murkscan.simulate.textures.growth import Growth
from murkscan.types.pose import Pose

Change = Callable[[Scene], Scene]

_TEXT = ("HDG 273  PITCH -2", "DPT 12.4 m", "{time}", "CAM 1  LAMP 40 %")
_WALL = 0.85
"""Distance of the wall on which the stripe stands still [m]."""
_PIXEL = 0.00115
"""What a pixel of PAL sees of the hull, across the sheet [m]."""
_PLASTIC = 0.004
"""How far light goes on under white plastic [m]."""
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
    bias: float | None = None
    """Bar [px]; of all errors' median."""
    visible: float = VISIBLE
    """Bound of a scan line up to which a true centre counts as visible [px]."""
    hd: bool = False
    """Whether the machine-vision rig films."""

    def scene(self, seed: int) -> Scene:
        """Make the scene."""
        scene = replace(load_scene(f"hull-c{self.murk:g}{'-hd' * self.hd}"), seed=seed)
        scene = replace(scene, recorder=Recorder("ffv1"))
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


def with_white_things(scene: Scene) -> Scene:
    """Make anodes and plates of white plastic: bands of 18 px beside a line of 2 px."""
    hull, *others = scene.bodies
    cut, *things = fit_things(_repaint(hull, scene.seed), scene.seed)
    white = [replace(t, texture=Plain(0.8), translucency=_PLASTIC, gloss=0.1) for t in things]
    return replace(scene, bodies=(cut, *white, *others))


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


def _with_processing(**changed: object) -> Change:
    return lambda scene: replace(scene, processing=replace(scene.processing, **changed))


def _with_recorder(**changed: object) -> Change:
    return lambda scene: replace(scene, recorder=Recorder(**changed))


def _with_light(**changed: object) -> Change:
    return lambda scene: replace(scene, light=replace(scene.light, **changed))


def _wide(sigma: float) -> Change:
    """Let the sheet be that thick on the hull [px] and white, and the hull of one paint.

    A lens out of focus would mix the scan lines, so that the plateau's middle is no truth.
    """
    light = _with_light(waist=4 * sigma * _PIXEL)
    bright = _with_sensor(peak_grey=900.0)

    def change(scene: Scene) -> Scene:
        hull, *others = scene.bodies
        hull = replace(hull, texture=Plain(0.08))
        return bright(light(replace(scene, bodies=(hull, *others))))

    return change


_GHOST = _with_window(ghost=40.0)
_WINDOW = _with_window(dirt=0.02, scratches=2)
_SENSOR = _with_sensor(response=0.01, hot_pixels=0.002, row_noise=1.0)
_FAN = _with_light(streaks=0.1)
_WRITTEN = _with_overlay(text=_TEXT)
_FRAMED = _with_overlay(border=150.0)
CLUTTER = (_GHOST, _WINDOW, _SENSOR, _FAN, _WRITTEN, _FRAMED)
"""All that is fixed to the picture, at once."""
_HULL = (with_things,)


def _hull(recall: float, precision: float, *changes: Change) -> Row:
    """Ask for so much on the hull with its things at c = 3 /m, with these changes."""
    return Row(3, (with_things, *changes), recall, precision)


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
    "c0.3-wide8": Row(0.3, (_wide(8.0),), 97, 97, bias=0.05),
    "c3-wide8": Row(3, (_wide(8.0),), 97, 97, bias=0.05),
    "c0.3-wide14": Row(0.3, (_wide(14.0),), 90, 97, bias=0.05),
    "c0.3-widths": Row(0.3, (with_white_things, _with_sensor(peak_grey=900.0)), 96, 98.5),
    "c3-widths": Row(3, (with_white_things, _with_sensor(peak_grey=900.0)), 96, 98.5),
    "c3-speckle5": _hull(95, 98.5, _with_light(speckle=0.5)),
    "c3-speckle7": _hull(95, 98.5, _with_light(speckle=0.7)),
    "c3-isp": _hull(95, 98.5, _with_processing(gamma=0.45, sharpening=1.0)),
    "c3-denoise": _hull(95, 98.5, _with_recorder(codec="ffv1", denoise=0.8)),
    "c3-h264-2.8": _hull(95, 98.5, _with_recorder(codec="h264", bitrate=2.8e6)),
    "c3-h265-2.8": _hull(95, 98.5, _with_recorder(codec="h265", bitrate=2.8e6)),
    "c3-mjpeg": _hull(95, 98.5, _with_recorder(codec="mjpeg", quality=5)),
    "c3-h264-hd": Row(3, (with_things, _with_recorder(codec="h264", crf=32)), 95, 98.5, hd=True),
    "c3-h265-hd": Row(
        3, (with_things, _with_recorder(codec="h265", bitrate=4e6)), 95, 98.5, hd=True
    ),
    "c10": Row(10, (*_HULL, in_hopeless_murk, *CLUTTER), false=1),
}
"""Cases beside the ladder, by name."""
