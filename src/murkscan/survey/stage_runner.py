"""The frame that every stage runs in: skip what is done, hold the folder, make, and finish."""

import time
from collections.abc import Callable
from typing import TypeVar

from ..project import Project, Stage
from .progress import Progress

R = TypeVar("R")
T = TypeVar("T")


def run_stage(
    project: Project,
    stage: Stage[R],
    make: Callable[[T], R],
    *,
    prepare: Callable[[], T],
    progress: Progress,
) -> R:
    """Run a stage, unless it is done with the same settings and inputs.

    Args:
        project: Whose stage it is.
        stage: What is to be made from what.
        make: Makes the files of what has been prepared; parts that are there already it keeps.
        prepare: Reads and computes what may fail, while what an earlier run made is still there.
        progress: Told when the stage begins and ends.

    Returns:
        What the stage says; what it said before where it is skipped.

    Raises:
        InputError: Another run is at work in the folder.
        DeviceError: The disk is full.
    """
    if (result := stage.result()) is not None:
        stage.settle()
        return result
    return make_stage(project, stage, make, prepare=prepare, progress=progress)


def make_stage(
    project: Project,
    stage: Stage[R],
    make: Callable[[T], R],
    *,
    prepare: Callable[[], T],
    progress: Progress,
) -> R:
    """Run a stage whether it is done or not; the arguments are those of `run_stage`."""
    with project.hold():
        since = time.monotonic()
        progress(stage.kind.word, 0, None)
        prepared = prepare()
        stage.begin()
        result = make(prepared)
        stage.finish(result, since=since)
    progress(stage.kind.word, 1, 1)
    return result
