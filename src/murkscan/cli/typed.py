"""What the user typed, for the record."""

from contextvars import ContextVar

WORDS: ContextVar[tuple[str, ...]] = ContextVar("words", default=())
"""The words after `murkscan`."""
