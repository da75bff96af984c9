"""The rows beside the ladder on the page: bars, and every finder beside them."""

import math
from typing import Any

from harness import Figure
from murk_plot import LABELS, STYLES
from murk_rows import ROWS, Row

Pooled = dict[str, dict[str, dict[str, float]]]

WORDS = """\
What real cameras, windows and lasers have. The hull of these rows carries anodes, plates and holes
of some 30 scan lines, so that smooth guessing does not pay: *in holes* is the share of scan lines
without a surface, between others that have one, in which a finder gives a point. *Clutter* is all
at once of what is fixed to the picture: *ghost*, a straight line of 40 grey levels; *text* in the
corners, with a clock; *window*, dirt on 2 % of it and two scratches, which take light and throw
it aside; *pixels*, 0.2 % of them hot, a response that differs by 1 %, noise of 1 grey level that
each row has in common; *streaks* of 10 % in the fan; *border*, a frame of one pixel of grey 150.
*Still*: a flat wall with holes at a constant distance, so that the stripe stands still, too. *Off*,
*sea* and *c10* have nothing to be found: the laser is off; there is no object; the water has 10
attenuations a metre and the lamp of c = 6. There *false* counts points in 10 000 scan lines."""


def rows_table(pooled: Pooled) -> str:
    """Give recall and precision of every finder, a row a line, beside the bar."""
    names = [name for name in STYLES if any(name in pooled.get(case, {}) for case in ROWS)]
    lines = [["recall / precision / in holes [%]", "bar", *(LABELS.get(n, n) for n in names)]]
    for case, row in ROWS.items():
        if case in pooled:
            cells = [_cell(row, pooled[case][n]) if n in pooled[case] else "–" for n in names]
            lines.append([case, _bar(row), *cells])
    if len(lines) == 1:
        return "Not run."
    told = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([told[0], "|" + "---|" * len(lines[0]), *told[1:]])


def rows_figures(pooled: Pooled, champion: str) -> list[Figure]:
    """Give the champion's figures in these rows, with their bars."""
    figures = []
    for case, row in ROWS.items():
        one = pooled.get(case, {}).get(champion)
        if one is None:
            continue
        if row.false is not None:
            name = f"{case}: false points in 10 000 scan lines"
            figures.append(Figure(name, one["false"], at_most=row.false))
            continue
        figures += [
            Figure(f"{case}: recall", 100 * one["recall"], "%", at_least=row.recall),
            Figure(f"{case}: precision", 100 * one["precision"], "%", at_least=row.precision),
            Figure(f"{case}: within 1 σ", 100 * one["within sigma"], "%", 75.0, 62.0),
            Figure(f"{case}: posterior, off", one["calibration"], "points", at_most=5.0),
        ]
        if row.bias is not None:
            figures.append(Figure(f"{case}: bias", abs(one["bias"]), "px", at_most=row.bias))
        figures.append(Figure(f"{case}: points in holes", 100 * one["in holes"], "%"))
    return [figure for figure in figures if not math.isnan(figure.value)]


def _bar(row: Row) -> str:
    if row.false is not None:
        return f"false < {row.false:g}"
    return f"≥ {row.recall:g} / ≥ {row.precision:g}"


def _cell(row: Row, one: dict[str, Any]) -> str:
    if row.false is not None:
        return f"false {one['false']:.1f}"
    figures = (one["recall"], one["precision"], one["in holes"])
    return " / ".join("–" if math.isnan(x) else f"{100 * x:.1f}" for x in figures)
