"""Tell paint by the stripe's brightness, from pictures to the coloured surface.

Run: python benchmarks/reflectance.py [FOLDER]
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from harness import Figure, tell
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.optics.medium import Medium
from murkscan.project import Project
from murkscan.simulate import Body, Scene, Sensor
from murkscan.simulate.shapes import Plane
from murkscan.simulate.textures import Bands
from murkscan.survey.simulate import simulate_recording
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory
from murkscan.types.water import Water

ALBEDOS, WIDTH = (0.15, 0.45), 0.1
"""Of the two paints, and how wide each band is along x [m]."""
AWAY, FRAMES, STEP = 0.6, 60, 0.005
LEAN = Rotation.from_euler("y", 30, degrees=True).as_matrix()
"""The wall's: its left is far, its right near."""
CLEAR = 0.25
"""Share of a band on either side that is left out: a finder's window reaches over the edge."""
WATERS = {
    "air": (None, ()),
    "water of c = 1 /m, c given": (1.0, ("--attenuation-per-m", "1")),
    "water of c = 1 /m, c not given": (1.0, ()),
    "water of c = 2.5 /m, c given": (2.5, ("--attenuation-per-m", "2.5")),
}
NOTE = """
A wall with bands of two paints, albedo 0.15 and 0.45, that leans by 30° about the way along which
it is filmed, so that its left edge is 2.2 times as far as its right one. Pictures of 540 × 432 px
go through `murkscan scan` with the default finder and `murkscan mesh --colour reflectance`. *ratio*
is the light paint's median over the dark one's, of points of the cloud a quarter of a band away
from its edges; the truth is 3. *far over near* compares the light paint's outermost bands; of one
paint it is 1. *coloured as their paint* counts the vertices of the surface whose colour lies on
their paint's side of the middle between the two. Where c is not given, the glow of these pictures,
which the wall fills, does not tell it, and the water is not corrected for.
"""


def film(folder: Path, attenuation: float | None) -> None:
    """Film the wall."""
    camera = Camera((540, 432), (415.0, 415.0), (269.5, 215.5))
    laser = Laser.from_baseline_angle(0.25, np.arctan2(AWAY, 0.25), "y")
    rig = Rig(camera, (laser,), 532e-9, water=None if attenuation is None else Water(15.0, 35.0))
    times = np.arange(FRAMES) / 10
    places = np.stack([0 * times, STEP * 10 * times - FRAMES * STEP / 2, 0 * times], axis=1)
    way = Trajectory(times, places, np.tile([1.0, 0.0, 0.0, 0.0], (FRAMES, 1)))
    paint = Bands(ALBEDOS, (WIDTH, WIDTH), "x")
    wall = Body(Plane(8.0, 8.0).mesh(), Pose(LEAN, np.array([0.0, 0.0, AWAY])), texture=paint)
    medium = None if attenuation is None else Medium(attenuation)
    sensor = Sensor(peak_grey=200.0, read_noise=2.0)
    simulate_recording(Scene((wall,), rig, way, times, medium=medium, sensor=sensor), folder)


def judge(folder: Path, attenuation: float | None, words: tuple[str, ...]) -> dict[str, float]:
    """Scan the wall, and hold the paints against one another."""
    recording, out = folder / f"film-{attenuation}", folder / "out"
    if not recording.exists():
        film(recording, attenuation)
    given = ("--rig", str(recording / "rig.toml"), "--poses", str(recording / "poses.csv"))
    assert run(["scan", str(recording / "frames"), *given, "--out", str(out), *words]) == 0
    assert run(["mesh", str(out), "--colour", "reflectance"]) == 0
    cloud, mesh = Project(out).load_cloud(), Project(out).load_mesh()
    band, is_inside = locate(cloud.points)
    is_known = is_inside & (cloud.reflectance > 0)
    light = [band_ for band_ in np.unique(band[is_known]) if band_ % 2 == 1]
    full = [one for one in light if (is_known & (band == one)).sum() > 500]
    told = {}
    for name, values in (("signal", cloud.signal), ("reflectance", cloud.reflectance)):
        dark, bright = (np.median(values[is_known & (band % 2 == k)]) for k in (0, 1))
        near, far = (np.median(values[is_known & (band == full[end])]) for end in (-1, 0))
        told[f"{name}: ratio"] = float(bright / dark)
        told[f"{name}: far over near"] = float(far / near)
    return told | {"coloured": 100 * share_coloured(mesh)}


def locate(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give the number of each point's band, and whether it is well inside of it."""
    along = ((points - [0.0, 0.0, AWAY]) @ LEAN)[:, 0] / WIDTH
    band = np.floor(along).astype(int)
    return band, np.abs(along - band - 0.5) < 0.5 - CLEAR


def share_coloured(mesh) -> float:
    """Give the share of vertices whose colour tells their paint."""
    band, is_inside = locate(mesh.vertices)
    shade = mesh.colours.astype(float).mean(axis=1)
    dark, bright = (np.median(shade[is_inside & (band % 2 == k)]) for k in (0, 1))
    is_light = shade > (dark + bright) / 2
    return float(np.mean(is_light[is_inside] == (band[is_inside] % 2 == 1)))


def main() -> None:
    kept = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    figures = []
    for number, (name, (attenuation, words)) in enumerate(WATERS.items()):
        with tempfile.TemporaryDirectory() as temporary:
            folder = kept / str(number) if kept else Path(temporary)
            told = judge(folder, attenuation, words)
        truth = ALBEDOS[1] / ALBEDOS[0]
        off = 100 * (told["reflectance: ratio"] / truth - 1)
        figures += [
            Figure(f"{name}: ratio of the paints", told["reflectance: ratio"]),
            Figure(
                f"{name}: its error",
                abs(off),
                "%",
                at_most=10.0 if words or not attenuation else None,
            ),
            Figure(f"{name}: far over near, as seen", told["signal: far over near"]),
            Figure(f"{name}: far over near", told["reflectance: far over near"]),
            Figure(f"{name}: vertices coloured as their paint", told["coloured"], "%"),
        ]
    tell("reflectance", "Paint told by the stripe's brightness", figures, note=NOTE)


if __name__ == "__main__":
    main()
