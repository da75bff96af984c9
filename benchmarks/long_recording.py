"""Memory and time of a scan as its recording grows to 100 000 frames."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import av
import numpy as np
from extract_speed import resident
from harness import Figure, tell
from seek import repeat

SIZE, RATE, LOOP = (720, 96), 25, 1000
COUNTS = 10_000, 100_000
MOST = 700.0
STAGES = (
    ("extract", ()),
    ("triangulate", ()),
    ("motion", ("--speed-mm-s", "100")),
    ("cloud", ()),
)
RIG = """
format = 1
[camera]
size = [720, 96]
focal_length = [554.0, 554.0]
principal_point = [359.5, 47.5]
distortion = [0, 0, 0, 0, 0]
[[laser]]
kind = "baseline_angle"
baseline_mm = 250
angle_deg = 63.4
axis = "y"
"""
NOTE = """
Pictures of 720 × 96 px as H.264, 1000 frames with a bright stripe that moves and one grey level of
noise, repeated to 10 000 and to 100 000 frames; `extract` by gray gravity, `triangulate`, `motion`
and `cloud` as a user runs them. Resident is the most that a stage's process held; time is the whole
command's. Ten times the frames should take ten times as long and no more memory.
"""


def encode(path: Path) -> None:
    """Write the frames that are repeated."""
    random = np.random.default_rng(0)
    columns = np.arange(SIZE[0])
    rows = np.arange(SIZE[1])[:, None]
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=RATE)
        stream.width, stream.height, stream.pix_fmt = *SIZE, "yuv420p"
        stream.codec_context.options = {"preset": "veryfast", "bf": "2", "g": "250", "crf": "18"}
        for number in range(LOOP):
            middle = 48 + 15 * np.sin(columns / 90 + number / 40)
            picture = 20 + 180 * np.exp(-0.5 * ((rows - middle) / 2.0) ** 2)
            picture = np.clip(picture + random.standard_normal(picture.shape), 0, 255)
            frame = av.VideoFrame.from_ndarray(picture.astype(np.uint8), "gray")
            container.mux(stream.encode(frame.reformat(format="yuv420p")))
        container.mux(stream.encode())


def run(words: list[str]) -> tuple[float, float]:
    """Give a command's time [s] and the most that it held [MB]."""
    since, held = time.perf_counter(), 0.0
    with subprocess.Popen(
        [sys.executable, "-m", "murkscan", *words], stdout=subprocess.DEVNULL
    ) as process:
        while process.poll() is None:
            held = max(held, resident(process.pid))
            time.sleep(0.05)
    assert process.returncode == 0, words
    return time.perf_counter() - since, held


def measure(folder: Path, loop: Path, rig: Path, count: int) -> dict[str, tuple[float, float]]:
    """Run every stage over so many frames."""
    recording, out = folder / f"{count}.mkv", folder / f"out{count}"
    repeat(loop, recording, frames=LOOP, turns=count // LOOP)
    source = [str(recording), "--rig", str(rig), "--extractor", "gray-gravity"]
    taken = {}
    for stage, more in STAGES:
        words = [*source, "--out", str(out)] if stage == "extract" else [str(out), *more]
        taken[stage] = run([stage, *words])
    return taken


def main() -> None:
    figures = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        loop, rig = folder / "loop.mp4", folder / "rig.toml"
        encode(loop)
        rig.write_text(RIG)
        few, many = (measure(folder, loop, rig, count) for count in COUNTS)
    for stage, _ in STAGES:
        times = COUNTS[1] / COUNTS[0]
        figures += [
            Figure(f"{stage}: resident at {COUNTS[1]} frames", many[stage][1], "MB", at_most=MOST),
            Figure(f"{stage}: over that at {COUNTS[0]}", many[stage][1] / few[stage][1]),
            Figure(f"{stage}: time at {COUNTS[1]} frames", many[stage][0], "s"),
            Figure(f"{stage}: over {times:g} times that", many[stage][0] / few[stage][0] / times),
        ]
    tell("long_recording", "A recording of 100 000 frames", figures, note=NOTE)


if __name__ == "__main__":
    main()
