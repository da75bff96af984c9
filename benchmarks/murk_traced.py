"""Ten frames whose light a path tracer drew: water that shares nothing with the simulator's."""

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
from path_tracer import DEPTH, SCATTERED, import_mitsuba
from path_tracer_scene import BASELINE, FOCAL, LENS, SIZE, THICKNESS, WALL, describe
from scipy.interpolate import make_lsq_spline
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import nnls

from murkscan.io.parquet import writing_true_stripes
from murkscan.io.rig_toml import save_rig
from murkscan.io.video import writing_video
from murkscan.optics.medium import Medium
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.simulate import Sensor
from murkscan.simulate.sensor import expose
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig
from murkscan.types.true_stripe import TrueStripe

FRAMES = 10
SAMPLES = {"lit": 256, "black": 128}
"""Paths a pixel; all columns see the same wall, so that their mean has 320 times as many."""
_WALLS = np.linspace(0.72, 0.88, FRAMES)
"""Distances of the wall [m]."""
_WATER = Medium(3.0, SCATTERED, HenyeyGreenstein(0.9))
_CORE = float(np.hypot(THICKNESS * FOCAL, LENS))
"""Width of the stripe that no water has spread, 1σ [px]."""
_WIDTHS = np.array([1.0, 1.7, 3.0, 5.5, 10.0, 20.0]) * _CORE
"""Widths of the Gaussians that stand for the traced stripe, with its skirt [px]."""
_KNOTS = np.arange(40.0, SIZE[1] - 20, 40.0)
"""Where the polynomials that stand for the traced glow meet [px]."""
_PEAK = 200.0
_SENSOR = Sensor()


def is_possible() -> bool:
    """Tell whether the path tracer is installed."""
    return importlib.util.find_spec("mitsuba") is not None


def trace_recording(folder: Path, seed: int) -> None:
    """Write a recording of a wall that goes away, its rig and its truth."""
    mitsuba = import_mitsuba()
    (folder / "truth").mkdir(parents=True, exist_ok=True)
    lights = [_draw(mitsuba, wall) for wall in _WALLS]
    brightest = max(float(stripe.max()) for stripe, _ in lights)
    scale = _PEAK / _SENSOR.grey_per_electron / brightest
    noise = np.random.default_rng(seed)
    truth = []
    with writing_video(folder / "recording.mkv", SIZE, rate=25.0, codec="ffv1") as write:
        for number, (stripe, glow) in enumerate(lights):
            light = np.tile(scale * (stripe + glow), (SIZE[0], 1)).T.astype(np.float32)
            write(expose(_SENSOR, light, noise), number / 25)
            truth.append(_tell(number, scale * stripe, light[:, 0]))
    save_rig(folder / "rig.toml", _rig())
    with writing_true_stripes(folder / "truth" / "stripes.parquet") as tell:
        tell(TrueStripe.concatenate(truth))


def _rig() -> Rig:
    middle = ((SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2)
    laser = Laser.from_baseline_angle(BASELINE, float(np.arctan2(WALL, BASELINE)), "y")
    return Rig(Camera(SIZE, (FOCAL, FOCAL), middle), (laser,))


def _row_of(wall: float) -> float:
    """Give where the sheet meets a wall [px]."""
    return (SIZE[1] - 1) / 2 + FOCAL * BASELINE * (1 / WALL - 1 / wall)


def _draw(mitsuba: Any, wall: float) -> tuple[np.ndarray, np.ndarray]:
    """Draw one column: the stripe, with what the water spreads of it, and the glow.

    What is left of the path tracer's own noise would be ridges as long as the picture: the stripe
    is replaced by Gaussians around its true centre, the glow by a spline that is too stiff for it.
    """
    lit = _trace(mitsuba, wall, 0.2, SAMPLES["lit"])
    black = _trace(mitsuba, wall, 0.0, SAMPLES["black"])
    rows = np.arange(SIZE[1], dtype=float)
    bells = np.exp(-0.5 * ((rows[:, None] - _row_of(wall)) / _WIDTHS) ** 2)
    weights, _ = nnls(bells, lit - black)
    knots = np.concatenate([np.zeros(4), _KNOTS, np.full(4, rows[-1])])
    rough = gaussian_filter1d(black, 20.0, mode="nearest")
    glow = make_lsq_spline(rows, black, knots, w=1 / rough)(rows)
    return bells @ weights, np.maximum(glow, 0.0)


def _trace(mitsuba: Any, wall: float, albedo: float, samples: int) -> np.ndarray:
    """Trace the wall, and give the mean of all columns, in a unit of its own."""
    scene = describe(mitsuba, _WATER, DEPTH)
    turn = mitsuba.ScalarTransform4f()
    place = turn.look_at(origin=[0, 0, wall], target=[0, 0, 0], up=[0, 1, 0])
    paint = {"type": "diffuse", "reflectance": {"type": "rgb", "value": albedo}}
    changed = {"to_world": place @ turn.scale([30, 30, 1]), "bsdf": paint}
    scene["wall"] = scene["wall"] | changed
    picture = np.array(mitsuba.render(mitsuba.load_dict(scene), spp=samples))[:, :, 0]
    return gaussian_filter1d(picture.astype(float).mean(axis=1), LENS, mode="nearest")


def _tell(number: int, stripe: np.ndarray, light: np.ndarray) -> TrueStripe:
    """Give the centre in every column, which geometry tells, and what the picture tells of it."""
    wall, count = _WALLS[number], SIZE[0]
    row, lines = _row_of(wall), np.arange(count, dtype=float)
    near = np.abs(np.arange(SIZE[1]) - row) <= 4 * _CORE
    weight = near * ~_SENSOR.is_full(light) / _SENSOR.variance(light)
    known = (weight * np.gradient(stripe) ** 2).sum()
    sideways = (lines - (count - 1) / 2) * wall / FOCAL
    height = (row - (SIZE[1] - 1) / 2) * wall / FOCAL
    small = np.zeros(count, np.uint8)
    return TrueStripe(
        frame=np.full(count, number, np.uint32),
        laser=small,
        branch=small,
        is_reflected=np.zeros(count, bool),
        pixels=np.stack([lines, np.full(count, row)], axis=1),
        points=np.stack([sideways, np.full(count, height), np.full(count, wall)], axis=1),
        signal=np.full(count, stripe.max() * _SENSOR.grey_per_electron, np.float32),
        snr=np.full(count, np.sqrt((weight * stripe**2).sum()), np.float32),
        crlb=np.full(count, 1 / np.sqrt(known), np.float32),
    )
