"""The gauges of a dive on the terminal."""

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

from .progress import progress_bars

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.live import Live

    from ..live import LiveStatus
    from ..survey.progress import Progress

_LINE = 10.0
"""Time from one line to the next where no terminal shows them [s]."""
_GOOD = ("good", "live", "done")


class LiveDisplay:
    """Shows a dive's status on the terminal, and then how far its scan is."""

    def __init__(self, seconds: float | None) -> None:
        """Begin with nothing shown.

        Args:
            seconds: How long the dive shall be [s]; None: until somebody ends it.
        """
        from rich.console import Console

        self._console, self._seconds = Console(stderr=True, highlight=False), seconds
        self._stack = ExitStack()
        self._live: Live | None = None
        self._bars: Progress | None = None
        self._recorded, self._told, self._said = 0.0, 0.0, ""

    def tell(self, status: "LiveStatus") -> None:
        """Show the status."""
        self._recorded = status.recorded.time
        if not self._console.is_terminal:
            self._print_line(status)
            return
        if self._live is None:
            from rich.live import Live

            self._live = Live(console=self._console, auto_refresh=False, transient=True)
            self._stack.enter_context(self._live)
        self._live.update(_draw(status), refresh=True)

    def progress(self, stage: str, done: int, total: int | None) -> None:
        """Show how far the scan is; the gauges go."""
        if self._bars is None:
            self._stack.close()
            self._bars = self._stack.enter_context(progress_bars())
        self._bars(stage, done, total)

    def is_over(self) -> bool:
        """Tell whether the dive is as long as it shall be."""
        return self._seconds is not None and self._recorded >= self._seconds

    def close(self) -> None:
        """Leave the terminal as it was."""
        self._stack.close()

    def _print_line(self, status: "LiveStatus") -> None:
        """Print what is new: another state, other warnings, and all of it now and then."""
        said = "\n".join([status.message.split(" for ")[0], *status.warnings])
        now = time.monotonic()
        if said == self._said and now - self._told < _LINE:
            return
        self._said, self._told = said, now
        gauges = "; ".join(f"{name} {text}" for name, text, _ in describe(status))
        self._console.print(f"{status.state}: {gauges}", soft_wrap=True)
        for warning in status.warnings:
            self._console.print(f"warning: {warning}", soft_wrap=True)


def describe(status: "LiveStatus") -> list[tuple[str, str, str]]:
    """Put each gauge into words: its name, its value, and how good that is."""
    s = status
    return [
        ("recorded", f"{s.recorded.time:.1f} s, {s.recorded.pictures} pictures", "good"),
        ("stand-off", _stand_off(s), s.stand_off.state),
        ("speed", _speed(s), s.speed.state),
        ("stripe", _stripe(s), s.stripe.state),
        ("water", _water(s), "good"),
        ("coverage", _coverage(s), "good"),
        ("preview", _preview(s), "good"),
        ("disk", _disk(s), s.disk.state),
    ]


def _stand_off(status: "LiveStatus") -> str:
    gauge = status.stand_off
    if gauge.value is None or gauge.near is None or gauge.far is None:
        return "–"
    return f"{gauge.value:.2f} m of {gauge.near:.2f} to {gauge.far:.2f} m, {gauge.state}"


def _speed(status: "LiveStatus") -> str:
    gauge = status.speed
    if gauge.value is None or gauge.highest is None:
        return "–"
    return f"{gauge.value:.0f} mm/s, at most {gauge.highest:.0f}, {gauge.state}"


def _stripe(status: "LiveStatus") -> str:
    gauge = status.stripe
    if gauge.signal is None or gauge.share is None or not gauge.noise:
        return gauge.state if gauge.state == "lost" else "–"
    return (
        f"{gauge.signal / gauge.noise:.0f} times the noise, in {gauge.share:.0%} of the lines, "
        f"{gauge.state}"
    )


def _water(status: "LiveStatus") -> str:
    water = status.water
    if water.attenuation is None:
        return "–"
    reach = "" if water.reach is None else f", shows the stripe up to {water.reach:.2f} m"
    return f"light fades by {water.attenuation:.2g} per metre{reach}"


def _coverage(status: "LiveStatus") -> str:
    covered = status.coverage
    return "–" if covered.share is None else f"{covered.share:.1%} of {_area(status):.3g} m²"


def _area(status: "LiveStatus") -> float:
    return status.coverage.covered + status.coverage.missing


def _preview(status: "LiveStatus") -> str:
    preview = status.preview
    late = "" if preview.latency is None else f", {1e3 * preview.latency:.0f} ms behind"
    return f"{preview.frames} frames, {preview.dropped} dropped{late}"


def _disk(status: "LiveStatus") -> str:
    disk = status.disk
    if disk.free is None:
        return "–"
    left = "" if disk.time_left is None else f", {disk.time_left / 60:.0f} min"
    return f"{disk.free / 1e9:.1f} GB left{left}"


def _draw(status: "LiveStatus") -> "RenderableType":
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    for name, text, state in describe(status):
        colour = "green" if state in _GOOD else "dim" if state == "unknown" else "bold yellow"
        table.add_row(Text(name), Text(text, style=colour))
    head = Text(f"{status.message} Ctrl-C ends the dive.", style="bold")
    warnings = [Text(warning, style="bold red") for warning in status.warnings]
    return Group(head, table, *warnings)
