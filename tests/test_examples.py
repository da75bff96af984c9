"""Every example runs."""

import io
import runpy
import tempfile
import traceback
from contextlib import redirect_stdout
from pathlib import Path

import pytest

pytestmark = pytest.mark.without_types

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.py"))


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Run all examples here, since to load the libraries for each takes longer than to run it.

    They share a scan in a folder for temporary files of their own.
    """
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("examples")
        patch.chdir(folder)
        patch.setattr(tempfile, "tempdir", str(folder))
        patch.setenv("MPLBACKEND", "Agg")
        patch.syspath_prepend(str(EXAMPLES[0].parent))
        return {example: _run(example) for example in EXAMPLES}


def _run(example):
    """Give what an example says, and the trouble that it has."""
    said, trouble = io.StringIO(), ""
    try:
        with redirect_stdout(said):
            runpy.run_path(str(example), run_name="__main__")
    except Exception:
        trouble = traceback.format_exc()
    return said.getvalue(), trouble


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_says_something(example, outcomes):
    said, trouble = outcomes[example]
    assert not trouble
    assert said
