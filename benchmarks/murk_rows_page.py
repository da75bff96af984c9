"""The rows beside the ladder on the page: bars, and every finder beside them."""

import math
from typing import Any

from harness import Figure
from murk_judge import DEEP_BINS
from murk_plot import LABELS, STYLES
from murk_rows import ROWS, TWO_LASERS, Row

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
attenuations a metre and the lamp of c = 6. There *false* counts points in 10 000 scan lines.

*Wide8*, *wide14*: the sheet is so thick, 1σ in pixels, and white over much of it; white centres
count as visible. *Widths*: the things are of white plastic, under which light goes on. *Speckle5*
and *7*: of contrast .5 and .7, another one in each frame. *Isp*: a gamma of .45 and sharpening.
*Denoise*: a recorder that takes .8 of the picture before where little changed. *h264-2.8*,
*h265-2.8*: at 2.8 Mbit/s; *mjpeg*: quantiser 5; *h264-hd*: 1920 × 1200 at crf 32; *h265-hd*: at
4 Mbit/s. *Lamp20*: a lamp on the vehicle, the stripe a fifth as high as what it stands on, paint
uneven by 5 %; *lamp100*: as high, and 20 %. *Roll45*, *roll63*: the laser turned by as much about
the camera's axis. *Grating*, *chain*, *blades* before a wall, rolled by 45°, where scan lines have
several branches; *pieces*: thin bars before nothing. *Bubbles*: 150 in the sheet, of 2 mm, rising.
*Crossed*, *beside*: two lasers. *c5-dim*, *c7*, *c8*: recall for bounds of .5 to 2, 2 to 4.6 and
4.6 to 10 px, right within 3 px, and precision."""


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
        figures += _deep_figures(case, row, one) + _laser_figures(case, one)
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


def _deep_figures(case: str, row: Row, one: dict[str, float]) -> list[Figure]:
    return [
        Figure(f"{case}: recall, bound {name} px", 100 * one[f"recall {name}"], "%", at_least=bar)
        for name, bar in zip(DEEP_BINS, row.deep, strict=False)
        if bar is not None
    ]


def _laser_figures(case: str, one: dict[str, float]) -> list[Figure]:
    """Give the share of right points that are told under the laser whose they are."""
    share = 100 * one["lasers"]
    return [Figure(f"{case}: under the right laser", share, "%", at_least=99.0)] * (
        case in TWO_LASERS
    )


def _bar(row: Row) -> str:
    if row.false is not None:
        return f"false < {row.false:g}"
    if row.deep:
        asked = " / ".join("–" if bar is None else f"≥ {bar:g}" for bar in row.deep)
        return f"{asked}; P ≥ {row.precision:g}"
    return f"≥ {row.recall:g} / ≥ {row.precision:g}"


def _cell(row: Row, one: dict[str, Any]) -> str:
    if row.false is not None:
        return f"false {one['false']:.1f}"
    figures: tuple[float, ...] = (one["recall"], one["precision"], one["in holes"])
    if row.deep:
        figures = (*(one[f"recall {name}"] for name in DEEP_BINS), one["precision"])
    return " / ".join("–" if math.isnan(x) else f"{100 * x:.1f}" for x in figures)
