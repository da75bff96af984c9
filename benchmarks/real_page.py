"""The page of the real recordings: tables, bars, and what counts as true."""

from dataclasses import dataclass

from harness import Figure, tell
from real_judge import Judged, pool
from real_sets import RealSet
from real_stage import Height
from real_steps import Shares
from real_words import AFTER, HOW

CHAMPION = "murk"
_ALL = 1 << 30
"""More frames than any recording has."""
_R, _P, _PIECE, _OFF, _MAD = 99.0, 99.5, 95.0, 0.25, 0.10
"""Bars: recall, precision and share of a piece [%], error of a height and its scatter [mm]."""


@dataclass(frozen=True)
class SetResult:
    """What all finders made of one set."""

    of: RealSet
    judged: dict[str, list[Judged]]
    """By finder: each recording."""
    heights: dict[str, list[Height]]
    steps: dict[str, Shares]

    def parts(self) -> dict[str, dict[str, dict[str, float]]]:
        """Give the figures of each finder, of the frames that may be fitted by and of the rest."""
        cuts = {"fitted": (0, self.of.num_fitted), "judged only": (self.of.num_fitted, _ALL)}
        parts = {
            f"{self.of.name}, {words}": {
                name: pool([one.of_frames(*cut) for one in recordings])
                for name, recordings in self.judged.items()
            }
            for words, cut in cuts.items()
        }
        return {k: part for k, part in parts.items() if any(f["true"] for f in part.values())}

    def as_table(self) -> str:
        """Give its tables and lines."""
        lines: list[str] = []
        for words, part in self.parts().items():
            lines += [f"## {words}", "", _HEAD, "|---|---|---|---|---|---|"]
            lines += [_row(name, figures) for name, figures in part.items()] + [""]
        for name, heights in self.heights.items():
            lines += [f"- {name}: {height}" for height in heights]
        lines += [f"- {name}, steps.png: {steps}" for name, steps in self.steps.items()]
        return "\n".join(lines)


_HEAD = "| finder | R [%] | P [%] | false along the edge [% of points] | points | not judged |"


def _row(name: str, figures: dict[str, float]) -> str:
    return (
        f"| {name} | {figures['R']:.2f} | {figures['P']:.2f} | {figures['edge']:.2f} | "
        f"{figures['found']:.0f} | {figures['unclear']:.0f} |"
    )


def tell_page(results: list[SetResult]) -> None:
    """Print the champion's figures beside their bars, and write the page."""
    figures = [figure for one in results for figure in _figures(one)]
    tables = "\n\n".join(one.as_table().strip() for one in results)
    note = "\n".join((HOW, "", tables, "", AFTER, "", "## Bars of Murk"))
    tell("real", "Finding the stripe in real recordings", figures, note=note)


def _figures(one: SetResult) -> list[Figure]:
    figures = []
    for words, part in one.parts().items():
        champion = part[CHAMPION]
        others = [figures for name, figures in part.items() if name != CHAMPION]
        for key, least in (("R", _R), ("P", _P)):
            bar = max(other[key] for other in others)
            bar = max(bar, least) if one.of.is_stage else bar
            figures.append(Figure(f"{words}: {key}", champion[key], "%", at_least=round(bar, 2)))
        figures.append(Figure(f"{words}: along the edge", champion["edge"], "%", at_most=0.0))
    for height in one.heights[CHAMPION]:
        where = f"{one.of.name}, {height.level.caliper:.2f} mm"
        off = abs(height.height - height.level.caliper)
        figures.append(Figure(f"{where}: off by", off, "mm", at_most=_OFF))
        figures.append(Figure(f"{where}: scatter (MAD)", height.scatter, "mm", at_most=_MAD))
    if steps := one.steps.get(CHAMPION):
        shortest = min(steps.pieces)
        figures.append(
            Figure("steps.png: shortest share of a piece", shortest, "%", at_least=_PIECE)
        )
        figures.append(Figure("steps.png: points elsewhere", steps.elsewhere, at_most=0.0))
    return figures
