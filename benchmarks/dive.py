"""Whether a dive gives one cloud whatever file it comes in, and what its recorder's flaws cost.

Run: python benchmarks/dive.py [--work FOLDER] [--gigabytes 0.2,2,10]
"""

import argparse
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from dive_files import (
    BEGIN,
    Dive,
    Flaws,
    encode_h264,
    write_blueos,
    write_csv,
    write_mp4,
    write_ros1,
    write_ros2,
    write_tlog,
)
from harness import Figure, tell

from murkscan.capture import open_recording
from murkscan.cli.main import run
from murkscan.io.rig_toml import save_rig
from murkscan.project import Project
from murkscan.simulate import Simulator, drive, load_scene
from murkscan.simulate.vehicle import Unrest

PICTURES, RATE, SPEED = 200, 25.0, 0.1
START = (0.0, 0.45, 0.0)
"""Where the camera is at the beginning: under the hull's middle [m]."""
UNREST = Unrest(sway=0.004, heave=0.004, attitude=np.radians(0.4), period=4.0)
BAR = 0.1
"""Largest difference of a point between two kinds of files [mm]."""
FINDER = ("--extractor", "gray-gravity")
"""The quickest: the files are compared, not the finders."""
FILLER = 60_000
"""Bytes that each picture is padded with in large files, as 1080p at 12 Mbit/s has [bytes]."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", type=Path, default=Path("dive-work"))
    parser.add_argument("--gigabytes", default="0.2,2")
    given = parser.parse_args()
    shutil.rmtree(given.work, ignore_errors=True)
    given.work.mkdir(parents=True)
    dive, rig, way = make_dive()
    save_rig(given.work / "rig.toml", rig)
    figures = compare_kinds(given.work, dive)
    figures += compare_flaws(given.work, dive, way)
    sizes = [float(size) for size in given.gigabytes.split(",")]
    figures += measure_memory(given.work, dive, sizes)
    note = NOTE.replace("SIZES", given.gigabytes)
    tell("dive", "A dive in the files that vehicles write", figures, note=note)
    shutil.rmtree(given.work)


NOTE = f"""
A simulated dive of {PICTURES} PAL pictures in H.264, over a hull in clear water, from a vehicle
that sways, heaves and turns; a log at 10 Hz. Each kind of file is written by its format's own
library and goes through `murkscan extract --extractor gray-gravity`, `triangulate` and `motion`.

- *kinds*: pictures and places by one clock; the largest distance of a point from the same point of
  the scan of MP4 with a log in CSV. ROS 1 holds the decoded pictures, raw.
- *flaws*: attitude and depth, no place; stamps of arrival with 40 ms of jitter, pictures 300 ms
  late, a clock put back by 1 s, chunks of 20 kB, cut off at 60 % of the file; `--speed-mm-s`. RMS
  distance from the same points by poses at 50 Hz, after one rigid alignment. The delay is not found
  by itself, so it is given by `--time-offset-s` in two of the rows. One laser; nothing is adjusted.
- *memory*: the largest resident set of a process beyond that of one which only imports the same;
  listing a whole file, and reading a hundred pictures at its end and 48 spread over it. Times are
  of a machine with two cores that was busy with other work, and vary by a factor of three. Sizes
  are those of `--gigabytes SIZES`.
"""


def make_dive():
    """Simulate the dive: packets, the vehicle's way, and the rig."""
    scene = load_scene("hull")
    times = np.arange(PICTURES) / RATE
    velocity = np.array([0.0, SPEED, 0.0])
    way = drive(UNREST, velocity, np.array(START), PICTURES / RATE, seed=1)
    sensor = replace(scene.sensor, interlaced=False)
    scene = replace(scene, trajectory=way, times=times, sensor=sensor)
    simulator = Simulator.of(scene)
    pictures = [simulator.draw_frame(k).frame.image for k in range(PICTURES)]
    packets = encode_h264(pictures, RATE)
    logged = way.at(np.arange(-1.0, PICTURES / RATE + 1.0, 0.1))
    return Dive(packets, times, logged), scene.rig, way


def scan(work: Path, name: str, recording: str, *words: str):
    """Give the points of a scan: their names (frame, scan line), and places in the world."""
    out = str(work / "scans" / name.replace(" ", "-").replace(",", ""))
    run_all(
        ["extract", recording, "--rig", str(work / "rig.toml"), "--out", out, *FINDER],
        ["triangulate", out],
        ["motion", out, *words],
    )
    project = Project(Path(out))
    trajectory = project.load_trajectory()
    names, places = [], []
    for profile in project.load_profile_parts():
        profile = profile[trajectory.has(profile.time)]
        names.append(np.column_stack([profile.frame, np.rint(profile.pixels[:, 0])]))
        places.append(trajectory.transform(profile.points, profile.time))
    return np.concatenate(names).astype(int), np.concatenate(places)


def run_all(*commands) -> None:
    for words in commands:
        if run(words):
            sys.exit(f"{' '.join(words)} failed")


