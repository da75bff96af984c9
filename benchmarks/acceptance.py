"""The acceptance test's quantities in five waters, at three speeds, by two rigs."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from acceptance_scene import (
    ACROSS,
    APART,
    BIN,
    DEPTH,
    HALF,
    RADIUS,
    RATE_HZ,
    STEP,
    Case,
    measure_case,
    scan_case,
)
from harness import Figure, tell
from kept import Kept, digest_code, make_in_pieces

from murkscan.errors import MurkscanError
from murkscan.measure.form import LEFT_OUT

ATTENUATIONS, SPEEDS = (0.3, 0.5, 1.5, 3.0, 5.0), (50.0, 100.0, 200.0)
"""[1/m] and [mm/s]."""
SEEDS, USUAL = range(100, 140), 100.0
"""Scans of each water of `COVERED` by the PAL rig, at this speed [mm/s]; no choice of the code was
made on these seeds."""
COVERED = (0.3, 1.5, 3.0)
PAL, VISION = RATE_HZ
WHAT = ("probing form", "probing size", "sphere spacing", "flatness", "length")
BARS = {"sphere spacing": 0.15, "probing form": 0.25, "flatness": 0.25}
"""Of the machine-vision rig at c = 1.5 /m [mm]."""

Result = dict[str, Any]
MADE_BY = digest_code(
    ("murkscan.simulate", "murkscan.extract", "murkscan.triangulate", "murkscan.cloud",
     "murkscan.optics.seen_points", "murkscan.measure.sample"),
    ("acceptance_scene.py", "measure_scene.py"),
)  # fmt: skip


def list_cases() -> Iterator[Case]:
    """List what is scanned, the most telling first."""
    yield Case(VISION, 1.5, USUAL, 0)
    yield from (Case(PAL, c, speed, 0) for c in ATTENUATIONS for speed in SPEEDS)
    yield from (Case(PAL, c, USUAL, seed) for seed in SEEDS for c in COVERED)
    yield from (Case(VISION, c, speed, 0) for c in ATTENUATIONS for speed in SPEEDS)


def scan_all(kept: Kept) -> dict[Case, Result]:
    """Scan as many cases as there is time for; those that are kept are there in any case."""
    found, left = dict[Case, Result](), 0
    for case in dict.fromkeys(list_cases()):
        try:
            found[case] = measure_one(case, kept)
        except TimeoutError:
            left += 1
    if left:
        print(f"out of time with {left} cases left; the same command with --keep goes on")
    return found


def measure_one(case: Case, kept: Kept) -> Result:
    """Scan one case, unless its scan is kept, and measure it; of one that is refused, say why."""
    try:
        return measure_case(case, kept.take_scan(case.name, partial(scan_case, case)))
    except MurkscanError as error:
        return {"refused": str(error)}


def table_of(found: dict[Case, Result], rig: str) -> list[str]:
    """Write the errors with their intervals, a row for each water and speed."""
    rows = [f"| c [1/m] | speed [mm/s] | {' | '.join(WHAT)} |", "|---|---|" + "---|" * len(WHAT)]
    for c in ATTENUATIONS:
        for speed in SPEEDS:
            result = found.get(Case(rig, c, speed, 0))
            cells = ["not run"] * len(WHAT)
            if result is not None and "refused" in result:
                cells = ["refused"] * len(WHAT)
            elif result is not None:
                cells = [f"{r['error']:.3f} ± {r['half_width']:.3f}" for r in map(result.get, WHAT)]
            rows.append(f"| {c:g} | {speed:g} | {' | '.join(cells)} |")
    return rows


def truth_of(what: str, results: Sequence[Result]) -> float:
    """Give the error that there is: of a form the width over the points of all scans [mm]."""
    if "bins" not in results[0][what]:
        return 0.0
    counts = np.zeros(round(2 * HALF / BIN))
    for result in results:
        counts[result[what]["bins"]] += result[what]["counts"]
    share = np.cumsum(counts) / counts.sum()
    low, high = np.searchsorted(share, [LEFT_OUT / 2, 1 - LEFT_OUT / 2])
    return float(high - low) * BIN


def coverage_of(found: dict[Case, Result]) -> list[Figure]:
    """Count how often the intervals hold the truth."""
    figures, pooled = [], list[bool]()
    for c in COVERED:
        all_of = [found.get(Case(PAL, c, USUAL, seed)) for seed in SEEDS]
        results = [one for one in all_of if one is not None and "refused" not in one]
        if len(results) < len(SEEDS) // 4:
            continue
        for what in WHAT:
            truth = truth_of(what, results)
            errors = np.array([one[what]["error"] - truth for one in results])
            widths = np.array([one[what]["half_width"] for one in results])
            held = np.abs(errors) <= widths
            pooled += held.tolist()
            name = f"c = {c:g}, {what}: {int(held.sum())} of {len(held)} intervals hold"
            figures.append(Figure(name, 100 * float(held.mean()), "%", at_least=85))
            figures.append(
                Figure(f"c = {c:g}, {what}: usual half width", float(np.median(widths)), "mm")
            )
            figures.append(
                Figure(f"c = {c:g}, {what}: mean error less the truth", float(errors.mean()), "mm")
            )
    if pooled:
        figures.append(
            Figure(f"all {len(pooled)} intervals pooled", 100 * float(np.mean(pooled)), "%",
                   at_least=93)
        )  # fmt: skip
    return figures


def bars_of(found: dict[Case, Result]) -> list[Figure]:
    """Hold the machine-vision rig at c = 1.5 /m against what was aimed at."""
    result = found.get(Case(VISION, 1.5, USUAL, 0))
    if result is None or "refused" in result:
        return []
    return [
        Figure(f"{VISION}, c = 1.5, {what}", abs(result[what]["error"]), "mm", at_most=bar)
        for what, bar in BARS.items()
    ]


def main() -> None:
    found = make_in_pieces(scan_all, code=MADE_BY)
    parts = [f"## {rig}\n\n" + "\n".join(table_of(found, rig)) for rig in RATE_HZ]
    count = sum(one.seed in SEEDS for one in found)
    tell(
        "acceptance",
        "Acceptance quantities in five waters, at three speeds",
        [*bars_of(found), *coverage_of(found)],
        note=f"""Errors in millimetres with their 95 % intervals, after VDI/VDE 2634 and
ISO 10360-13 ([accept](../accept.md)): two balls of {2 * RADIUS:g} mm, {APART:g} mm apart along the
stripe, a plate and a step of {STEP:g} mm, {DEPTH:g} mm before the simulated rigs, over
{ACROSS:g} mm of way, by `murk`; only the rows about the stripe are drawn. Fields of PAL and
pictures of {VISION} come 50 times a second. The rigs and their ways are exact here: what is off is
the finder and its noise. Where a cell says so, too little was found to tell (refused), or the case
was not run in the time there was.

{(2 * chr(10)).join(parts)}

## Do the intervals hold?

By the PAL rig at {USUAL:g} mm/s, of {count} scans with places and tilts of their own. A size, a
spacing and a length hold where the interval of the error has 0; a form and a flatness where it has
the width that the points of all scans of that water together have.

""",
    )


if __name__ == "__main__":
    main()
