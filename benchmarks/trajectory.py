"""How well a vehicle's trajectory is corrected from what its scans show of the same places.

Run: python benchmarks/trajectory.py [--keep FOLDER] [--seconds S] [--seeds N] [--cases "A;B"]
"""

import argparse
import resource
import time
from dataclasses import asdict
from itertools import combinations
from pathlib import Path

import numpy as np
from harness import DATA, Figure, tell
from kept import Kept
from scipy.spatial import cKDTree
from trajectory_merge import clock_pull, length_pulls, register, start_from
from trajectory_scene import Case, make_dive
from trajectory_ties import judge_ties

from murkscan.motion.adjust import adjust_passes

REAL = ("bus_outside", "cave", "cemetery")
CASES = {
    "one pass, two sheets, log a": (
        Case(log="a", passes=1),
        {"surface": 0.1, "place": 0.4, "length": 0.7},
    ),
    "one pass, two sheets, log b": (
        Case(log="b", passes=1),
        {"surface": 0.1, "place": 0.4, "length": 0.7},
    ),
    "one pass, real motion, two sheets, log a": (
        Case(passes=1, motion="real"),
        {"surface": 0.1, "place": 0.4, "length": 0.7},
    ),
    "one pass, speed ± 40 %, stand-off ± 50 mm, two sheets, log c": (
        Case(log="c", passes=1, speed_swing=0.4 / 2**0.5, stand_off_swing=0.05),
        {"surface": 0.2, "length": 1.0},
    ),
    "one pass, speed ± 40 %, stand-off ± 50 mm, two sheets, log b": (
        Case(log="b", passes=1, speed_swing=0.4 / 2**0.5, stand_off_swing=0.05),
        {},
    ),
    "one pass over seams and anodes, two sheets, log a": (
        Case(relief="seams", passes=1),
        {"surface": 0.3},
    ),
    "one pass over a plain plate, two sheets, log a": (
        Case(relief="plain", passes=1),
        {"surface": 0.1, "place to logged": 1.0},
    ),
    "hull, two sheets, log a": (Case(log="a"), {"surface": 0.1, "place": 0.4, "length": 0.7}),
    "hull, two sheets, log b": (Case(log="b"), {"surface": 0.1, "place": 0.4, "length": 0.7}),
    "hull, two sheets, log c": (Case(log="c"), {"surface": 0.1, "place": 0.4, "length": 0.7}),
    "hull, one sheet, log a": (Case(log="a", sheets=1), {"surface": 0.9, "to rigid": 0.5}),
    "hull, one sheet and a crossing pass, log a": (
        Case(log="a", sheets=1, crossing=True),
        {"surface": 0.5, "to rigid": 0.5},
    ),
    "hull, one sheet, log b": (Case(log="b", sheets=1), {"seams": 0.3, "to logged": 1.0}),
    "hull, one sheet, log c": (Case(log="c", sheets=1), {"seams": 0.3, "to logged": 1.0}),
    "seams and anodes, two sheets, log a": (Case(relief="seams"), {"surface": 0.3}),
    "plain plate, two sheets, log a": (
        Case(relief="plain"),
        {"surface": 0.1, "place to logged": 1.0},
    ),
    "plain plate, two sheets, log b": (
        Case(relief="plain", log="b"),
        {"surface": 0.1, "place to logged": 1.0},
    ),
    "speed ± 40 %, stand-off ± 50 mm, two sheets, log c": (
        Case(log="c", speed_swing=0.4 / 2**0.5, stand_off_swing=0.05),
        {"surface": 0.2, "length": 1.0},
    ),
    "20 m long, two sheets, log a": (Case(passes=1, length=20.0), {"surface": 0.25}),
    "two passes of 1 m in waves, one sheet, log a": (
        Case(sheets=1, passes=2, length=1.0, motion="waves", clock=0.01),
        {"to rigid": 1.0},
    ),
    "real motion, two sheets, log a": (
        Case(motion="real"),
        {"surface": 0.1, "place": 0.4, "length": 0.7},
    ),
}
"""Each case with its bars of every seed: in mm, and of surface or place as a share of another's."""
RIM = 2
"""Profiles at each end of a pass whose facets lack neighbours, or whose neighbours do."""
SAME = 3e-3
"""Distance up to which true points of two passes count as one place [m]."""
KINDS = ("surface", "place", "length")
WAYS = ("as logged", "rigid", "rigid at its best", "adjusted")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keep", type=Path, default=Path("trajectory-kept"))
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--cases", default="", help="parts of names of cases to run, by semicolons")
    given = parser.parse_args()
    given.keep.mkdir(parents=True, exist_ok=True)
    kept = Kept(given.keep, time.monotonic() + given.seconds)
    chosen = [n for n in CASES if not given.cases or any(c in n for c in given.cases.split(";"))]
    done: dict[str, list] = {name: [] for name in chosen}
    is_stopped = False
    # Seed by seed, so that a run that is stopped has something of every case.
    for seed in range(given.seeds):
        for name in chosen:
            try:
                done[name].append(run_kept(kept, name, seed))
            except TimeoutError:
                is_stopped = True
    if is_stopped:
        print("stopped; run the same command again to go on")
    tell_all(done)