def compare_kinds(work: Path, dive: Dive) -> list[Figure]:
    write_blueos(work / "cdr.mcap", dive)
    write_blueos(work / "json.mcap", dive, json_video=True)
    write_ros2(work / "sqlite", dive, "sqlite3")
    write_ros2(work / "ros2mcap", dive, "mcap")
    decoded = [frame.image for frame in open_recording(work / "cdr.mcap").frames()]
    write_ros1(work / "ros1.bag", dive, decoded)
    write_mp4(work / "dive.mp4", dive, RATE)
    write_tlog(work / "dive.tlog", dive)
    write_csv(work / "dive.csv", dive)
    start = ("--start-time", f"{BEGIN:.1f}")
    video = str(work / "dive.mp4")
    truth = scan(work, "csv", video, "--navigation", str(work / "dive.csv"), *start)
    kinds = {
        "MCAP of BlueOS, video as CDR": [str(work / "cdr.mcap")],
        "MCAP of BlueOS, video as JSON": [str(work / "json.mcap")],
        "ROS 2, sqlite3": [str(work / "sqlite")],
        "ROS 2, MCAP": [str(work / "ros2mcap")],
        "ROS 1, raw pictures": [str(work / "ros1.bag")],
        "MP4 and .tlog": [video, "--navigation", str(work / "dive.tlog"), *start],
    }
    figures = [Figure("kinds: points compared", float(len(truth[0])))]
    for name, words in kinds.items():
        _, one, other = match(scan(work, name, *words), truth)
        far = float(np.linalg.norm(one - other, axis=1).max()) * 1e3
        missing = 1 - len(one) / len(match(truth, truth)[0])
        figures.append(Figure(f"kinds: {name}: farthest point", far, "mm", at_most=BAR))
        figures.append(Figure(f"kinds: {name}: points missing", 100 * missing, "%", at_most=0.01))
    return figures


def match(a, b):
    """Give the places of the points that two scans have in common."""
    keys = [names[:, 0] * 100_000 + names[:, 1] for names, _ in (a, b)]
    common, i, j = np.intersect1d(*keys, return_indices=True)
    return common, a[1][i], b[1][j]


def compare_flaws(work: Path, dive: Dive, way) -> list[Figure]:
    flaws = Flaws(jitter=0.04, delay=0.3, step_at=2.0, step=-1.0, cut=0.6)
    write_blueos(work / "flaws.mcap", dive, flaws=flaws, position=False, chunk_size=20_000)
    run(["dive", str(work / "flaws.mcap")])
    recording = open_recording(work / "flaws.mcap")
    kept = sum(1 for _ in recording.frames())
    exact = work / "exact.csv"
    write_csv(exact, replace(dive, way=way.at(np.arange(-1.0, PICTURES / RATE + 1.0, 0.02))))
    start = ("--start-time", f"{BEGIN:.1f}")
    truth = scan(work, "exact", str(work / "dive.mp4"), "--navigation", str(exact), *start)
    figures = [Figure("flaws: pictures read of 200", float(kept))]
    rows = {
        "true speed": ["--speed-mm-s", "100"],
        "true speed, delay given": ["--speed-mm-s", "100", "--time-offset-s", "-0.3"],
        "speed 10 % too high, delay given": ["--speed-mm-s", "110", "--time-offset-s", "-0.3"],
    }
    for name, words in rows.items():
        found = scan(
            work, name.replace(" ", "-").replace(",", ""), str(work / "flaws.mcap"), *words
        )
        _, one, other = match(found, truth)
        figures.append(Figure(f"flaws: {name}: RMS", rms_after_alignment(one, other) * 1e3, "mm"))
    status = run(["scan", str(work / "flaws.mcap"), "--rig", str(work / "rig.toml"),
                  "--out", str(work / "scans" / "refused")])  # fmt: skip
    figures.append(Figure("flaws: exit status without a speed", status, at_least=2, at_most=2))
    return figures


def rms_after_alignment(points, truth) -> float:
    """Give the RMS distance after the best rigid motion (Kabsch 1976)."""
    a, b = points - points.mean(axis=0), truth - truth.mean(axis=0)
    u, _, vt = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt
    return float(np.sqrt(np.mean(np.sum((a @ turn - b) ** 2, axis=1))))


_LIST = "from murkscan.cli.main import run; run(['dive', sys.argv[1]])"
_READ = """
from itertools import islice
from murkscan.capture import open_recording
recording = open_recording(sys.argv[1])
for frame in islice(recording.frames(recording.num_frames - 100), 100): pass
recording.sample(48)
"""
_NOTHING = "import murkscan.io.dive.gather, murkscan.capture, murkscan.cli.main"
_PEAK = "import sys\n{}\nprint(open('/proc/self/status').read().split('VmHWM:')[1].split()[0])"
"""A process' own largest resident set [kB]; what wait4 tells counts that of who began it, too."""


def measure_memory(work: Path, dive: Dive, sizes: list[float]) -> list[Figure]:
    random = np.random.default_rng(0)
    # A unit of type 12 is filler (H.264, 7.3.2.7); random bytes do not compress.
    padded = replace(
        dive,
        packets=[
            packet + b"\0\0\1\x0c" + random.integers(1, 255, FILLER, np.uint8).tobytes()
            for packet in dive.packets
        ],
    )
    each = sum(map(len, padded.packets)) / 1e9
    figures = []
    for size in sizes:
        path = work / "large.mcap"
        write_blueos(path, padded, repeats=max(round(size / each), 1))
        real = path.stat().st_size / 1e9
        for name, code in (("listing", _LIST), ("reading", _READ)):
            memory, seconds = peak(code, path)
            idle, _ = peak(_NOTHING, path)
            label = f"{name} {real:.1f} GB"
            figures.append(Figure(f"memory: {label}", memory - idle, "MB", at_most=600))
            figures.append(Figure(f"time: {label}", seconds, "s"))
        path.unlink()
    return figures


def peak(code: str, path: Path) -> tuple[float, float]:
    """Run some code in a process of its own: largest resident set [MB], and time [s]."""
    began = time.perf_counter()
    words = [sys.executable, "-c", _PEAK.format(code), str(path)]
    said = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True).stdout
    return int(said.splitlines()[-1]) / 1e3, time.perf_counter() - began


if __name__ == "__main__":
    main()
