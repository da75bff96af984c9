"""Killed at any moment, a job goes on and ends with the same bytes."""

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

KILLS = {"model": 3, "again": 2, "merge": 1}
"""How often each job is killed here, at operations drawn from all."""


@pytest.mark.skipif(os.name != "posix", reason="processes are forked")
def test_a_job_that_was_killed_ends_as_if_nothing_had_been(tmp_path):
    """`benchmarks/kills.py` tries hundreds of operations, and more jobs."""
    words = [word for job, count in KILLS.items() for word in (job, *["any"] * count)]
    said = subprocess.run(
        [sys.executable, "-m", "tests.kills", str(tmp_path), *words],
        cwd=Path(__file__).parents[2], capture_output=True, text=True, check=True,
    )  # fmt: skip
    told = [json.loads(line) for line in said.stdout.splitlines() if line.startswith("{")]
    assert Counter(one["job"] for one in told) == KILLS
    for one in told:
        assert one["killed"], one
        assert not one["failed"], one
        assert one["differ"] == [], one