def run_kept(kept, name, seed):
    """Run one case with one seed, or take what is kept of it; None where its data are not here."""
    case, _ = CASES[name]
    if case.motion == "real":
        if not (DATA / "underwater_trajectories").exists():
            return None
        case = Case(**{**asdict(case), "motion": REAL[seed % len(REAL)]})
    file = name.replace(" ", "_").replace(",", "").replace("%", "percent")
    return kept.take(f"{file}-{seed}", lambda: run(name, case, seed))


def run(name, case, seed):
    """Adjust one dive as `murkscan scan` and `murkscan merge` do, and compare it with the truth."""
    dive = make_dive(case, seed)
    times = [one.times for one in dive.passes]
    start, cpu = time.perf_counter(), time.process_time()
    alone = [adjust_passes([one]) for one in dive.passes]
    logged = [found.as_logged[0].as_trajectory(at) for found, at in zip(alone, times, strict=True)]
    laid = [found.paths[0].as_trajectory(at) for found, at in zip(alone, times, strict=True)]
    if len(dive.passes) == 1:
        adjusted = alone[0]
    else:
        laid = [
            way.carry(pose) for way, pose in zip(laid, register(dive.passes, laid), strict=True)
        ]
        adjusted = adjust_passes(start_from(dive.passes, laid))
    seconds, cpu = time.perf_counter() - start, time.process_time() - cpu
    ways = [path.as_trajectory(at) for path, at in zip(adjusted.paths, times, strict=True)]
    placed = [place_points(dive, one, times) for one in (logged, laid, ways)]
    placed.insert(2, lay_rigidly(placed[0], dive))
    results = {
        **{way: judge(points, dive) for way, points in zip(WAYS, placed, strict=True)},
        "pulls": length_pulls(dive, adjusted),
        "clock": clock_pull(adjusted, case.clock),
        "ties": judge_ties(dive) if (case.passes, case.sheets) == (1, 2) else None,
        "blind": adjusted.blind,
        "seams": asdict(adjusted.seams),
        "astray": adjusted.astray,
        "seconds": seconds,
        "cpu": cpu,
        "gigabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
    }
    print(name, seed, results, flush=True)
    return results


def place_points(dive, ways, times):
    """Carry each pass's true points into the world along some ways."""
    return [
        way.transform(truth.own, moments[truth.profile])
        for way, truth, moments in zip(ways, dive.truths, times, strict=True)
    ]


def lay_rigidly(placed, dive):
    """Lay each pass on its truth as one rigid body: the best that any rigid merge could do."""
    return [fit_rigid(p, truth.world) for p, truth in zip(placed, dive.truths, strict=True)]


def fit_rigid(points, truth):
    """Move points onto their truth by one rotation and one shift (Kabsch 1976)."""
    ours, theirs = points.mean(axis=0), truth.mean(axis=0)
    u, _, vt = np.linalg.svd((points - ours).T @ (truth - theirs))
    flip = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    return (points - ours) @ (u @ flip @ vt) + theirs


def judge(placed, dive):
    """Compare with the truth after one rigid alignment: RMS in mm."""
    truth = np.concatenate([t.world for t in dive.truths])
    off = fit_rigid(np.concatenate(placed), truth) - truth
    across = np.einsum("ni,ni->n", off, dive.hull.normals(truth))
    sizes = (
        across,
        np.linalg.norm(off, axis=1),
        lengths_of(placed, dive),
        lengths_of(placed, dive, RIM),
    )
    found = dict(zip((*KINDS, "inner length"), sizes, strict=True))
    if len(placed) > 1:
        found["seams"] = seams_of(across, dive)
    return {k: float(1e3 * np.sqrt(np.mean(np.square(s)))) for k, s in found.items()}


