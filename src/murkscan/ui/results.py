"""What a stage says when it is finished, as lines for people."""

import dataclasses
from collections.abc import Iterator
from typing import Any

_UNTOLD = ("laser", "start")
"""Numbers of a result that other stages want, and nobody else."""


def list_counts(result: Any) -> Iterator[str]:
    """Give the numbers of a stage's result, with the words for them."""
    for field in dataclasses.fields(result):
        value, words = getattr(result, field.name), field.name.replace("_", " ")
        if isinstance(value, dict):
            yield from (f"{words} {cause} {count:,}" for cause, count in value.items())
        if isinstance(value, bool) or field.name in _UNTOLD:
            continue
        if isinstance(value, float):
            yield f"{words} {value:g} {field.metadata['unit']}"
        elif isinstance(value, int):
            yield f"{words} {value:,}"
