"""Balls, a pipe and a step in murky water, and scans of them as the commands make them."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomlkit

from murkscan.capture import open_recording
from murkscan.cloud import merge_profiles, remove_outliers
from murkscan.io.poses import load_poses
from murkscan.io.rig_toml import load_rig
from murkscan.measure import (
    Ball,
    Box,
    Sample,
    measure_cylinder,
    measure_sphere,
    measure_step,
)
from murkscan.mesh import GridMesh
from murkscan.motion import PoseLog
from murkscan.optics.beam import Beam
from murkscan.optics.scan_lines import SheetScanLines
from murkscan.optics.seen_points import look_back
from murkscan.project import Project
from murkscan.simulate import Scene, parse_scene, read_scene
from murkscan.simulate.lit_line import cast_fan, find_lit_line
from murkscan.survey.cloud import build_cloud
from murkscan.survey.extract import extract_recording
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.simulate import simulate_recording
from murkscan.survey.triangulate import triangulate_stripes
from murkscan.triangulate import RaySheet
from murkscan.triangulate.base import triangulate
from murkscan.types.frame import Frame
from murkscan.types.measurement import Measurement
from murkscan.types.quantity import Quantity
from murkscan.types.stripe import Stripe
from murkscan.ui.choices import make_extractor

PICTURES, TRAVEL_MM, RATE_HZ, START_MM = 14, 56.0, 25.0, 187.0
COLUMNS, MARGIN = 280, 48
"""Middle columns of the PAL picture, which show all that is measured, and rows of it that are drawn
above and below the stripe."""
ASIDE_MM = 40.0
"""By which the two passes lie to either side of the object; a scan of one pass is the first."""
PASSES = 2
WALL = {"mesh": "plane", "width_mm": 4000.0, "height_mm": 4000.0}
BEHIND_MM = {"ball": 1200.0, "pipe": 1200.0, "step": 1000.0}
"""Distance of the wall behind."""


@dataclass(frozen=True)
class Target:
    """Something of known size, where it is, and how it is turned."""

    kind: str
    size: float
    """Radius, or height of the step [mm]."""
    at: np.ndarray
    """[mm]."""
    tilt: list[float]
    """[degrees]."""

    @classmethod
    def of(cls, kind: str, size: float, seed: int) -> "Target":
        """Put it elsewhere with each seed, so that the stripe lies elsewhere in its pixels."""
        random = np.random.default_rng([seed, round(size)])
        reach, middle, most = {
            "ball": (10, (0, 200, 900), 0),
            "pipe": (10, (0, 200, 900), 5),
            "step": (3, (0, 168, 880), 4),
        }[kind]
        at = random.uniform(-reach, reach, 3) + np.array(middle)
        return cls(kind, size, at, random.uniform(-most, most, 3).tolist())

    @property
    def truth(self) -> dict[str, float]:
        """Give what is measured of it [mm]."""
        if self.kind == "ball":
            return dict(zip(("x", "y", "z"), self.at.tolist(), strict=True)) | {"radius": self.size}
        return {"radius" if self.kind == "pipe" else "step": self.size}

    def as_table(self) -> dict[str, object]:
        """Write it as a scene file has it."""
        place = {"position_mm": self.at.tolist(), "rotation_deg": self.tilt}
        if self.kind == "ball":
            return {"mesh": "sphere", "radius_mm": self.size, "position_mm": self.at.tolist()}
        if self.kind == "pipe":
            return {"mesh": "cylinder", "radius_mm": self.size, "length_mm": 600.0} | place
        heights = [0.0, self.size]
        return {
            "mesh": "stairs",
            "heights_mm": heights,
            "width_mm": 300.0,
            "tread_mm": 30.0,
        } | place

    def measure(self, sample: Sample) -> Measurement:
        """Measure it as a user would, who knows about where it is."""
        points = sample.cloud.points
        if self.kind == "ball":
            x, y, z = (self.at + np.array([2.0, -3.0, 1.0])) / 1e3
            return measure_sphere(sample[Ball((x, y, z), (self.size + 8) / 1e3).contains(points)])
        if self.kind == "pipe":
            low, high = self.at - 100, self.at + np.array([100, 100, 0])
            return measure_cylinder(
                sample[Box(tuple(low / 1e3), tuple(high / 1e3)).contains(points)]
            )
        parts, half = [], np.array([90, 9, 12]) / 1e3
        for tread, up in ((15.0, 0.0), (45.0, self.size)):
            middle = self.at / 1e3 + np.array([0.0, tread, -up]) / 1e3
            parts.append(sample[Box(tuple(middle - half), tuple(middle + half)).contains(points)])
        return measure_step(*parts)


def build_scene(
    base: str, *, seed: int, objects: list[dict[str, object]], motion: dict[str, object]
) -> Scene:
    """Put other objects before a ready scene's rig, in its water, and move it otherwise."""
    text, label, folder = read_scene(base)
    document = tomlkit.parse(text)
    document.update({"seed": seed, "object": objects})
    document["motion"].update(motion)
    return parse_scene(tomlkit.dumps(document), label, folder)


