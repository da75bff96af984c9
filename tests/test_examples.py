"""Every example runs."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.py"))
RUN_ALL = """
import contextlib, io, json, runpy, sys, traceback

sys.path.insert(0, sys.argv[1].rpartition("/")[0])
for example in sys.argv[1:]:
    said, trouble = io.StringIO(), ""
    try:
        with contextlib.redirect_stdout(said):
            runpy.run_path(example, run_name="__main__")
    except Exception:
        trouble = traceback.format_exc()
    print(json.dumps([said.getvalue(), trouble]), flush=True)
"""
"""In one process: to load the libraries for each takes longer than to run it."""


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Run all examples, which share a scan in a folder for temporary files of their own."""
    folder = tmp_path_factory.mktemp("examples")
    done = subprocess.run(
        [sys.executable, "-c", RUN_ALL, *map(Path.as_posix, EXAMPLES)],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder), "MPLBACKEND": "Agg"},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return dict(zip(EXAMPLES, map(json.loads, done.stdout.splitlines()), strict=True))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_says_something(example, outcomes):
    said, trouble = outcomes[example]
    assert not trouble
    assert said
