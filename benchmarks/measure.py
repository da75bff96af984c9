"""Spheres, cylinders and steps in murky water: do the stated 95 % intervals hold the truth?"""

import inspect
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np
import tomlkit
from harness import Figure, tell
from kept import Kept, make_in_pieces

from murkscan.cli.scan import scan as scan_command
from murkscan.cloud import merge_profiles, remove_outliers
from murkscan.geometry.cylinder_fit import fit_cylinder
from murkscan.geometry.sphere_fit import fit_sphere
from murkscan.geometry.stripe_blur import Sight
from murkscan.measure import (
    Ball,
    Box,
    Sample,
    measure_cylinder,
    measure_sphere,
    measure_step,
    trust_plane,
)
from murkscan.optics import light_across, refractive_index
from murkscan.simulate import Scene, parse_scene, read_scene, simulate_frames
from murkscan.triangulate import RaySheet
from murkscan.triangulate.base import triangulate
from murkscan.types.frame import Frame
from murkscan.types.quantity import Quantity
from murkscan.types.stripe import Stripe
from murkscan.ui.choices import make_extractor

SEEDS = 40
PICTURES, TRAVEL_MM, RATE_HZ, START_MM = 14, 56.0, 25.0, 187.0
COLUMNS = 280
"""Middle columns of the PAL picture, which show all that is measured."""
DEFAULT = inspect.signature(scan_command).parameters["extractor"].default
"""What `murkscan scan` takes unless told."""
FINDERS = tuple(dict.fromkeys((DEFAULT, "gray-gravity")))
NORMAL_95 = 1.96


@dataclass(frozen=True)
class Case:
    """One seed's measure beside the truth [mm]."""

    error: float
    half_width: float
    perfect: float
    """1.96 standard deviations of least squares on the same points, if each erred by itself."""


def make_scene(name: str, seed: int, place: dict[str, object]) -> Scene:
    """Give a scene of the package other sizes, and the middle of its pictures only."""
    text, label, folder = read_scene(f"{name}-c1.5")
    document = tomlkit.parse(text)
    document["seed"] = seed
    document["object"][0].update(place)
    document["motion"].update(
        frames=PICTURES,
        frame_rate_hz=RATE_HZ,
        speed_mm_s=TRAVEL_MM / PICTURES * RATE_HZ,
        start_mm=[0.0, START_MM, 0.0],
    )
    scene = parse_scene(tomlkit.dumps(document), label, folder)
    camera = scene.rig.camera
    u = camera.principal_point[0] - (camera.size[0] - COLUMNS) / 2
    camera = replace(
        camera, size=(COLUMNS, camera.size[1]), principal_point=(u, camera.principal_point[1])
    )
    return replace(scene, rig=replace(scene.rig, camera=camera))


def scan(scene: Scene, extractor_name: str, frames: list[Frame]) -> Sample:
    """Scan frames as the commands do, without their files."""
    extractor = make_extractor(extractor_name, ())
    background = extractor.learn(frames, scene.rig)
    stripes = list(extractor.extract(frames, scene.rig, background))
    profile = triangulate(Stripe.concatenate(stripes), scene.rig, RaySheet())
    cloud = remove_outliers(merge_profiles(profile, scene.trajectory, axes=("y",)))
    cameras = scene.trajectory.at(scene.times).positions[cloud.frame]
    rays = cloud.points - cameras
    ranges = np.linalg.norm(rays, axis=1)
    rays /= ranges[:, None]
    along = np.tile([1.0, 0.0, 0.0], (len(cloud), 1))
    rig = scene.rig
    light = light_across(rig.lasers[0], refractive_index(rig.water, rig.wavelength))
    sight = Sight(rays, along, np.tile(light, (len(cloud), 1)), ranges)
    return Sample.from_cloud(cloud, sight=sight)


