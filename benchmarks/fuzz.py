"""Read 20 000 damaged files with every reader: nothing may crash, hang or eat the machine.

`python benchmarks/fuzz.py [MUTANTS [FOLDER]]`; what is done in FOLDER is not done again.
"""

import json
import queue
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from pathlib import Path

from harness import Figure, tell

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
from tests.mutants import make_seeds, seeds_of  # noqa: E402

BATCH = 500
"""Mutants a process reads: its memory is then looked at from the start again."""
LONGEST = 20.0
"""Seconds after which a reader hangs."""
NOTE = """
Small sound files of every kind that murkscan reads (videos, folders of pictures, clouds, meshes,
rigs, scenes, logs of poses, and all that a scan leaves in its folder: JSON, Parquet, CSV, PLY),
each changed at random in one to four ways: bytes turned over, cut, dropped, repeated; numbers
replaced by odd ones, in binary and in text; lines repeated, dropped and exchanged. Each is read as
a command would. A crash is a traceback, or the death of a process; memory is the peak of a process
that has the whole program in it.
"""


def read_batch(folder: Path, numbers: range, done: dict[int, dict]) -> None:
    """Read the mutants of a batch that are not done, in as many processes as die or hang."""
    left = [number for number in numbers if number not in done]
    while left:
        command = [
            sys.executable,
            "-m",
            "tests.mutants",
            str(folder),
            str(left[0]),
            str(left[-1] + 1),
        ]
        process = subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        for line in follow(process):
            if "outcome" in line:
                done[line["number"]] = line
                with (folder / "done.jsonl").open("a") as file:
                    file.write(json.dumps(line) + "\n")
        left = [number for number in left if number not in done]


def follow(process: subprocess.Popen):
    """Give what a process says; where it falls silent or dies, say that of the mutant it read."""
    lines: queue.Queue[str | None] = queue.Queue()

    def listen() -> None:
        for line in process.stdout:
            lines.put(line)
        lines.put(None)

    threading.Thread(target=listen, daemon=True).start()
    current, first = None, True
    while True:
        try:
            line = lines.get(timeout=60 if first else LONGEST)  # the first imports all
        except queue.Empty:
            process.kill()
            yield {**(current or {"number": -1, "seed": ""}), "outcome": "hang", "said": ""}
            return
        first = False
        if line is None:
            if process.wait() != 0 and current is not None:
                yield {**current, "outcome": "death", "said": f"status {process.returncode}"}
            return
        told = json.loads(line)
        current = None if "outcome" in told else told
        yield told


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(tempfile.mkdtemp())
    if not (folder / "seeds" / "project" / "report").exists():
        make_seeds(folder / "seeds")
    done: dict[int, dict] = {}
    if (folder / "done.jsonl").exists():
        told = map(json.loads, (folder / "done.jsonl").read_text().splitlines())
        done = {line["number"]: line for line in told}
    for first in range(0, count, BATCH):
        read_batch(folder, range(first, min(first + BATCH, count)), done)
        print(f"{min(first + BATCH, count)} of {count}", file=sys.stderr, flush=True)
    ended = [done[number] for number in range(count)]
    outcomes = Counter(line["outcome"] for line in ended)
    for line in ended:
        if line["outcome"] not in ("read", "refused"):
            print(line["number"], line["seed"], line["outcome"], line["said"], file=sys.stderr)
    tell(
        "fuzz",
        "Damaged files",
        [
            Figure("mutants", count, at_least=20_000),
            Figure("files they were made of", len(seeds_of(folder / "seeds"))),
            Figure("refused in a sentence", outcomes["refused"]),
            Figure("read", outcomes["read"]),
            Figure("tracebacks", outcomes["traceback"] + outcomes["death"], at_most=0),
            Figure("hangs over 20 s", outcomes["hang"], at_most=0),
            Figure(
                "peak memory", max(line.get("peak_mib", 0) for line in ended), "MiB", at_most=1024
            ),
        ],
        note=NOTE,
    )


if __name__ == "__main__":
    main()
