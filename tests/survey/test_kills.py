"""Killed at any moment, a job goes on and ends with the same bytes."""

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="processes are forked")


@pytest.mark.parametrize(("job", "count"), [("model", 3), ("again", 2), ("merge", 1)])
def test_a_job_that_was_killed_ends_as_if_nothing_had_been(tmp_path_factory, job, count):
    """At operations drawn from all; `benchmarks/kills.py` tries hundreds."""
    folder = tmp_path_factory.getbasetemp() / "kills"
    folder.mkdir(exist_ok=True)
    (told,) = kill(folder, job, "count")
    moments = random.Random(job).sample(range(1, told["count"] + 1), count)
    for one in kill(folder, job, *map(str, moments)):
        assert one["killed"], one
        assert not one["failed"], one
        assert one["differ"] == [], one


def kill(folder, job, *moments):
    said = subprocess.run(
        [sys.executable, "-m", "tests.kills", str(folder), job, *moments],
        cwd=Path(__file__).parents[2], capture_output=True, text=True, check=True,
    )  # fmt: skip
    return [json.loads(line) for line in said.stdout.splitlines() if line.startswith("{")]
