"""How many pictures a second `murkscan extract` gets through, and the memory that it holds."""

import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from harness import Figure, tell

from murkscan.simulate import Recorder, load_scene
from murkscan.survey.simulate import simulate_recording

NOTE = """
The command as a user runs it, from the first import to the last file, on two cores: reading and
decoding, learning the recording, finding the stripe, drawing a dozen overlays. The hull in water of
3 /m, with glow, particles and noise; PAL as H.264 of 760 fields, 1920 × 1200 as 120 PNG pictures,
of which learning, which looks at 48 of them however many there are, is the larger part. The loops
have been compiled before. Beside each, the same by gray gravity, which learns next to nothing: what
is left is start, reading and writing.
"""


def record(name: str, out: Path, *, codec: str | None, pictures: int) -> Path:
    """Simulate the middle of a scene as a recording; give where its pictures are."""
    scene = load_scene(name)
    wanted = pictures * scene.row_step
    first = (len(scene) - wanted) // 2
    times = scene.times[first : first + wanted]
    recorder = Recorder(codec) if codec else scene.recorder
    simulate_recording(replace(scene, times=times, recorder=recorder), out)
    return out / "recording.mkv" if codec else out / "frames"


def run(recording: Path, out: Path, extractor: str) -> tuple[float, float]:
    """Give how long the command takes [s], and the most that it holds [MB]."""
    rig = recording.parent / "rig.toml"
    words = ["extract", recording, "--rig", rig, "--out", out, "--extractor", extractor]
    command = [sys.executable, "-m", "murkscan", *map(str, words)]
    since, peak = time.perf_counter(), 0.0
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None:
            peak = max(peak, resident(process.pid))
            time.sleep(0.05)
    assert process.returncode == 0
    return time.perf_counter() - since, peak


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
        for name, scene, codec, pictures, fields, rate, most in (
            ("PAL fields of H.264", "hull-c3", "h264", 380, 2, 100, None),
            ("1920 × 1200 PNG", "hull-c3-hd", None, 120, 1, 24, 700),
        ):
            recording = record(scene, folder / scene, codec=codec, pictures=pictures)
            run(recording, folder / f"{scene}-first", "murk")
            murk, held = run(recording, folder / f"{scene}-murk", "murk")
            gray, _ = run(recording, folder / f"{scene}-gray", "gray-gravity")
            count = fields * pictures
            figures += [
                Figure(f"{name}: by murk", count / murk, "/s", at_least=rate),
                Figure(f"{name}: by gray gravity", count / gray, "/s"),
                Figure(f"{name}: time of murk over that of gray gravity", murk / gray),
                Figure(f"{name}: resident", held, "MB", at_most=most),
            ]
    tell("extract_speed", "Speed and memory of extracting", figures, note=NOTE)


if __name__ == "__main__":
    main()
