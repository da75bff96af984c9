"""What all tests share."""

import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from jaxtyping import config

settings.register_profile("murkscan", deadline=None)  # a slow machine is no fault of the code
settings.load_profile("murkscan")
# What a shell runs in the background ignores Ctrl-C, and so would the programs that tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
SHARED = Path(__file__).resolve().parents[2] / "shared"
DATA, FAULTS = SHARED / "data", SHARED / "faults"
RUNS = ("cli", "report", "studio", "survey")
"""Folders whose tests run what rooms do together; the rooms' own tests check the types."""


@pytest.fixture(scope="module", autouse=True)
def _check_types(request: pytest.FixtureRequest) -> Iterator[None]:
    """Check types and shapes of arrays, but for whole runs and tests that are marked.

    These call small functions so often that checking them would be half of the time.
    """
    is_marked = request.node.get_closest_marker("without_types") is not None
    config.update("jaxtyping_disable", request.path.parent.name in RUNS or is_marked)
    yield
    config.update("jaxtyping_disable", False)


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
    """Give a simulated recording in three parts, of 360 × 288: frames/, rig.toml, truth/."""
    from murkscan.survey.simulate import simulate_recording

    from .scenes import hull_scene, smaller

    folder = tmp_path_factory.mktemp("hull")
    simulate_recording(smaller(hull_scene(num_frames=130), 2), folder)
    return folder
