"""How a benchmark tells its figures: a table, a page in docs/benchmarks, and a line of JSON."""

import json
import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs" / "benchmarks"
DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
"""Real recordings, where they are beside the checkout."""

# What is timed in this process takes as many threads as commands do; NumPy reads it when it comes.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


@dataclass(frozen=True)
class Figure:
    """One number, and the bar that it has to clear, if there is one."""

    name: str
    value: float
    unit: str = ""
    at_most: float | None = None
    at_least: float | None = None

    @property
    def is_missed(self) -> bool:
        """Tell whether the number is on the wrong side of its bar; NaN always is."""
        over = self.at_most is not None and not self.value <= self.at_most
        under = self.at_least is not None and not self.value >= self.at_least
        return over or under

    def as_row(self) -> str:
        """Give a row of the table."""
        bar = "" if self.at_most is None else f"≤ {self.at_most:g}"
        bar = bar if self.at_least is None else f"≥ {self.at_least:g}"
        met = "" if not bar else "**missed**" if self.is_missed else "met"
        return f"| {self.name} | {self.value:.4g} {self.unit} | {bar} | {met} |"


def best_time(run: Callable[[], object], *, repeats: int = 7) -> float:
    """Give the shortest of several runs [s]: the one that others on the machine disturbed least."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def tell(name: str, title: str, figures: Sequence[Figure], *, note: str = "") -> None:
    """Print the figures, write docs/benchmarks/<name>.md, and end with the line of JSON."""
    rows = ["| figure | value | bar | |", "|---|---|---|---|"] + [one.as_row() for one in figures]
    page = [f"# {title}", "", f"Made by `python benchmarks/{name}.py`.", ""]
    page += [note.strip(), ""] if note else []
    page += rows
    DOCS.mkdir(parents=True, exist_ok=True)
    (DOCS / f"{name}.md").write_text("\n".join(page) + "\n", "utf-8")
    print("\n".join(page))
    missed = [one.name for one in figures if one.is_missed]
    values = {one.name: one.value if one.value == one.value else None for one in figures}
    print(json.dumps({"bench": name, "figures": values, "missed": missed}, ensure_ascii=False))


def skip(name: str, why: str) -> None:
    """Say that a benchmark cannot run here; its page stays as it is."""
    print(f"{name} is skipped: {why}")
    print(json.dumps({"bench": name, "figures": {}, "missed": []}))
    sys.exit(0)
