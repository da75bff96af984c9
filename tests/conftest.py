"""What all tests share."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("murkscan", deadline=None)  # a slow machine is no fault of the code
settings.load_profile("murkscan")
SHARED = Path(__file__).resolve().parents[2] / "shared"
DATA, FAULTS = SHARED / "data", SHARED / "faults"


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
