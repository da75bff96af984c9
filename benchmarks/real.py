"""The judge of finders on real recordings: how much of the line each finds, and what else.

Usage: python benchmarks/real.py [SET ...] [--only NAME ...] [--dump FILE] [--overlays FOLDER]

One set and one finder, in seconds:
python benchmarks/real.py stage_pyramid --only murk --dump x.csv

All sets and finders, which makes the page, take three minutes of one core; with --peers, those that
users write themselves are judged, too, and with --peers FOLDER those of other packages.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from harness import DATA, skip
from murk_finders import PEERS
from murk_foreign import Foreign, foreign_finders
from real_judge import Judged, failures, judge
from real_overlay import draw_overlays
from real_page import SetResult, tell_page
from real_sets import SETS, Shot
from real_stage import stage_heights
from real_steps import shares_of_steps
from real_truth import Lines, as_rows, by_line, load_drawing, tell_truth

from murkscan import GaussianFit, GrayGravity, Murk, Steger, Stripe, ThresholdSkeleton
from murkscan.extract import AbstractExtractor
from murkscan.types.frame import Frame

FINDERS: dict[str, AbstractExtractor] = {
    "threshold-skeleton": ThresholdSkeleton(),
    "gray-gravity": GrayGravity(),
    "gaussian": GaussianFit(),
    "steger": Steger(),
    "murk": Murk(),
}
_LEARNT_FROM = 24
"""Frames that a finder learns from: as many as `murkscan scan` takes."""


@dataclass(frozen=True)
class Found:
    """What each finder found in one recording."""

    shot: Shot
    frames: list[Frame]
    stripes: dict[str, Stripe]

    @property
    def axis(self) -> str:
        """The camera's axis along which scan lines run."""
        return self.shot.rig.laser(0).axis

    def rows(self, name: str) -> np.ndarray:
        """Give frame, scan line and position of each centre of one finder."""
        return as_rows(self.stripes[name], self.axis)

    def judge(self, names: Sequence[str]) -> dict[str, Judged]:
        """Judge finders."""
        height, width = self.frames[0].image.shape
        length, num_lines = (width, height) if self.axis == "x" else (height, width)
        drawing = load_drawing(self.shot.name, num_lines)
        lines: dict[str, Lines] = {name: by_line(self.rows(name)) for name in self.stripes}
        return {
            name: judge(self.rows(name), tell_truth(drawing, name, lines), length=length)
            for name in names
        }


def main() -> None:
    options = parse_options()
    if not all(shot.is_here for one in SETS.values() for shot in one.shots):
        skip("real", f"the real recordings are not in {DATA}")
    cv2.setNumThreads(1)
    finders = choose_finders(options)
    names = options.only or list(finders)
    dumped = ["finder,recording,frame,scan_line,position,what,why"]
    results = []
    for name in options.sets or SETS:
        results.append(judge_set(name, finders, names, options.overlays, dumped))
        print(results[-1].as_table(), flush=True)
    if options.dump is not None:
        options.dump.write_text("\n".join(dumped) + "\n", "utf-8")
    if not options.sets and not options.only:
        tell_page(results)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sets", nargs="*", metavar="SET", help=", ".join(SETS))
    parser.add_argument("--only", nargs="+", metavar="NAME", help="finders to judge")
    parser.add_argument("--dump", type=Path, help="list missed and false points here")
    parser.add_argument("--overlays", type=Path, help="draw what was found into this folder")
    parser.add_argument(
        "--peers", nargs="?", const="", metavar="FOLDER", help="judge peers, too; those of other "
        "packages live in the environment FOLDER, which is made where there is none",
    )  # fmt: skip
    options = parser.parse_args()
    if unknown := set(options.sets) - SETS.keys():
        parser.error(f"no set {', '.join(sorted(unknown))}; there are {', '.join(SETS)}")
    if unknown := set(options.only or ()) - choose_finders(options).keys():
        parser.error(f"no finder {', '.join(sorted(unknown))}")
    return options


def choose_finders(options: argparse.Namespace) -> dict[str, AbstractExtractor]:
    """Give the finders that can be judged, by name."""
    if options.peers is None:
        return FINDERS
    finders = FINDERS | {"maximum": PEERS["Maximum"], "find-peaks": PEERS["FindPeaks"]}
    if not options.peers:
        return finders
    foreign = foreign_finders(Path(options.peers))
    return finders | {"oplab": foreign["Oplab"], "ridge-detector": foreign["RidgeDetector"]}


def judge_set(
    name: str,
    finders: dict[str, AbstractExtractor],
    names: Sequence[str],
    overlays: Path | None,
    dumped: list[str],
) -> SetResult:
    """Judge finders by one set, and add what went wrong to `dumped`."""
    one = SETS[name]
    found = [find_all(shot, finders, names) for shot in one.shots]
    judged = [each.judge(names) for each in found]
    for each, verdict in zip(found, judged, strict=True):
        for finder in names:
            dumped += [f"{finder},{row}" for row in failures(each.shot.name, verdict[finder])]
        if overlays is not None:
            draw_overlays(overlays, each.shot, each.frames, verdict)
    heights = {n: [h for f in found for h in stage_heights(f.shot, f.stripes[n])] for n in names}
    steps = {n: s for n in names for f in found if (s := shares_of_steps(f.shot, f.rows(n)))}
    return SetResult(one, {n: [v[n] for v in judged] for n in names}, heights, steps)


def find_all(shot: Shot, finders: dict[str, AbstractExtractor], names: Sequence[str]) -> Found:
    """Run all finders that are judged, and those that are asked about them."""
    with shot.opened() as recording:
        frames, sample = list(recording.frames()), recording.sample(_LEARNT_FROM)
    asked = dict.fromkeys((*FINDERS, *names))
    return Found(shot, frames, {n: find(shot, finders[n], frames, sample) for n in asked})


def find(
    shot: Shot, finder: AbstractExtractor, frames: list[Frame], sample: Sequence[Frame]
) -> Stripe:
    """Run one finder; peers know only scan lines that are columns, and get pictures turned."""
    is_turned = isinstance(finder, (Foreign, *map(type, PEERS.values())))
    is_turned &= shot.rig.laser(0).axis == "x"
    if is_turned:
        frames, sample = [turn(one) for one in frames], [turn(one) for one in sample]
    background = finder.learn(sample, shot.rig)
    found = Stripe.concatenate(list(finder.extract(frames, shot.rig, background)))
    return replace(found, pixels=found.pixels[:, ::-1]) if is_turned else found


def turn(frame: Frame) -> Frame:
    """Swap rows and columns of a frame."""
    return replace(frame, image=np.ascontiguousarray(frame.image.T))


if __name__ == "__main__":
    main()
