"""Kill jobs without warning at hundreds of moments, and compare what a second run makes of it.

Moments are file operations drawn from all that a job makes, and points of time. The seed is fixed;
`python benchmarks/kills.py JOB` tries every file operation of one job.
"""

import json
import random
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from harness import Figure, tell

OPERATIONS = {
    "model": 110, "again": 60, "merge": 15, "mesh": 12, "pages": 12, "export": 6, "measure": 12,
    "simulate": 10,
}  # fmt: skip
"""File operations that are drawn of each job."""
TIMES = {"model": 20, "again": 10}
"""Moments in time that are drawn of each job."""
LONGEST = 4.0
"""A job's run is over by then, or nearly so [s]."""

NOTE = """
A run is killed (`SIGKILL`) before a file operation, or after a time, drawn at random; the same job
is run again, and every file of its folder compared with those of a run that nothing disturbed:
stripes, overlays, profiles, poses, clouds, surfaces, pictures, pages, records with their checksums.
Only stated times are left out: when a scan began, how long its stages took, and what the report
page says of them. *model* runs the stages from extract to mesh in a new folder, *again* the same
with another speed in a folder that holds a scan, so that outdated stages are removed; *pages* draws
pictures and writes the view and the report anew. The recording has 70 frames of 240 × 192, in two
parts.
"""


def kill(folder: Path, job: str, *moments: str) -> Iterator[dict[str, Any]]:
    """Run the harness of the tests in a process of its own."""
    command = [sys.executable, "-m", "tests.kills", str(folder), job, *moments]
    root = Path(__file__).resolve().parents[1]
    with subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        for line in run.stdout:
            if line.startswith("{"):
                yield json.loads(line)


def main() -> None:
    draw, totals = random.Random(0), Counter[str]()
    jobs = dict.fromkeys(sys.argv[1:], 10**9) or OPERATIONS
    with tempfile.TemporaryDirectory() as folder:
        for job, wanted in jobs.items():
            (told,) = kill(Path(folder), job, "count")
            every = range(1, told["count"] + 1)
            moments = [str(n) for n in sorted(draw.sample(every, min(wanted, len(every))))]
            if not sys.argv[1:]:
                moments += [f"{draw.uniform(0, LONGEST):.4f}" for _ in range(TIMES.get(job, 0))]
            for one in kill(Path(folder), job, *moments):
                totals.update(killed=one["killed"], failed=one["failed"])
                totals.update(differ=bool(one["differ"]), tried=1)
                if one["failed"] or one["differ"]:
                    print(job, one, file=sys.stderr)
            print(job, told["count"], "operations;", dict(totals), file=sys.stderr, flush=True)
    figures = [
        Figure("moments at which a run was killed", totals["killed"], at_least=200),
        Figure("runs that could not go on", totals["failed"], at_most=0),
        Figure("folders that differ from an undisturbed run's", totals["differ"], at_most=0),
    ]
    tell("kills", "Jobs that are killed", figures, note=NOTE)


if __name__ == "__main__":
    main()