def lengths_of(placed, dive, without=0):
    """Give errors of the passes' lengths, as of 2 m; without some profiles at both ends [m]."""
    found = []
    for points, one in zip(placed, dive.truths, strict=True):
        middle = np.flatnonzero(one.line == np.median(one.line).astype(int))
        ends = middle[[without, -1 - without]]
        true = np.linalg.norm(np.diff(one.world[ends], axis=0))
        found.append((np.linalg.norm(np.diff(points[ends], axis=0)) - true) * 2 / true)
    return found


def seams_of(across, dive):
    """Give how far passes lie apart across the surface where both saw it [m]."""
    errors = np.split(across, np.cumsum([len(one.world) for one in dive.truths])[:-1])
    trees = [cKDTree(one.world) for one in dive.truths]
    found = []
    for i, j in combinations(range(len(trees)), 2):
        some = np.arange(0, len(errors[i]), 7)
        away, which = trees[j].query(dive.truths[i].world[some], distance_upper_bound=SAME)
        near = np.isfinite(away)
        found.append(errors[i][some[near]] - errors[j][which[near]])
    return np.concatenate(found)


def figures_of(name, done):
    """Give the worst of the seeds of one case, beside its bars."""
    bars, adjusted = CASES[name][1], [one["adjusted"] for one in done]
    for kind in adjusted[0]:
        worst = max(one[kind] for one in adjusted)
        yield Figure(f"{name}: {kind}, worst of {len(done)}", worst, "mm", bars.get(kind))
    clocks = [one["clock"] for one in done if one["clock"]]
    if clocks:
        worst = max(abs(error) for error, _ in clocks)
        yield Figure(f"{name}: clock, worst of {len(clocks)}", worst, "ms", 5)
        spread = float(np.sqrt(np.mean([pull**2 for _, pull in clocks])))
        yield Figure(f"{name}: clock, error / σ, RMS of {len(clocks)}", spread, "")
    ties = [one["ties"] for one in done if one["ties"]]
    if ties:
        error, together = np.mean(ties, axis=0)
        yield Figure(f"{name}: ties where they truly lie, mean square error / stated", error, "")
        yield Figure(
            f"{name}: the same, of sums over half a second / if each by itself", together, ""
        )
    for bar, kind, other in (
        ("to rigid", "surface", "rigid"),
        ("to logged", "surface", "as logged"),
        ("place to logged", "place", "as logged"),
    ):
        if bar in bars:
            worst = max(one["adjusted"][kind] / one[other][kind] for one in done)
            words = f"{name}: {kind}, as a share of that {other}, worst of {len(done)}"
            yield Figure(words, worst, "", bars[bar])


def tell_all(results):
    """Write the page: the worst and the middle seed of each case."""
    figures, rows = [], []
    for name, seeds in results.items():
        done = [one for one in seeds if one is not None]
        if not done:
            continue
        figures += figures_of(name, done)
        kinds = [*KINDS, "seams"] if "seams" in done[0]["adjusted"] else KINDS
        cells = [
            " / ".join(f"{np.median([one[way][k] for one in done]):.3g}" for k in kinds)
            for way in WAYS
        ]
        pulls = np.concatenate([one["pulls"] for one in done])
        spread = f"{np.sqrt(np.mean(pulls**2)):.2g}"
        cpu = np.median([one["cpu"] for one in done])
        rows.append(f"| {name} | {' | '.join(cells)} | {spread} | {cpu:.0f} |")
    ran = [one for seeds in results.values() for one in seeds if one is not None]
    if ran:
        pulls = np.concatenate([one["pulls"] for one in ran])
        within = 100 * float(np.mean(np.abs(pulls) < 1.96))
        figures.append(Figure("lengths within their stated 95 %", within, "%", at_least=93))
        slowest = max(one["cpu"] for one in ran)
        figures.append(Figure("CPU time of a case, at most", slowest, "s", at_most=40))
    tell(
        "trajectory",
        "A trajectory corrected from the scan itself",
        figures,
        note=NOTE + "\n".join([HEAD, *rows]) + "\n\nThe worst seed of each case:",
    )


