"""The judge of finders on real recordings: how much of the line each finds, and what else.

Usage: python benchmarks/real.py [SET ...] [--only NAME ...] [--dump FILE] [--overlays FOLDER]

One set and one finder, in seconds:
python benchmarks/real.py stage_pyramid --only murk --dump x.csv
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from murk_finders import PEERS
from real_judge import Judged, failures, judge, pool
from real_overlay import draw_overlays
from real_sets import SETS, RealSet, Shot
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
    cv2.setNumThreads(1)
    finders = FINDERS | {"maximum": PEERS["Maximum"], "find-peaks": PEERS["FindPeaks"]}
    names = options.only or list(FINDERS)
    dumped = ["recording,frame,scan_line,position,what,why"]
    for name in options.sets or SETS:
        found = [find_all(shot, finders, names) for shot in SETS[name].shots]
        judged = [one.judge(names) for one in found]
        tell_set(SETS[name], found, judged, names)
        for one, verdict in zip(found, judged, strict=True):
            for finder in names:
                dumped += [f"{finder}:{row}" for row in failures(one.shot.name, verdict[finder])]
            if options.overlays is not None:
                draw_overlays(options.overlays, one.shot, one.frames, verdict)
    if options.dump is not None:
        options.dump.write_text("\n".join(dumped) + "\n", "utf-8")


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sets", nargs="*", metavar="SET", help=", ".join(SETS))
    parser.add_argument("--only", nargs="+", help="finders to judge")
    parser.add_argument("--dump", type=Path, help="list missed and false points here")
    parser.add_argument("--overlays", type=Path, help="draw what was found into this folder")
    return parser.parse_args()


def find_all(shot: Shot, finders: dict[str, AbstractExtractor], names: Sequence[str]) -> Found:
    """Run all finders that are judged, and those that are asked about them."""
    with shot.opened() as recording:
        frames, sample = list(recording.frames()), recording.sample(_LEARNT_FROM)
    stripes = {}
    for name in dict.fromkeys((*FINDERS, *names)):
        background = finders[name].learn(sample, shot.rig)
        found = finders[name].extract(frames, shot.rig, background)
        stripes[name] = Stripe.concatenate(list(found))
    return Found(shot, frames, stripes)


def tell_set(
    one: RealSet, found: list[Found], judged: list[dict[str, Judged]], names: Sequence[str]
) -> None:
    """Print the figures of one set."""
    for name in names:
        figures = pool([verdict[name] for verdict in judged])
        told = ", ".join(f"{key} {value:.5g}" for key, value in figures.items())
        print(f"{one.name} {name}: {told}", flush=True)
        for recording in found:
            stripe = recording.stripes[name]
            steps = shares_of_steps(recording.shot, recording.rows(name))
            for told in (*stage_heights(recording.shot, stripe), *([steps] if steps else [])):
                print(f"    {told}")


if __name__ == "__main__":
    main()
