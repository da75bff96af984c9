"""The page: what was run, the curves, and a table for each question."""

import math
from pathlib import Path
from typing import Any

from harness import DOCS, Figure, tell
from murk_cases import CASES, HD, OTHERS, RUNGS, TRACED, Part
from murk_causes import FALSE, MISSED
from murk_judge import pool
from murk_plot import LABELS, STYLES, draw_curves
from murk_rows_page import WORDS as ROWS_WORDS
from murk_rows_page import rows_figures, rows_table
from murk_run import load_results
from murk_traced import SAMPLES
from murk_words import AFTER, CAUSES, HOW, PULL, WATERS

CHAMPION = "Murk"
_BARS: dict[str, tuple[str, str, float | None, float | None]] = {
    "recall": ("recall", "%", None, 95.0),
    "recall ≤ 0.1": ("recall, bound ≤ 0.1 px", "%", None, None),
    "recall 0.1–0.3": ("recall, bound 0.1 to 0.3 px", "%", None, None),
    "recall 0.3–0.5": ("recall, bound 0.3 to 0.5 px", "%", None, None),
    "precision": ("precision", "%", None, 99.0),
    "ratio": ("error / bound", "", 1.5, None),
    "bias": ("bias", "px", 0.02, None),
    "within sigma": ("within 1 σ, off 68.3", "points", 3.0, None),
    "calibration": ("posterior, off", "points", 3.0, None),
    "jump": ("edge in depth", "lines", 3.0, None),
    "paint": ("edge of paint", "lines", 3.0, None),
}
"""For each figure of the champion its name, its unit, and its bar: at most, at least."""
_SPEED = {"c3": 50.0, "c3-hd": 15.0}
"""Pictures a second of one core that are asked for."""

Results = dict[str, dict[str, dict[Part, dict[str, Any]]]]


def tell_page(cache: Path) -> None:
    """Make the page and the picture of all that the cache holds."""
    results = load_results(cache)
    pooled = {
        case: {name: pool(list(parts.values())) for name, parts in finders.items()}
        for case, finders in results.items()
    }
    curves = {
        name: {float(case[1:]): pooled[case][name] for case in RUNGS
               if name in pooled.get(case, {})}
        for name in STYLES
    }  # fmt: skip
    draw_curves(DOCS / "murk.png", {name: curve for name, curve in curves.items() if curve})
    note = [
        HOW.format(picture=_of_picture(pooled)), _what_was_run(results), "![Curves](murk.png)",
        "## The ladder, 720 × 576", _table_of_champion(results, pooled, RUNGS),
        "## All finders", _tables_of_all(pooled),
        "## Where points are lost", CAUSES, _table_of_causes(results),
        "## Other waters, c = 3 /m", WATERS.format(**SAMPLES),
        _table_of_champion(results, pooled, (*OTHERS, TRACED)),
        _table("recall / precision [%]", [*OTHERS, TRACED], pooled, _both),
        "## Real cameras, windows and lasers", ROWS_WORDS, rows_table(pooled),
        "## 1920 × 1200", _table_of_champion(results, pooled, HD),
        "## Pull of paint", PULL, _table("along / across the stripe [px]", list(RUNGS), pooled,
                                         _pulls),
        "## Speed", _table_of_speed(results), AFTER, "## Figures",
    ]  # fmt: skip
    title = "Finding the stripe in the murk"
    figures = _figures(results, pooled) + rows_figures(pooled, CHAMPION)
    tell("murk", title, figures, note="\n\n".join(note))


def _of_picture(pooled: dict[str, Any]) -> float:
    """Give the 10 to 90 % width of a step of paint in the picture itself."""
    known = [one["paint itself"] for one in pooled.get("c3-paint", {}).values()]
    return next((value for value in known if not math.isnan(value)), math.nan)


def _what_was_run(results: Results) -> str:
    """Say which seeds and how many pictures each finder has seen of each case."""
    told: dict[str, list[str]] = {}
    for name in STYLES:
        kinds: dict[tuple[Any, ...], list[str]] = {}
        for case in (case for case in CASES if name in results.get(case, {})):
            parts = results[case][name]
            seeds = ", ".join(str(seed) for seed in sorted(part.seed for part in parts))
            kinds.setdefault((next(iter(parts)).pictures, seeds), []).append(case)
        run = "; ".join(
            f"{', '.join(cases)}: {pictures} pictures, seed {seeds}"
            for (pictures, seeds), cases in kinds.items()
        )
        if run:
            told.setdefault(run, []).append(LABELS.get(name, name))
    return "\n".join(["What was run:", "", *(f"- {', '.join(n)}: {r}." for r, n in told.items())])


def _figures(results: Results, pooled: dict[str, Any]) -> list[Figure]:
    """Give the champion's figures, with their bars."""
    figures = []
    for case in (*RUNGS, *OTHERS, TRACED, *HD):
        if CHAMPION not in pooled.get(case, {}):
            continue
        values = _of_champion(pooled[case][CHAMPION])
        for name, (title, unit, most, least) in _BARS.items():
            if not math.isnan(values[name]):
                value = abs(values[name]) if most is not None else values[name]
                figures.append(
                    Figure(f"{case}: {title}", value, unit, at_most=most, at_least=least)
                )
        if case in _SPEED:
            speed = _speed(list(results[case][CHAMPION].values()), case)
            bar = _SPEED[case]
            figures.append(
                Figure(f"{case}: pictures a second of one core", speed, "1/s", at_least=bar)
            )
    return figures


