"""acceptance.toml: calibrated artefacts in a scan, and the limits that they are held against."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveFloat, ValidationError

from ..errors import FormatError
from ..types.acceptance import (
    AcceptanceTest,
    CalibratedBall,
    CalibratedBar,
    CalibratedPlate,
    CalibratedStep,
    Limits,
)
from .toml_files import parse_toml
from .validation import explain

_Positive = Annotated[PositiveFloat, Field(allow_inf_nan=False)]
_NotNegative = Annotated[FiniteFloat, Field(ge=0)]
_Place = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
_Name = Annotated[str, Field(min_length=1)]
_MM = 1e-3


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _BallTable(_Table):
    name: _Name
    near_m: _Place
    diameter_mm: _Positive
    diameter_sigma_mm: _NotNegative = 0.0
    form_mm: _NotNegative = 0.0

    def as_ball(self) -> CalibratedBall:
        sizes = (self.diameter_mm * _MM, self.diameter_sigma_mm * _MM, self.form_mm * _MM)
        return CalibratedBall(self.name, self.near_m, *sizes)


class _BarTable(_Table):
    balls: tuple[_Name, _Name]
    length_mm: _Positive
    length_sigma_mm: _NotNegative = 0.0

    def as_bar(self) -> CalibratedBar:
        return CalibratedBar(*self.balls, self.length_mm * _MM, self.length_sigma_mm * _MM)


class _PlateTable(_Table):
    name: _Name
    near_m: _Place
    within_mm: _Positive
    flatness_mm: _NotNegative = 0.0

    def as_plate(self) -> CalibratedPlate:
        return CalibratedPlate(self.name, self.near_m, self.within_mm * _MM, self.flatness_mm * _MM)


class _StepTable(_Table):
    name: _Name
    first_m: _Place
    second_m: _Place
    within_mm: _Positive
    height_mm: FiniteFloat
    height_sigma_mm: _NotNegative = 0.0

    def as_step(self) -> CalibratedStep:
        sizes = (self.within_mm * _MM, self.height_mm * _MM, self.height_sigma_mm * _MM)
        return CalibratedStep(self.name, self.first_m, self.second_m, *sizes)


class _LimitsTable(_Table):
    probing_form_mm: _Positive | None = None
    probing_size_mm: _Positive | None = None
    sphere_spacing_mm: _Positive | None = None
    flatness_mm: _Positive | None = None
    length_mm: _Positive | None = None

    def as_limits(self) -> Limits:
        given = self.model_dump(exclude_none=True)
        return Limits(**{key.removesuffix("_mm"): value * _MM for key, value in given.items()})


class _AcceptanceTable(_Table):
    format: Literal[1]
    name: _Name
    certificate: str = ""
    ball: tuple[_BallTable, ...] = ()
    bar: tuple[_BarTable, ...] = ()
    plate: tuple[_PlateTable, ...] = ()
    step: tuple[_StepTable, ...] = ()
    limits: _LimitsTable = _LimitsTable()

    def as_test(self) -> AcceptanceTest:
        return AcceptanceTest(
            name=self.name,
            certificate=self.certificate,
            balls=tuple(one.as_ball() for one in self.ball),
            bars=tuple(one.as_bar() for one in self.bar),
            plates=tuple(one.as_plate() for one in self.plate),
            steps=tuple(one.as_step() for one in self.step),
            limits=self.limits.as_limits(),
        )


def load_acceptance(path: Path) -> AcceptanceTest:
    """Read a file of artefacts and limits.

    Raises:
        FormatError: It is missing or no TOML, a key is unknown, missing or out of range, a name
            stands twice, or a bar names a ball that is not there; the message names the file.
    """
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise FormatError(
            f"There is no file {path} that says what the artefacts are; give one with --test."
        ) from error
    return parse_acceptance(text, str(path))


def parse_acceptance(text: str, name: str) -> AcceptanceTest:
    """Read the text of such a file; `name` is what errors call it.

    Raises:
        FormatError: As for `load_acceptance`.
    """
    try:
        test = _AcceptanceTable.model_validate(parse_toml(text, name).unwrap()).as_test()
    except ValidationError as error:
        raise FormatError(f"{name}: {explain(error)}") from error
    for fault in _find_faults(test):
        raise FormatError(f"{name}: {fault}")
    return test


def _find_faults(test: AcceptanceTest) -> Iterator[str]:
    """Say what does not go together."""
    balls = [ball.name for ball in test.balls]
    for bar in test.bars:
        for ball in (bar.first, bar.second):
            if ball not in balls:
                yield f"bar.balls names {ball!r}, but there is no [[ball]] of that name; add it."
        if bar.first == bar.second:
            yield f"bar.balls names {bar.first!r} twice; a bar has two balls."
    names = [*balls, *(one.name for one in test.plates), *(one.name for one in test.steps)]
    for twice in sorted({name for name in names if names.count(name) > 1}):
        yield f"the name {twice!r} stands twice; give each artefact its own."
    if not names:
        yield "it names no artefact; add a [[ball]], a [[plate]] or a [[step]]."