@dataclass(frozen=True)
class Sphere:
    """A ball of 40 to 60 mm radius."""

    seed: int

    def __post_init__(self) -> None:
        random = np.random.default_rng(self.seed)
        keep(self, size=random.uniform(40, 60), at=around(random, 10, (0, 200, 900)))

    def scene(self) -> Scene:
        """Place it before the rig."""
        return make_scene(
            "sphere", self.seed, {"radius_mm": self.size, "position_mm": self.at.tolist()}
        )

    def judge(self, sample: Sample) -> Case:
        """Measure it as a user would, who knows about where it is."""
        x, y, z = (self.at + np.array([2.0, -3.0, 1.0])) / 1e3
        part = sample[Ball((x, y, z), (self.size + 8) / 1e3).contains(sample.cloud.points)]
        fit = fit_sphere(part.cloud.points, sight=part.sight)
        return judge(measure_sphere(part)["radius"], self.size, fit.slopes[fit.inliers],
                     fit.residuals[fit.inliers], 3)  # fmt: skip


@dataclass(frozen=True)
class Cylinder:
    """A pipe of 40 to 70 mm radius, along the way."""

    seed: int

    def __post_init__(self) -> None:
        random = np.random.default_rng(self.seed)
        keep(self, size=random.uniform(40, 70), at=around(random, 10, (0, 200, 900)))
        keep(self, tilt=random.uniform(-5, 5, 3).tolist())

    def scene(self) -> Scene:
        """Place it before the rig."""
        place = {"mesh": "cylinder", "radius_mm": self.size, "length_mm": 600.0}
        place |= {"position_mm": self.at.tolist(), "rotation_deg": self.tilt}
        return make_scene("sphere", self.seed, place)

    def judge(self, sample: Sample) -> Case:
        """Measure it as a user would, who knows about where it is."""
        box = Box(tuple((self.at - 100) / 1e3), tuple((self.at + np.array([100, 100, 0])) / 1e3))
        part = sample[box.contains(sample.cloud.points)]
        fit = fit_cylinder(part.cloud.points, part.cloud.normals.astype(float), sight=part.sight)
        return judge(measure_cylinder(part)["radius"], self.size, fit.slopes[fit.inliers],
                     fit.residuals[fit.inliers], 4)  # fmt: skip


@dataclass(frozen=True)
class Stairs:
    """A step of 5 to 30 mm between two treads."""

    seed: int

    def __post_init__(self) -> None:
        random = np.random.default_rng(self.seed)
        keep(self, size=random.uniform(5, 30), at=around(random, 3, (0, 168, 880)))
        keep(self, tilt=random.uniform(-4, 4, 3).tolist())

    def scene(self) -> Scene:
        """Place it before the rig."""
        place = {"heights_mm": [0.0, self.size], "width_mm": 300.0, "tread_mm": 30.0}
        place |= {"position_mm": self.at.tolist(), "rotation_deg": self.tilt}
        return make_scene("stairs", self.seed, place)

    def judge(self, sample: Sample) -> Case:
        """Measure it as a user would, who knows about where it is."""
        parts, half = [], np.array([90, 9, 12]) / 1e3
        for tread, up in ((15.0, 0.0), (45.0, self.size)):
            middle = self.at / 1e3 + np.array([0.0, tread, -up]) / 1e3
            box = Box(tuple(middle - half), tuple(middle + half))
            parts.append(sample[box.contains(sample.cloud.points)])
        fits = [trust_plane(part)[0] for part in parts]
        inside = [fit.inliers for fit in fits]
        points = np.concatenate([p.cloud.points[i] for p, i in zip(parts, inside, strict=True)])
        second = np.repeat([0.0, 1.0], [int(i.sum()) for i in inside])
        flat = (points - points.mean(axis=0))[:, :2]
        design = np.column_stack([np.ones(len(points)), second, flat])
        off = np.concatenate([fit.residuals[fit.inliers] for fit in fits])
        return judge(measure_step(*parts)["step"], self.size, design, off, 1)


def keep(case: object, **values: object) -> None:
    """Set fields of a frozen value while it is made."""
    for name, value in values.items():
        object.__setattr__(case, name, value)


def around(random: np.random.Generator, reach: float, middle: tuple[float, ...]) -> np.ndarray:
    return random.uniform(-reach, reach, 3) + np.array(middle)


def judge(
    found: Quantity, truth_mm: float, slopes: np.ndarray, off: np.ndarray, which: int
) -> Case:
    """Put a measure beside the truth, and beside least squares on independent errors."""
    scale = np.linalg.norm(slopes, axis=0)
    inverse = np.linalg.inv((slopes / scale).T @ (slopes / scale))
    perfect = np.std(off) * np.sqrt(inverse[which, which]) / scale[which]
    return Case(
        found.value * 1e3 - truth_mm, found.half_width * 1e3, float(perfect) * NORMAL_95 * 1e3
    )