def _of_champion(pooled: dict[str, float]) -> dict[str, float]:
    """Give the figures in the units of the bars."""
    values = dict(pooled)
    for name, (_, unit, _, _) in _BARS.items():
        values[name] *= 100 if unit == "%" else 1
    values["within sigma"] = 100 * (pooled["within sigma"] - 0.6827)
    return values


def _table_of_champion(results: Results, pooled: dict[str, Any], cases: tuple[str, ...]) -> str:
    """Give all figures of the champion, a case a row; what misses its bar is bold."""
    cases = tuple(case for case in cases if CHAMPION in pooled.get(case, {}))
    if not cases:
        return f"{CHAMPION} was not run."
    bars = [
        f"≤ {most:g}" if most is not None else f"≥ {least:g}" if least is not None else ""
        for _, _, most, least in _BARS.values()
    ]
    heads = [f"{title} {f'[{unit}]' if unit else ''} {bar}".strip().replace("  ", " ")
             for (title, unit, _, _), bar in zip(_BARS.values(), bars, strict=True)]  # fmt: skip
    rows = [["", "visible points", *heads]]
    for case in cases:
        values = _of_champion(pooled[case][CHAMPION])
        visible = sum(sum(one["visible"]) for one in results[case][CHAMPION].values())
        rows.append([case, f"{visible}", *(_cell(values[name], name) for name in _BARS)])
    return _markdown(rows)


def _cell(value: float, name: str) -> str:
    if math.isnan(value):
        return "–"
    _, unit, most, least = _BARS[name]
    missed = (most is not None and abs(value) > most) or (least is not None and value < least)
    digits = 3 if unit == "px" else 1 if unit in ("points", "lines") else 2
    text = f"{value:.{digits}f}"
    return f"**{text}**" if missed else text


def _tables_of_all(pooled: dict[str, Any]) -> str:
    parts = [
        _table("recall / precision [%]", list(RUNGS), pooled, _both),
        _table("median of abs(error) / bound / 0.6745, bound ≤ 0.3 px", list(RUNGS), pooled,
               lambda one: _number(one["ratio"], 2)),
        _table("median abs(error) of visible points [px]", list(RUNGS), pooled,
               lambda one: _number(one["absolute"], 3)),
        _table("bias [px], median", list(RUNGS), pooled, lambda one: _number(one["bias"], 3)),
    ]  # fmt: skip
    return "\n\n".join(parts)


def _both(one: dict[str, float]) -> str:
    return f"{_number(100 * one['recall'], 1)} / {_number(100 * one['precision'], 1)}"


def _pulls(one: dict[str, float]) -> str:
    return f"{_number(one['pull along'], 3)} / {_number(one['pull across'], 3)}"


def _number(value: float, digits: int) -> str:
    return "–" if math.isnan(value) else f"{value:.{digits}f}"


def _table(title: str, cases: list[str], pooled: dict[str, Any], cell: Any) -> str:
    """Give one figure of all finders, a finder a row."""
    cases = [case for case in cases if case in pooled]
    names = [name for name in STYLES if any(name in pooled[case] for case in cases)]
    rows = [[title, *cases]]
    for name in names:
        cells = [cell(pooled[case][name]) if name in pooled[case] else "–" for case in cases]
        rows.append([LABELS.get(name, name), *cells])
    return _markdown(rows)


def _table_of_causes(results: Results) -> str:
    """Give where the champion's misses and false points come from, a case a row."""
    rows = [["", *(f"missed: {one}" for one in MISSED), *(f"false: {one}" for one in FALSE)]]
    for case in CASES:
        parts = list(results.get(case, {}).get(CHAMPION, {}).values())
        if not parts:
            continue
        visible = max(sum(sum(one["visible"]) for one in parts), 1)
        found = max(sum(one["found"] for one in parts), 1)
        missed = [sum(one["causes"]["missed"][name] for one in parts) for name in MISSED]
        false = [sum(one["causes"]["false"][name] for one in parts) for name in FALSE]
        shares = [100 * n / visible for n in missed] + [100 * n / found for n in false]
        rows.append([case, *(f"{share:.2f}" for share in shares)])
    return _markdown(rows) if len(rows) > 1 else f"{CHAMPION} was not run."


def _table_of_speed(results: Results) -> str:
    """Give pictures a second of one core, and time as a ratio to decoding the same file."""
    cases = [case for case in ("c3", "c3-h264", "c3-hd") if case in results]
    rows = [["pictures a second / time in units of decoding", *cases]]
    for name in STYLES:
        cells = []
        for case in cases:
            parts = list(results[case].get(name, {}).values())
            seconds = [one["seconds"] for one in parts]
            ratio = [one["extract"] / one["decode"] for one in seconds]
            known = parts and name not in ("Oplab", "RidgeDetector")
            cells.append(f"{_speed(parts, case):.0f} / {sum(ratio) / len(ratio):.2g}" if known
                         else "–")  # fmt: skip
        if any(cell != "–" for cell in cells):
            rows.append([LABELS.get(name, name), *cells])
    return _markdown(rows)


def _speed(parts: list[dict[str, Any]], case: str) -> float:
    """Give whole pictures a second of the processor; a picture of PAL has two frames."""
    each = 1 if case in HD else 2
    frames = sum(one["seconds"]["frames"] for one in parts)
    return frames / each / sum(one["seconds"]["extract"] for one in parts)


def _markdown(rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])
