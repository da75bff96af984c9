"""Whether a second worker halves the time of extracting, and whether it changes a byte."""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from extract_speed import record
from harness import Figure, tell

CHAPTERS, PICTURES = (2, 5), 334
"""A short recording and a long one, which has 2004 fields more."""
BARS = {"threads": 1.8, "processes": 1.8, "dask": 1.7}
LEARNT = "extract/background.json"
NOTE = """
PAL fields of H.264 in water of 3 /m: one simulated recording given several times, as chapters. A
worker is a core: the whole command, decoder included, is bound to one core, then to two. Counted is
how much longer five chapters take than two, from the moment that what was learnt is kept: 2004
fields, without what starting and ending cost. *One worker* is `--executor serial` on one core. The
least of two runs each. *With starting* is the same ratio of all that comes after learning in five
chapters, the start of processes or of the cluster's workers, and the command's end, among it. *Two
commands at once* is what the machine has to give: two times one worker, each on a core of its own.
"""


class Extract:
    """The command while it runs, bound to some cores."""

    def __init__(self, given: list[Path | str], out: Path, executor: str, cores: set[int]) -> None:
        shutil.rmtree(out, ignore_errors=True)
        words = ["extract", *given, "--out", out, "--executor", executor]
        if executor != "serial":
            words += ["--workers", len(cores)]
        self._out, before = out, os.sched_getaffinity(0)
        os.sched_setaffinity(0, cores)
        try:
            command = [sys.executable, "-m", "murkscan", *map(str, words)]
            self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        finally:
            os.sched_setaffinity(0, before)

    def wait(self) -> float:
        """Give the time from the end of learning to the command's end [s]."""
        learnt = 0.0
        while self._process.poll() is None:
            if not learnt and (self._out / LEARNT).exists():
                learnt = time.perf_counter()
            time.sleep(0.02)
        assert self._process.returncode == 0
        assert learnt, "too quick to see what was learnt"
        return time.perf_counter() - learnt


def digest(out: Path) -> str:
    """Give one number for all stripes."""
    parts = sorted((out / "extract").glob("**/*.parquet"))
    assert parts
    return hashlib.blake2b(b"".join(part.read_bytes() for part in parts)).hexdigest()


def main() -> None:
    cores = sorted(os.sched_getaffinity(0))[:2]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        one = record("hull-c3", folder / "sea", codec="h264", pictures=PICTURES)
        chapters = [folder / f"dive{i}.mkv" for i in range(max(CHAPTERS))]
        for chapter in chapters:
            shutil.copyfile(one, chapter)

        def words(count: int) -> list[Path | str]:
            return [*chapters[:count], "--rig", one.parent / "rig.toml"]

        def take(executor: str, cores: list[int]) -> tuple[float, float]:
            """Time the short and the long recording."""
            short, long = (
                min(Extract(words(n), folder / executor, executor, set(cores)).wait() for _ in "ab")
                for n in CHAPTERS
            )
            return short, long

        short, long = take("serial", cores[:1])
        same, alone = digest(folder / "serial"), long - short
        both = [Extract(words(CHAPTERS[1]), folder / f"{n}", "serial", {n}) for n in cores]
        with ThreadPoolExecutor() as watchers:
            given = 2 * long / max(watchers.map(Extract.wait, both))
        figures = [
            Figure("one worker, 2004 fields", alone, "s"),
            Figure("two commands at once, over one after the other", given),
        ]
        for executor, bar in BARS.items():
            less, more = take(executor, cores)
            other = float(digest(folder / executor) != same)
            figures += [
                Figure(f"{executor}: one worker over two", alone / (more - less), at_least=bar),
                Figure(f"{executor}: one worker over two, with starting", long / more),
                Figure(f"{executor}: recordings with other bytes", other, at_most=0),
            ]
    tell("workers", "Two workers against one", figures, note=NOTE)


if __name__ == "__main__":
    main()
