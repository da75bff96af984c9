"""The rows beside the ladder: what is filmed, and what is asked for."""

from dataclasses import dataclass, replace

import murk_changes as to
from murk_changes import Change
from murk_match import REACH, VISIBLE

from murkscan.simulate import Recorder, Scene, load_scene


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
    reach: float = REACH
    """Distance from a true centre up to which a found one is right [px]."""
    deep: tuple[float | None, ...] = ()
    """Bars of recall [%] for bounds of .5 to 2, 2 to 4.6 and 4.6 to 10 px."""
    hd: bool = False
    """Whether the machine-vision rig films."""

    def scene(self, seed: int) -> Scene:
        """Make the scene."""
        scene = replace(load_scene(f"hull-c{self.murk:g}{'-hd' * self.hd}"), seed=seed)
        scene = replace(scene, recorder=Recorder("ffv1"))
        for change in self.changes:
            scene = change(scene)
        return scene


def _deep(murk: float, bars: tuple[float | None, ...], *changes: Change) -> Row:
    """Ask for what no single scan line shows."""
    return Row(murk, (to.with_things, *changes), None, 95, visible=10.0, reach=3.0, deep=bars)


def _hull(recall: float, precision: float, *changes: Change) -> Row:
    """Ask for so much on the hull with its things at c = 3 /m, with these changes."""
    return Row(3, (to.with_things, *changes), recall, precision)


ROWS: dict[str, Row] = {
    "c3-things": Row(3, (to.with_things,), 96, 98.5),
    "c3-ghost": Row(3, (to.with_things, to.GHOST), 96, 98.5),
    "c3-text": Row(3, (to.with_things, to.WRITTEN), 96, 98.5),
    "c3-window": Row(3, (to.with_things, to.WINDOW), 96, 98.5),
    "c3-pixels": Row(3, (to.with_things, to.SENSOR), 96, 98.5),
    "c3-streaks": Row(3, (to.with_things, to.FAN), 96, 98.5),
    "c3-border": Row(3, (to.with_things, to.FRAMED), 96, 98.5),
    "c3-clutter": Row(3, (to.with_things, *to.CLUTTER), 96, 98.5),
    "c5-clutter": Row(5, (to.with_things, *to.CLUTTER), 96, 98.5),
    "c3-still": Row(3, (to.before_a_wall, *to.CLUTTER), 95, 98),
    "c5-still": Row(5, (to.before_a_wall, *to.CLUTTER), 95, 98),
    "c3-off": Row(3, (to.with_things, *to.CLUTTER, to.with_laser_off), false=1),
    "c3-sea": Row(3, (to.in_an_empty_sea, *to.CLUTTER), false=1),
    "c0.3-wide8": Row(0.3, (to.wide(8.0),), 97, 97, bias=0.05),
    "c3-wide8": Row(3, (to.wide(8.0),), 97, 97, bias=0.05),
    "c0.3-wide14": Row(0.3, (to.wide(14.0),), 90, 97, bias=0.05),
    "c0.3-widths": Row(0.3, (to.with_white_things, to.with_sensor(peak_grey=900.0)), 96, 98.5),
    "c3-widths": Row(3, (to.with_white_things, to.with_sensor(peak_grey=900.0)), 96, 98.5),
    "c3-speckle5": _hull(95, 98.5, to.with_light(speckle=0.5)),
    "c3-speckle7": _hull(95, 98.5, to.with_light(speckle=0.7)),
    "c3-isp": _hull(95, 98.5, to.with_processing(gamma=0.45, sharpening=1.0)),
    "c3-denoise": _hull(95, 98.5, to.with_recorder(codec="ffv1", denoise=0.8)),
    "c1.5-stream": Row(
        1.5,
        (to.with_things, to.with_recorder(codec="h264", crf=23, streamed=True)),
        95,
        98.5,
    ),
    "c3-h264-2.8": _hull(95, 98.5, to.with_recorder(codec="h264", bitrate=2.8e6)),
    "c3-h265-2.8": _hull(95, 98.5, to.with_recorder(codec="h265", bitrate=2.8e6)),
    "c3-mjpeg": _hull(95, 98.5, to.with_recorder(codec="mjpeg", quality=5)),
    "c3-h264-hd": Row(
        3, (to.with_things, to.with_recorder(codec="h264", crf=32)), 95, 98.5, hd=True
    ),
    "c3-h265-hd": Row(
        3, (to.with_things, to.with_recorder(codec="h265", bitrate=4e6)), 95, 98.5, hd=True
    ),
    "c3-lamp20": Row(3, (to.with_things, to.lit(0.2, 0.05)), 90, 98),
    "c3-lamp100": Row(3, (to.with_things, to.lit(1.0, 0.2)), 60, 98),
    "c3-lamp20-colour": Row(3, (to.with_things, to.in_colour, to.lit(0.2, 0.05)), 90, 98),
    "c3-lamp100-colour": Row(3, (to.with_things, to.in_colour, to.lit(1.0, 0.2)), 60, 98),
    "c3-lamp20-colour-h264": Row(
        3,
        (to.with_things, to.in_colour, to.lit(0.2, 0.05), to.with_recorder(codec="h264", crf=23)),
        90,
        98,
    ),
    "c3-roll45": Row(3, (to.with_things, to.rolled(45)), 95, 98),
    "c3-roll63": Row(3, (to.with_things, to.rolled(63)), 95, 98),
    "c1.5-grating": Row(1.5, (to.before_a_grating, to.rolled(45)), 96, 98),
    "c1.5-chain": Row(1.5, (to.before_chains, to.rolled(45)), 96, 98),
    "c1.5-blades": Row(1.5, (to.before_blades, to.rolled(45)), 96, 98),
    "c3-bubbles": Row(3, (to.with_things, to.among_bubbles), 95, 98),
    "c1.5-pieces": Row(1.5, (to.before_pieces,), 80, 98),
    "c3-crossed": Row(3, (to.with_things, to.with_second_laser(to.CROSSED)), 95, 98),
    "c3-beside": Row(3, (to.with_things, to.with_second_laser(to.BESIDE)), 95, 98),
    "c5-dim": _deep(5, (95, 70, None), to.with_sensor(peak_grey=50 / 16)),
    "c7": _deep(7, (93, 75, 50)),
    "c8": _deep(8, (None, 90, 60)),
    "c10": Row(10, (to.with_things, to.in_hopeless_murk, *to.CLUTTER), false=1),
}
"""Cases beside the ladder, by name."""
TWO_LASERS = ("c3-crossed", "c3-beside")
