"""The check of types that the tests add to the package's functions, made when one is called."""

from collections.abc import Callable
from functools import wraps
from typing import Any

from beartype import beartype


def check(function: Callable[..., Any]) -> Callable[..., Any]:
    """Check a function's types from its first call on.

    To make the checks of all functions takes each run of tests five seconds, and it calls a tenth.
    """
    made: list[Callable[..., Any]] = []

    @wraps(function)
    def checked(*values: Any, **named: Any) -> Any:
        if not made:
            made.append(beartype(function))
        return made[0](*values, **named)

    return checked
