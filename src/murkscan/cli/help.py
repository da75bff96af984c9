"""How --help is laid out: sentences are wrapped by the terminal alone, and say what matters."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cyclopts.help import HelpEntry, HelpPanel
    from rich.console import Console, ConsoleOptions

_UNSAID = ("False", "()")
"""Defaults that mean that a flag is not given, which goes without saying."""


@dataclass(frozen=True)
class Formatter:
    """The library's own panels, without the line breaks of our source in their sentences."""

    def __call__(self, console: "Console", options: "ConsoleOptions", panel: "HelpPanel") -> None:
        """Draw a panel."""
        from cyclopts.help import DefaultFormatter

        panel.entries = [_reflow(entry) for entry in panel.entries]
        DefaultFormatter()(console, options, panel)

    def render_usage(self, console: "Console", options: "ConsoleOptions", usage: Any) -> None:
        """Draw the line that says how a command is called."""
        from cyclopts.help import DefaultFormatter

        DefaultFormatter().render_usage(console, options, usage)

    def render_description(self, console: "Console", options: "ConsoleOptions", text: Any) -> None:
        """Draw what a command does, paragraph by paragraph."""
        from cyclopts.help import DefaultFormatter

        DefaultFormatter().render_description(console, options, _join(text))


def _reflow(entry: "HelpEntry") -> "HelpEntry":
    from attrs import evolve

    default = None if entry.default in _UNSAID else entry.default
    return evolve(entry, description=_join(entry.description), default=default)


def _join(text: Any) -> Any:
    """Join the lines of each paragraph."""
    from cyclopts.help import InlineText
    from rich.text import Text

    inner = text.primary_renderable if isinstance(text, InlineText) else None
    if not isinstance(inner, Text):
        return text
    paragraphs = (" ".join(one.split()) for one in inner.plain.split("\n\n"))
    return InlineText(
        Text("\n\n".join(paragraphs), end=inner.end), force_empty_end=text.force_empty_end
    )
