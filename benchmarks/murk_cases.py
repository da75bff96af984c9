"""What the judge of finders shows them: a hull in ever murkier water, and other waters beside."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from murk_match import REACH, VISIBLE
from murk_rows import ROWS
from murk_traced import FRAMES, is_possible, trace_recording

from murkscan.capture import AbstractRecording, open_recording
from murkscan.io.parquet import load_true_stripe
from murkscan.io.rig_toml import load_rig
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.simulate import Body, Recorder, Scene, load_scene
from murkscan.simulate.textures import Plain
from murkscan.simulate.textures.bands import Bands
from murkscan.simulate.textures.growth import Growth
from murkscan.survey.simulate import simulate_recording
from murkscan.types.rig import Rig
from murkscan.types.true_stripe import TrueStripe

RUNGS = ("c0.3", "c0.5", "c1.5", "c3", "c4", "c5", "c6")
HD = tuple(f"{rung}-hd" for rung in RUNGS)
_AMBIENT = 0.01
"""Daylight that raises the wet background of c = 3 /m to some 50 grey levels [W/m²]."""
_WALL = 1.3
"""What is farther than this is the wall [m]."""
_GLOSS = 0.15
_BANDS = Bands(albedos=(0.03, 0.11), widths=(0.05, 0.05), axis="x")
"""Paint with sharp edges, which growth has not."""
_READ_NOISE = 25.0
_SCATTERED = 0.95
"""Single scattering albedo of other water: half as broad a skirt again as with 0.83."""


def _with_gloss(scene: Scene) -> Scene:
    return replace(scene, bodies=tuple(replace(body, gloss=_GLOSS) for body in scene.bodies))


def _with_bands(scene: Scene) -> Scene:
    return replace(
        scene,
        bodies=tuple(
            replace(body, texture=_BANDS) if isinstance(body.texture, Growth) else body
            for body in scene.bodies
        ),
    )


def _with_medium(**changed: object) -> Callable[[Scene], Scene]:
    return lambda scene: replace(scene, medium=replace(scene.medium, **changed))


def _with_sensor(**changed: object) -> Callable[[Scene], Scene]:
    return lambda scene: replace(scene, sensor=replace(scene.sensor, **changed))


OTHERS: dict[str, Callable[[Scene], Scene]] = {
    "c3-ambient": lambda scene: replace(scene, light=replace(scene.light, ambient=_AMBIENT)),
    "c3-gloss": _with_gloss,
    "c3-h264": lambda scene: replace(scene, recorder=Recorder("h264", crf=23)),
    "c3-phase": _with_medium(phase=HenyeyGreenstein(0.9)),
    "c3-skirt": _with_medium(single_scattering_albedo=_SCATTERED),
    "c3-paint": _with_bands,
    "c3-noise": _with_sensor(read_noise=_READ_NOISE),
}
"""Cases at c = 3 /m beside the ladder, and what is changed for each."""
TRACED = "c3-traced"
HD_ROWS = tuple(case for case, row in ROWS.items() if row.hd)
CASES = (*RUNGS, *OTHERS, TRACED, *ROWS, *HD)


@dataclass(frozen=True)
class Part:
    """One case with one seed, so many pictures long."""

    case: str
    seed: int
    pictures: int

    @property
    def name(self) -> str:
        """Name of its folder in the cache."""
        return f"{self.case}-seed{self.seed}-{self.pictures}"

    @property
    def visible(self) -> float:
        """Bound of a scan line up to which a true centre counts as visible [px]."""
        return ROWS[self.case].visible if self.case in ROWS else VISIBLE

    @property
    def reach(self) -> float:
        """Distance from a true centre up to which a found one is right [px]."""
        return ROWS[self.case].reach if self.case in ROWS else REACH

    def scene(self) -> Scene:
        """Make the scene: pictures from the middle of the hull, with paint of the seed's own."""
        return _scene_of(self)

    def _made(self) -> Scene:
        row = ROWS.get(self.case)
        scene = self._on_ladder() if row is None else row.scene(self.seed)
        rows, middle = scene.row_step, len(scene) // (2 * scene.row_step)
        first = middle - self.pictures // 2
        return replace(scene, times=scene.times[rows * first : rows * (first + self.pictures)])

    def _on_ladder(self) -> Scene:
        ladder = self.case if self.case in RUNGS + HD else "c3"
        scene = load_scene(f"hull-{ladder}")
        scene = replace(
            scene,
            seed=self.seed,
            bodies=tuple(_repaint(body, self.seed) for body in scene.bodies),
            recorder=Recorder("ffv1"),
        )
        return OTHERS.get(self.case, lambda same: same)(scene)

    def paint(self, truth: TrueStripe) -> np.ndarray:
        """Give the albedo of true centres on the hull; NaN on the wall, which is even."""
        albedo, on_hull = np.full(len(truth), np.nan), truth.points[:, 2] < _WALL
        if self.case == TRACED or not self.scene().bodies:
            return albedo
        hull = self.scene().bodies[0]
        if not isinstance(hull.texture, Plain):
            points = hull.world_from_object.inverse() @ truth.points[on_hull]
            albedo[on_hull] = hull.texture.albedo(points)
        return albedo

    def recorded(self, cache: Path) -> "Recorded":
        """Give the recording, drawn if the cache does not hold it whole."""
        folder = cache / self.name
        whole = (folder / "recording.mkv", folder / "truth" / "stripes.parquet")
        if not all(path.exists() for path in whole):
            shutil.rmtree(folder, ignore_errors=True)
            if self.case == TRACED:
                trace_recording(folder, self.seed)
            else:
                simulate_recording(self.scene(), folder)
        return Recorded(folder, self.case != TRACED and self.scene().sensor.interlaced)


@lru_cache(maxsize=2)
def _scene_of(part: Part) -> Scene:
    """Make a scene once: some set their light by looking."""
    return part._made()


def _repaint(body: Body, seed: int) -> Body:
    texture = body.texture
    return (
        replace(body, texture=replace(texture, seed=seed)) if isinstance(texture, Growth) else body
    )


@dataclass(frozen=True)
class Recorded:
    """A folder that holds a recording and its truth."""

    folder: Path
    is_interlaced: bool

    @property
    def recording(self) -> AbstractRecording:
        """The pictures."""
        path = self.folder / "recording.mkv"
        return open_recording(path, fields="top-first" if self.is_interlaced else "progressive")

    @property
    def rig(self) -> Rig:
        """The true rig."""
        return load_rig(self.folder / "rig.toml")

    @property
    def truth(self) -> TrueStripe:
        """The true centres."""
        return load_true_stripe(self.folder / "truth" / "stripes.parquet")


def parts_of(cases: list[str], seeds: list[int], pictures: int, pictures_hd: int) -> Iterator[Part]:
    """Give the parts in the order of the cases: beside the ladder of the first seed alone."""
    for case in cases:
        length = {TRACED: FRAMES} | dict.fromkeys((*HD, *HD_ROWS), pictures_hd)
        if case != TRACED or is_possible():
            for seed in seeds if case in RUNGS else seeds[:1]:
                yield Part(case, seed, length.get(case, pictures))
