"""Two scans side by side in murky water, from frames to one hull: rigid bodies, and adjusted.

Run: python benchmarks/two_scans.py [--work FOLDER] [--seeds N] [--frames N] [--attenuation C]

What is there already in the folder is not made again.
"""

import argparse
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import Figure, tell
from trajectory import fit_rigid
from trajectory_scene import LOGS, SPEED, WAVES

import murkscan as ms
from murkscan.motion.navigated import follow_navigation
from murkscan.optics.medium import Medium
from murkscan.simulate import load_scene
from murkscan.simulate.instruments import Instruments
from murkscan.simulate.vehicle import drive
from murkscan.survey.cloud import build_cloud
from murkscan.survey.extract import extract_recording
from murkscan.survey.merge import merge_passes
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.simulate import simulate_recording
from murkscan.survey.triangulate import triangulate_stripes
from murkscan.types.pose import Pose

ASIDE = (-0.12, 0.12)
"""Where the passes go, across the plate [m]; a line is about 0.5 m wide."""
LATE = 0.01
"""How late the logs are stamped [s]."""
START = np.array([8e-3, -6e-3, 4e-3])
"""By what it is off where the second one begins, as a user tells it [m]."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", type=Path, default=Path("two-scans-work"))
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--attenuation", type=float, default=1.5)
    given = parser.parse_args()
    found = [run(given, seed) for seed in range(given.seeds)]
    figures = []
    for way in ("rigid", "adjusted"):
        for number, kind in enumerate(("surface", "place")):
            sizes = [one[way][number] for one in found]
            name = f"{way}: {kind}, worst of {given.seeds} (median {np.median(sizes):.2f})"
            figures.append(Figure(name, max(sizes), "mm"))
    share = max(one["adjusted"][0] / one["rigid"][0] for one in found)
    figures.append(Figure("surface, as a share of that rigid, worst", share, "", 1.0))
    clocks = np.concatenate([one["clocks"] for one in found])
    figures.append(Figure("clock, worst", float(np.abs(clocks[:, 0]).max()), "ms", 5))
    pulls = clocks[:, 0] / clocks[:, 1]
    figures += [
        Figure("clock: error / σ, RMS", float(np.sqrt(np.mean(pulls**2))), ""),
        Figure("clock: within 95 %", 100 * float(np.mean(np.abs(pulls) < 1.96)), "%"),
    ]
    note = NOTE.format(frames=given.frames, c=given.attenuation, late=1e3 * LATE)
    tell("two_scans", "Two scans side by side, from frames to one hull", figures, note=note)


def run(given, seed):
    """Make two scans, merge them both ways, and compare with the truth."""
    work = given.work / str(seed)
    scenes = [make_scene(given, seed, number) for number in range(2)]
    for number, scene in enumerate(scenes):
        scan(scene, work / f"dive{number}", work / f"scan{number}")
    begin = [scene.trajectory.at(np.zeros(1)).positions[0] for scene in scenes]
    start = Pose(np.eye(3), begin[1] - begin[0] + START)
    found = {}
    for name, adjust in (("rigid", False), ("adjusted", True)):
        out = work / name
        shutil.rmtree(out, ignore_errors=True)
        paths = [work / "scan0", work / "scan1"]
        result = merge_passes(paths, out, adjust=adjust, starts=[start])
        found[name] = judge(ms.Project(out), result, scenes)
        if adjust:
            assert result.is_joint, result.remarks
            found["clocks"] = [read_clock(one.correction) for one in result.passes]
    print(seed, found, flush=True)
    return found


def make_scene(given, seed, number):
    """Take the plate and the camera of `two-lasers`, with one laser and a way of its own."""
    scene = load_scene("two-lasers")
    times = scene.times[: given.frames]
    begin, speed = np.array([ASIDE[number], 0, 0]), np.array([0, SPEED, 0])
    way = drive(WAVES, speed, begin, float(times[-1]), seed=100 + 10 * seed + number)
    accuracy = replace(LOGS["a"], position_noise=None)
    return replace(
        scene, times=times, medium=Medium(given.attenuation, 0.8), trajectory=way,
        rig=replace(scene.rig, lasers=scene.rig.lasers[:1]),
        navigation=Instruments("dvl", 10.0, LATE, accuracy), seed=10 * seed + number,
    )  # fmt: skip


def scan(scene, dive, out):
    """Simulate a dive and scan it, as far as that is not done."""
    simulate_recording(scene, dive)
    rig, recording = ms.load_rig(dive / "rig.toml"), ms.open_recording(dive / "frames")
    project = ms.Project(out)
    begin_scan(project, recording, rig, settings={})
    extract_recording(project, recording, rig, ms.Murk())
    triangulate_stripes(project, rig, ms.RaySheet())
    motion, _ = follow_navigation(dive / "navigation.csv", rig, speed=None, along="y")
    follow_motion(project, motion, adjust=True)
    build_cloud(project, rig, rules=(), frames=False)


def judge(project, result, scenes):
    """Give how far points lie from where they are, across the plate and in all: RMS in mm."""
    cloud = project.load_cloud()
    own = project.load_trajectory().to_camera(cloud.points, cloud.frame.astype(float))
    there = np.empty_like(cloud.points)
    for one, scene in zip(result.passes, scenes, strict=True):
        mine = (cloud.frame >= one.frames[0]) & (cloud.frame <= one.frames[1])
        frames = cloud.frame[mine] - one.frames[0] + one.first_frame
        there[mine] = scene.trajectory.transform(own[mine], scene.times[frames])
    off = fit_rigid(cloud.points, there) - there
    return [1e3 * float(np.sqrt(np.mean(np.sum(part**2, axis=1)))) for part in (off[:, 2:], off)]


def read_clock(words):
    """Read from what is told of a pass by how much its clock was found off, and σ [ms]."""
    told = next(one for one in words if "clock" in one).split()
    value, sigma = (float(told[told.index("±") + step]) for step in (-1, 1))
    ahead = 1 if "ahead" in told else -1
    return 1e3 * (ahead * value - LATE), 1e3 * sigma


NOTE = """\
The plate and the camera of the scene `two-lasers` with one laser, {frames} frames at 25 a second
and c = {c:g} /m: two passes of a metre, 0.24 m beside one another, each with motion of its own as
waves have it, up to 1 Hz. The log has velocities (3 mm/s noise, 1 mm/s bias), attitude (0.1° noise,
0.2° bias), heading drifting by 0.5°/min and depth (5 mm), stamped {late:g} ms late, and nothing is
known of its clock. Where the second pass begins is told 11 mm off. Each is found by Murk and
scanned, then both are merged as `murkscan merge` does, with and without `--rigid`. Errors: RMS of
the cloud's points against the same points by the true poses, after one rigid alignment of all. What
limits it: a bend along both passes alike, which one sheet cannot tell and the log has.
"""


if __name__ == "__main__":
    main()
