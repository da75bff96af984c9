"""Hold a scan of calibrated artefacts against limits, and write the protocol to OUT/accept."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from itertools import chain, starmap
from pathlib import Path

import numpy as np

from ..accept import Finding, Protocol, as_page, as_plain
from ..errors import EstimationError
from ..io.json_files import save_json
from ..io.text import save_text
from ..measure import (
    Ball,
    FoundBall,
    Sample,
    find_ball,
    measure_flatness,
    measure_spacing,
    measure_step,
)
from ..project import ACCEPT, CLOUD, AcceptResult, Project, StageFiles, describe, digest
from ..project.unstated import list_unstated
from ..types.acceptance import AcceptanceTest, CalibratedBall, CalibratedPlate, CalibratedStep
from .progress import silent
from .sample import load_sample
from .scanned_words import tell_how_scanned
from .stage_runner import make_stage


def accept_scan(project: Project, test: AcceptanceTest, *, source: Path) -> Protocol:
    """Measure the artefacts of a test, decide, and write accept/accept.json and accept/index.html.

    Args:
        project: A scan, or a merged cloud, with a finished cloud stage.
        test: The artefacts and the limits.
        source: The file that says so, for what errors say.

    Raises:
        MissingResult: The cloud stage has not been finished.
        EstimationError: An artefact is not in the scan, or too little of it; the message names it.
        DeviceError: The disk is full.
    """
    cloud = project.finished(CLOUD).digest
    stage = project.stage(
        ACCEPT, settings={"test": digest(describe(test))}, inputs={"cloud": cloud}
    )

    def prepare() -> Protocol:
        sample = load_sample(project)
        balls = {one.name: _find(sample, one, source) for one in test.balls}
        return Protocol(
            name=project.root.resolve().name,
            test=test,
            findings=[*_test_all(sample, balls, test, source)],
            scanned=tell_how_scanned(project),
            seen=", ".join(starmap(_tell_seen, balls.items())),
            unstated=list_unstated(project),
        )

    made = list[Protocol]()

    def make(protocol: Protocol) -> AcceptResult:
        files = StageFiles(project.root / ACCEPT.word)
        about = {"format": 1, "murkscan": version("murkscan"), "inputs": {"cloud": cloud}}
        with files.making("accept.json") as path:
            save_json(path, about | as_plain(protocol))
        with files.making("index.html") as path:
            save_text(path, as_page(protocol))
        made.append(protocol)
        return AcceptResult(protocol.decision.value)

    make_stage(project, stage, make, prepare=prepare, progress=silent)
    return made[0]


def _test_all(
    sample: Sample, balls: dict[str, FoundBall], test: AcceptanceTest, source: Path
) -> Iterator[Finding]:
    """Test every artefact, in the order of the page."""
    yield from chain.from_iterable(_test_ball(one, balls[one.name], test) for one in test.balls)
    limits = test.limits
    for bar in test.bars:
        spacing = measure_spacing(balls[bar.first], balls[bar.second])
        names = f"balls {bar.first} and {bar.second}"
        yield Finding(
            "sphere spacing", names, bar.length, bar.length_sigma, spacing, limits.sphere_spacing
        )
    for plate in test.plates:
        yield _test_plate(sample, plate, test, source)
    for step in test.steps:
        yield _test_step(sample, step, test, source)


def _find(sample: Sample, ball: CalibratedBall, source: Path) -> FoundBall:
    with _naming(f"ball {ball.name}", source):
        return find_ball(sample, np.array(ball.near), ball.diameter / 2)


def _test_ball(ball: CalibratedBall, found: FoundBall, test: AcceptanceTest) -> Iterator[Finding]:
    name, limits = f"ball {ball.name}", test.limits
    yield Finding("probing form", name, 0.0, ball.form / 2, found.form, limits.probing_form)
    yield Finding(
        "probing size",
        name,
        ball.diameter,
        ball.diameter_sigma,
        found.diameter,
        limits.probing_size,
    )


def _test_plate(
    sample: Sample, plate: CalibratedPlate, test: AcceptanceTest, source: Path
) -> Finding:
    with _naming(f"plate {plate.name}", source):
        part = sample[Ball(plate.near, plate.within).contains(sample.cloud.points)]
        found = measure_flatness(part)
    name = f"plate {plate.name}"
    return Finding("flatness", name, 0.0, plate.flatness / 2, found, test.limits.flatness)


def _test_step(sample: Sample, step: CalibratedStep, test: AcceptanceTest, source: Path) -> Finding:
    with _naming(f"step {step.name}", source):
        parts = [
            sample[Ball(place, step.within).contains(sample.cloud.points)]
            for place in (step.first, step.second)
        ]
        found = measure_step(*parts)["step"]
    name = f"step {step.name}"
    return Finding("length", name, step.height, step.height_sigma, found, test.limits.length)


@contextmanager
def _naming(artefact: str, source: Path) -> Iterator[None]:
    """Name the artefact, and the file that says of it, in what an error says."""
    try:
        yield
    except EstimationError as error:
        text = str(error)
        raise type(error)(f"{source}: {artefact}: {text[0].lower()}{text[1:]}") from error


def _tell_seen(name: str, ball: FoundBall) -> str:
    return f"{ball.seen:.0%} of ball {name} by {int(ball.fit.inliers.sum()):,} points"
