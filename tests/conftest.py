"""What all tests share."""

import os
import signal
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest
from filelock import FileLock
from hypothesis import settings
from jaxtyping import config

from . import late  # noqa: F401 - named in pyproject.toml, and found there once it is imported

settings.register_profile("murkscan", deadline=None)  # a slow machine is no fault of the code
settings.load_profile("murkscan")
# What a shell runs in the background ignores Ctrl-C, and so would the programs that tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
SHARED = Path(__file__).resolve().parents[2] / "shared"
DATA, FAULTS = SHARED / "data", SHARED / "faults"
RUNS = ("cli", "report", "studio", "survey")
"""Folders whose tests run what rooms do together; the rooms' own tests check the types."""
LONG = (
    "extract/test_extractors.py", "measure/test_intervals.py", "adjust/test_stated_errors.py",
    "survey/test_simulate.py", "geometry/test_alignment.py", "calibrate/test_mount.py",
    "test_examples.py", "studio/test_clicks.py", "survey/test_kills.py", "survey/test_demo.py",
    "survey/test_scan.py", "extract/test_real_flaws.py",
    "extract/test_murk.py", "survey/test_executors.py", "survey/test_cloud.py",
    "capture/test_fields.py",
)  # fmt: skip
"""Files that take half a minute or more. They are run first, so that no core is left with one when
all else is done; and those that begin together compile different loops, not the same ones each."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the long files first."""
    order = {name: place for place, name in enumerate(LONG)}

    def place(item: pytest.Item) -> int:
        name = item.path.name
        return order.get(f"{item.path.parent.name}/{name}", order.get(name, len(LONG)))

    items.sort(key=place)


@pytest.fixture(scope="module", autouse=True)
def _check_types(request: pytest.FixtureRequest) -> Iterator[None]:
    """Check types and shapes of arrays, but for whole runs and tests that are marked.

    These call small functions so often that checking them would be half of the time.
    """
    config.update("jaxtyping_disable", _is_a_run(request))
    yield
    config.update("jaxtyping_disable", False)


def _is_a_run(request: pytest.FixtureRequest) -> bool:
    """Tell whether a file of tests runs what rooms do together, or is marked as if it did."""
    is_marked = request.node.get_closest_marker("without_types") is not None
    return request.path.parent.name in RUNS or is_marked


@pytest.fixture(scope="module", autouse=True)
def _draw_small(request: pytest.FixtureRequest) -> Iterator[None]:
    """Draw a scan's pictures small in whole runs, of which they would be half of the time.

    `view` itself has tests of what is drawn, and `survey/test_view.py` of how large.
    """
    with pytest.MonkeyPatch.context() as patch:
        if _is_a_run(request):
            from murkscan.survey import view
            from murkscan.view import draw_pictures

            patch.setattr(view, "draw_pictures", partial(draw_pictures, size=(320, 240)))
        yield


@pytest.fixture(scope="session")
def data() -> Callable[[str], Path]:
    """Give the folder of a real recording by name; skip the test where it is absent."""

    def folder(name: str) -> Path:
        if not (DATA / name).is_dir():
            pytest.skip(f"the real recording {name} is not beside this checkout")
        return DATA / name

    return folder


@pytest.fixture(scope="session")
def fault() -> Callable[[str], Path]:
    """Give an input that users have by its name; skip the test where it is absent."""

    def file(name: str) -> Path:
        if not (FAULTS / name).exists():
            pytest.skip(f"the input {name} is not beside this checkout")
        return FAULTS / name

    return file


@pytest.fixture(scope="session")
def hull(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a simulated recording in three parts, of 360 × 288: frames/, rig.toml, truth/.

    All processes of a run share it, and one of them makes it.
    """
    from murkscan.survey.simulate import simulate_recording

    from .scenes import hull_scene, smaller

    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "hull"
    with FileLock(folder.with_suffix(".lock")):
        if not folder.exists():
            begun = tmp_path_factory.mktemp("hull")
            simulate_recording(smaller(hull_scene(num_frames=130), 2), begun)
            begun.rename(folder)
    return folder