def make_scene(target: Target, number: int, seed: int) -> Scene:
    """Film it from one side, in one of the passes, and the rows about the stripe only."""
    scene = build_scene(
        "sphere-c1.5",
        seed=PASSES * seed + number,
        objects=[target.as_table(), WALL | {"position_mm": [0.0, 0.0, BEHIND_MM[target.kind]]}],
        motion={
            "frames": PICTURES,
            "frame_rate_hz": RATE_HZ,
            "speed_mm_s": TRAVEL_MM / PICTURES * RATE_HZ,
            "start_mm": [ASIDE_MM * (2 * number - 1), START_MM + 1.3 * number, 0.0],
        },
    )
    camera = scene.rig.camera
    u = camera.principal_point[0] - (camera.size[0] - COLUMNS) / 2
    camera = replace(
        camera, size=(COLUMNS, camera.size[1]), principal_point=(u, camera.principal_point[1])
    )
    return crop(replace(scene, rig=replace(scene.rig, camera=camera)))


def crop(scene: Scene) -> Scene:
    """Keep the rows in which a stripe may lie, an even number of them from an even one on."""
    laser, camera = scene.rig.lasers[0], scene.rig.camera
    scan_lines = SheetScanLines(camera, laser, scene.index)
    parts, beam = [], Beam.of(laser, scene.light, scene.index)
    for number in np.linspace(0, len(scene) - 1, 5).astype(int)[1:4]:
        seen = beam, scan_lines, scene.surroundings.caster, scene.pose(int(number))
        parts.append(find_lit_line(*seen, cast_fan(*seen)).positions)
    rows = np.concatenate(parts)
    low = max(int(rows.min() - MARGIN) // 2 * 2, 0)
    high = min(int(rows.max() + MARGIN) // 2 * 2, camera.size[1])
    u, v = camera.principal_point
    camera = replace(camera, size=(camera.size[0], high - low), principal_point=(u, v - low))
    return replace(scene, rig=replace(scene.rig, camera=camera))


def scan_pass(recording: Path, extractor_name: str, out: Path) -> Project:
    """Scan a simulated recording up to its cloud, as the commands do."""
    rig, extractor = load_rig(recording / "rig.toml"), make_extractor(extractor_name, ())
    frames = open_recording(recording / "frames", fields="top-first")
    motion, method = PoseLog(load_poses(recording / "poses.csv")), RaySheet()
    project = Project(out)
    settings = {"extractor": extractor, "method": method, "motion": motion, "mesher": GridMesh()}
    with project.hold():
        begin_scan(project, frames, rig, settings=settings)
        extract_recording(project, frames, rig, extractor)
        triangulate_stripes(project, rig, method)
        follow_motion(project, motion)
        build_cloud(project, rig)
    return project


def film(target: Target, seed: int, out: Path) -> list[Path]:
    """Film all passes over it; gives their folders."""
    folders = [out / f"pass{number}" for number in range(PASSES)]
    for number, folder in enumerate(folders):
        simulate_recording(make_scene(target, number, seed), folder)
    return folders


def scan(scene: Scene, extractor_name: str, frames: list[Frame]) -> Sample:
    """Scan frames as the commands do, without their files."""
    extractor = make_extractor(extractor_name, ())
    background = extractor.learn(frames, scene.rig)
    stripes = list(extractor.extract(frames, scene.rig, background))
    profile = triangulate(Stripe.concatenate(stripes), scene.rig, RaySheet())
    cloud = remove_outliers(merge_profiles(profile, scene.trajectory, axes=("y",)))
    sight = look_back(cloud, scene.times[cloud.frame], scene.trajectory, scene.rig)
    return Sample.from_cloud(cloud, sight=sight)


def as_plain(found: Quantity, truth: float) -> dict[str, float]:
    """Put a measure beside the truth [mm]."""
    return {"error": 1e3 * found.value - truth, "half_width": 1e3 * found.half_width}
