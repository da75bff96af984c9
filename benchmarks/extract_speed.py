"""How many pictures a second `murkscan extract` gets through, and how long a whole scan takes."""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

from harness import Figure, tell

from murkscan import Murk
from murkscan.capture import open_recording
from murkscan.io.rig_toml import load_rig
from murkscan.simulate import Recorder, load_scene
from murkscan.survey.simulate import simulate_recording

NOTE = """
The command as a user runs it, from the first import to the last file, on two cores: reading and
decoding, learning the recording, finding the stripe, drawing a dozen overlays. The hull in water of
3 /m, with glow, particles and noise; PAL as H.264 of 760 fields, 1920 × 1200 as 120 PNG pictures,
of which learning, which looks at 48 of them however many there are, is the larger part, and as the
same pictures four times over. A whole scan of the PAL fields is `murkscan scan`, with its surface,
nine pictures, the page to turn it on and the report. The loops have been compiled before. Beside
each, the same by gray gravity, which learns next to nothing: what is left is start, reading and
writing. The processor's time is that of all cores; where others use them, it says more than the
time that passes.
"""
TIMES = 4
"""How often the same pictures come in the longer recording."""
ALONE = 100
"""Frames by which finding alone is timed."""


@dataclass(frozen=True)
class Run:
    """What one run of the command takes."""

    passed: float
    """Time that passes [s]."""
    spent: float
    """The processor's time [s]."""
    resident: float
    """The most that it holds [MB]."""


def record(name: str, out: Path, *, codec: str | None, pictures: int) -> Path:
    """Simulate the middle of a scene as a recording; give where its pictures are."""
    scene = load_scene(name)
    wanted = pictures * scene.row_step
    first = (len(scene) - wanted) // 2
    times = scene.times[first : first + wanted]
    recorder = Recorder(codec) if codec else scene.recorder
    simulate_recording(replace(scene, times=times, recorder=recorder), out)
    return out / "recording.mkv" if codec else out / "frames"


def repeat(frames: Path, out: Path) -> Path:
    """Make a longer recording of the same pictures; give where they are."""
    folder = out / "frames"
    folder.mkdir(parents=True)
    pictures = sorted(frames.glob("*.png"))
    for number in range(TIMES * len(pictures)):
        (folder / f"{number:06d}.png").symlink_to(pictures[number % len(pictures)])
    (out / "rig.toml").write_text((frames.parent / "rig.toml").read_text("utf-8"), "utf-8")
    return folder


def extract(recording: Path, out: Path, extractor: str) -> Run:
    """Run `murkscan extract`."""
    rig = recording.parent / "rig.toml"
    return run("extract", recording, "--rig", rig, "--out", out, "--extractor", extractor)


def scan(recording: Path, out: Path) -> Run:
    """Run `murkscan scan`: from the first import to the page on how it went."""
    rig, poses = (recording.parent / name for name in ("rig.toml", "poses.csv"))
    return run("scan", recording, "--rig", rig, "--poses", poses, "--out", out)


def run(*words: str | Path) -> Run:
    """Run a command."""
    command = [sys.executable, "-m", "murkscan", *map(str, words)]
    since, before, peak = time.perf_counter(), os.times(), 0.0
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None:
            peak = max(peak, resident(process.pid))
            time.sleep(0.05)
    assert process.returncode == 0
    passed, after = time.perf_counter() - since, os.times()
    spent = sum(after[2:4]) - sum(before[2:4])
    return Run(passed, spent, peak)


def extract_alone(path: Path) -> float:
    """Find the stripe in frames that have been read; give how many a second of one core."""
    recording, rig, murk = open_recording(path), load_rig(path.parent / "rig.toml"), Murk()
    background = murk.learn(recording.sample(24), rig)
    frames = list(islice(recording.frames(), ALONE))
    list(murk.extract(frames[:8], rig, background))
    since = time.process_time()
    list(murk.extract(frames, rig, background))
    return len(frames) / (time.process_time() - since)


def resident(pid: int) -> float:
    """Give the most that a process has held so far [MB]; nothing where it is gone."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0.0
    return max(
        (int(line.split()[1]) / 1e3 for line in lines if line.startswith("VmHWM")), default=0
    )


def main() -> None:
    figures = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        field = record("hull-c3", folder / "pal", codec="h264", pictures=380)
        large = record("hull-c3-hd", folder / "hd", codec=None, pictures=120)
        long = repeat(large, folder / "hd-long")
        for name, recording, each, least in (
            ("PAL pictures of two fields", field, 2, 50),
            ("1920 × 1200", large, 1, 30),
        ):
            rate = extract_alone(recording) / each
            figures.append(Figure(f"{name}: finding alone, a core", rate, "/s", at_least=least))
        scan(field, field.parent / "first-scan")
        whole = scan(field, field.parent / "scan")
        figures += [
            Figure("760 PAL fields of H.264: a whole scan", whole.passed, "s", at_most=20),
            Figure("760 PAL fields of H.264: its processor's time", whole.spent, "s"),
            Figure("760 PAL fields of H.264: its resident", whole.resident, "MB"),
        ]
        for name, recording, count, rate, most in (
            ("PAL fields of H.264", field, 760, 100, None),
            ("1920 × 1200 PNG", large, 120, 24, 700),
            (f"1920 × 1200 PNG, {TIMES} times as long", long, TIMES * 120, 24, 700),
        ):
            out = recording.parent
            if recording != long:
                extract(recording, out / "first", "murk")
            murk = extract(recording, out / "murk", "murk")
            gray = extract(recording, out / "gray", "gray-gravity")
            figures += [
                Figure(f"{name}: by murk", count / murk.passed, "/s", at_least=rate),
                Figure(f"{name}: by gray gravity", count / gray.passed, "/s"),
                Figure(
                    f"{name}: time of murk over that of gray gravity", murk.passed / gray.passed
                ),
                Figure(f"{name}: the processor's time by murk", 1e3 * murk.spent / count, "ms"),
                Figure(f"{name}: resident", murk.resident, "MB", at_most=most),
            ]
    tell("extract_speed", "Speed and memory of extracting", figures, note=NOTE)


if __name__ == "__main__":
    main()
