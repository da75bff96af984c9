"""A few hundred of the damaged files that benchmarks/fuzz.py reads by the thousand."""

import json
import os
import subprocess
import sys
from pathlib import Path

from .mutants import make_seeds, seeds_of

ROOT = Path(__file__).resolve().parents[1]


def test_no_damaged_file_is_a_fault_of_ours(tmp_path):
    """In a process of its own, so that a crash or a hang in a library fails this test only."""
    make_seeds(tmp_path / "seeds")
    first = 1_000_000  # not those of the benchmark
    run = subprocess.run(
        [sys.executable, "-m", "tests.mutants", str(tmp_path), str(first), str(first + 300)],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    lines = [json.loads(line) for line in run.stdout.splitlines()]
    assert run.returncode == 0, lines[-1:]
    ended = [line for line in lines if "outcome" in line]
    faults = [line for line in ended if line["outcome"] not in ("read", "refused")]
    assert not faults, [(one["number"], one["seed"], one["said"][-300:]) for one in faults]
    assert len(ended) == 300 > len(seeds_of(tmp_path / "seeds"))
    # Some are still sound, but most of those that are read are read as something else.
    assert sum(line["outcome"] == "refused" for line in ended) > 50
    assert max(line["peak_mib"] for line in ended) < 1024
