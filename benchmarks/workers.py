"""Whether a second worker halves the time of extracting, and whether it changes a byte."""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from extract_speed import record
from harness import Figure, tell

CHAPTERS, PICTURES = 3, 334
"""2004 fields in all."""
BARS = {"threads": 1.8, "processes": 1.8, "dask": 1.7}
LEARNT = "extract/background.json"
NOTE = """
2004 PAL fields of H.264 in water of 3 /m: one simulated recording given thrice, as chapters. A
worker is a core: the whole command, decoder included, is bound to one core, then to two. Counted is
what comes after learning: from the moment that what was learnt is kept to the command's end, with
the start of processes or of the cluster's workers. *One worker* is `--executor serial` on one core.
The least of two runs each.
"""


def run(chapters: list[Path], rig: Path, out: Path, executor: str, cores: int) -> float:
    """Give the time from the end of learning to the command's end [s]."""
    shutil.rmtree(out, ignore_errors=True)
    words = ["extract", *chapters, "--rig", rig, "--out", out, "--executor", executor]
    if executor != "serial":
        words += ["--workers", cores]
    command = [sys.executable, "-m", "murkscan", *map(str, words)]
    bound = set(sorted(os.sched_getaffinity(0))[:cores])
    before, learnt = os.sched_getaffinity(0), 0.0
    os.sched_setaffinity(0, bound)
    try:
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
            while process.poll() is None:
                if not learnt and (out / LEARNT).exists():
                    learnt = time.perf_counter()
                time.sleep(0.02)
    finally:
        os.sched_setaffinity(0, before)
    assert process.returncode == 0
    assert learnt, "too quick to see what was learnt"
    return time.perf_counter() - learnt


def digest(out: Path) -> str:
    """Give one number for all stripes."""
    parts = sorted((out / "extract").glob("**/*.parquet"))
    assert parts
    return hashlib.blake2b(b"".join(part.read_bytes() for part in parts)).hexdigest()


def main() -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        one = record("hull-c3", folder / "sea", codec="h264", pictures=PICTURES)
        rig, chapters = one.parent / "rig.toml", [folder / f"dive{i}.mkv" for i in range(CHAPTERS)]
        for chapter in chapters:
            shutil.copyfile(one, chapter)
        alone = min(run(chapters, rig, folder / "one", "serial", 1) for _ in range(2))
        same, figures = digest(folder / "one"), [Figure("one worker", alone, "s")]
        for executor, bar in BARS.items():
            taken = min(run(chapters, rig, folder / executor, executor, 2) for _ in range(2))
            other = float(digest(folder / executor) != same)
            figures += [
                Figure(f"{executor}: one worker over two", alone / taken, at_least=bar),
                Figure(f"{executor}: recordings with other bytes", other, at_most=0),
            ]
    tell("workers", "Two workers against one", figures, note=NOTE)


if __name__ == "__main__":
    main()