Kind = type[Sphere] | type[Cylinder] | type[Stairs]
CASES: dict[str, Kind] = {
    "sphere, radius": Sphere,
    "cylinder, radius": Cylinder,
    "stairs, step": Stairs,
}


def measure_all(kept: Kept) -> dict[str, dict[str, list[Case]]]:
    """Measure the seeds of every object, with every finder, as many as there is time for."""
    found: dict[str, dict[str, list[Case]]] = {f: {name: [] for name in CASES} for f in FINDERS}
    for seed in range(SEEDS):
        for name, kind in CASES.items():
            try:
                by_finder = kept.take(f"{name} {seed}", partial(measure_seed, kind, seed))
            except TimeoutError:
                continue
            for finder, values in by_finder.items():
                found[finder][name].append(Case(**values))
    return found


def measure_seed(kind: Kind, seed: int) -> dict[str, dict[str, float]]:
    """Give the fields of a `Case` for each finder."""
    case = kind(seed)
    scene = case.scene()
    frames = [simulated.frame for simulated in simulate_frames(scene, 0, len(scene))]
    return {finder: asdict(case.judge(scan(scene, finder, frames))) for finder in FINDERS}


def figures_of(name: str, cases: list[Case]) -> list[Figure]:
    errors = np.array([case.error for case in cases])
    widths = np.array([case.half_width for case in cases])
    perfect = np.array([case.perfect for case in cases])
    held = 100 * float(np.mean(np.abs(errors) <= widths))
    ratio = float(np.median(widths) / (NORMAL_95 * errors.std()))
    single = float(np.median(widths / perfect))
    return [
        Figure(f"{name}: truths within the 95 % interval", held, "%", at_least=90),
        Figure(f"{name}: interval over that of the errors", ratio, "times", at_most=1.5),
        Figure(f"{name}: interval over that of independent points", single, "times"),
        Figure(f"{name}: mean error", float(errors.mean()), "mm"),
        Figure(f"{name}: standard deviation of the errors", float(errors.std()), "mm"),
        Figure(f"{name}: usual half width of the interval", float(np.median(widths)), "mm"),
    ]


def counts_of(cases: dict[str, dict[str, list[Case]]]) -> str:
    """Say how many seeds of each were measured, which fewer than all are where time was short."""
    fewest = min(len(some) for some in cases[DEFAULT].values())
    if fewest == SEEDS:
        return f"{SEEDS} seeds each,"
    spread, share = 100 / (2 * fewest) ** 0.5, 100 * (0.05 * 0.95 / fewest) ** 0.5
    return (
        f"Stopped after {fewest} of {SEEDS} seeds each: a spread is known to {spread:.0f} %,\n"
        f"a share of truths to {share:.0f} points: bars may be met and missed by chance. Scenes are"
    )


def main() -> None:
    cases = make_in_pieces(measure_all)
    tell(
        "measure",
        "Measures of simulated scans, and their intervals",
        [
            figure
            for finder, by_name in cases.items()
            for name, some in by_name.items()
            for figure in figures_of(f"{finder}: {name}", some)
        ],
        note=f"""{counts_of(cases)} in water of c = 1.5 /m with particles, before the PAL rig
(interlaced, in a housing) 0.84 to 0.9 m away: {PICTURES} pictures over {TRAVEL_MM:g} mm, the middle
{COLUMNS} columns of each. Size, place and tilt differ from seed to seed: spheres of 40 to 60 mm and
cylinders of 40 to 70 mm radius, the latter tilted by up to 5 degrees, steps of 5 to 30 mm tilted by
up to 4 degrees. `{DEFAULT}` is what `murkscan scan` takes unless told.

The stated interval is put beside two others: 1.96 standard deviations of the errors over all seeds,
which is what was to be stated, and that of least squares if each point of the fit erred by itself
as much as they scatter, which is too narrow: neighbouring points err together, those of `murk` more
than others since it joins them. The rig is exact here: its covariance would widen intervals by the
common part.

The means of the errors of spheres and cylinders are what the formulas for the blur and for the
thickness of the sheet leave ([measure](../measure.md)).""",
    )


if __name__ == "__main__":
    main()