NOTE = """\
Profiles made from geometry: four passes of 2 m side by side, 30 % over one another, every second
one backwards, 500 profiles of 300 points a sheet and pass, 0.15 mm of noise along each ray; a hull
of R 5 to 10 m with 0.5 to 1.5 mm (RMS) of growth that goes together over 8 to 20 mm. Two sheets lie
10 to 20° apart. Log a: DVL (3 mm/s noise, 1 mm/s bias), roll and pitch (0.1° noise, 0.2° bias),
heading drifting by 0.5°/min, depth to 5 mm, ten readings a second. Log b: as a without DVL; the
speed is known to 10 % and wanders by 20 %. Log c: no instrument at all; about 0.1 m/s, straight on.
Each pass begins at a place known to 30 mm. *As logged* is not the raw log but the smooth path that
fits it best. Each pass is corrected alone as `murkscan scan` does (with one sheet it stays as
logged); *rigid* then lays the passes on one another by `align_clouds`, as `murkscan merge --rigid`
does, and *adjusted* adjusts them together from there, as `murkscan merge`; of one pass it is that
of the scan. *Rigid at its best* lays each pass as logged on the truth as a rigid body, which no
registration can better. Errors are RMS against the truth after one rigid alignment of everything,
of points without noise: *surface* across the true surface, *place* of a physical point, *length*
over 2 m along a pass, from its first profile to its last, and *inner length* without two at each
end, which no facet ties: they lie where the way leads; *seams* how far passes lie apart across the
surface where both saw it. Real motion: stretches of `../shared/data/underwater_trajectories` in
which the vehicle turns least, scaled to 0.1 m/s; they set no setting. Waves: a vehicle of ours in a
sea of 5 s, as in the scene `two-lasers`, whose log is stamped 10 ms late, while nothing is known of
its clock.

What limits lengths of one pass: a profile's facets err by 0.12 mm between two sheets, on slopes of
0.05, so that 70 of them know where it was to some 0.3 mm; neighbours make that better in the middle
of a way, and on one side only at its ends. What limits places: motion that repeats itself in the
time from one sheet to the other, some 2.5 s, which both see alike. Errors drawn from what is stated
come to 0.15 mm across the surface and 0.4 mm in place with log a, 0.19 and 0.77 mm with log b: bars
of one pass are beyond what its log and its ties tell. With log c the way stays bent: a vehicle that
heaves and pitches just so makes both sheets see any bend of the surface along the way alike, so
that ties leave it open, and what is assumed of how vehicles pitch decides. The same ways with log
b, whose attitude is measured, are bent by a twentieth of that. The record of `cave` (seed 1 of real
motion) jumps, by up to 7 m/s²: relief does not lie on its like for 5 s, by which a scan tells that
a correction is not sound, and keeps its log; its figures are those of the correction. Of seams and
anodes, three seams that go across fix a way of 2 m to some 5 mm; between them it goes as logged.
That is a quarter of what the log states, and a log whose bias happens to be small may lie nearer.
Two rows of each case tell how ties err where the true way puts them: their mean square error over
what is stated, and the same of their sums over half a second. Near 1, they err by themselves.

Seeds 0 to 2 and 10 set the code. By that earlier code, 12 to 15 of real motion, which set nothing,
came to 0.21 to 0.26 mm across the surface and to 1.3 to 2.8 mm in place, of 2.7 to 9.5 mm as
logged; one of them (12) was not believed: for 2.9 s its relief was not on its like. By it, too,
seeds 3 and 7 to 11 in waves, which set nothing, found the clock to 4.0 ms (RMS), 0.87 of what is
stated, and to 6.4 ms at worst. Two passes of 1 m tell it to 4 ms: a bar of 5 ms of every seed is
beyond them.

The page holds the cases and seeds that were run to the end, and no others; *worst of N* says how
many seeds. *Error / σ* is that of a pass's length over what `Trajectory.errors` states: 1 would be
right, above 1 the stated deviation is too small.

Median of the seeds, surface / place / length / seams [mm]:

"""
HEAD = (
    "| case | as logged | rigid | rigid at its best | adjusted | length: error / σ, RMS | CPU [s] "
    "|\n"
    "|---|---|---|---|---|---|---|"
)


if __name__ == "__main__":
    main()
