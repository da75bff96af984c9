"""The judge of finders: how many points each finds, and how well, in ever murkier water.

Usage: python benchmarks/murk.py [--cases c3 ...] [--seeds 10 ...] [--pictures N] [--only NAME ...]
"""

import argparse
import json
import math
import os
import tempfile
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("NUMBA_NUM_THREADS", "1")

import cv2
from murk_cases import CASES, Part, parts_of
from murk_finders import PEERS, own_finders
from murk_judge import judge, pool
from murk_match import match_stripes

from murkscan.extract import AbstractExtractor
from murkscan.types.stripe import Stripe

_LEARNT_FROM = 24
"""Frames that a finder learns from: as many as `murkscan scan` takes."""
SHOWN = ("recall", "recall ≤ 0.1", "recall 0.1–0.3", "recall 0.3–0.5", "precision", "ratio", "bias",
         "mean", "absolute", "within sigma", "calibration", "jump", "paint", "pull along",
         "pull across")  # fmt: skip


def main() -> None:
    options = parse_options()
    cv2.setNumThreads(1)
    with tempfile.TemporaryDirectory() as temporary:
        cache = options.cache or Path(temporary)
        finders = {
            name: finder
            for name, finder in {**own_finders(), **PEERS}.items()
            if not options.only or name in options.only
        }
        for part in parts_of(options.cases, options.seeds, options.pictures, options.pictures_hd):
            for name, finder in finders.items():
                if not part.case.endswith("-hd") or name not in PEERS:
                    run(part, name, finder, cache)
                    show(part, name, cache)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", "--rungs", nargs="+", default=list(CASES), choices=CASES)
    parser.add_argument("--seeds", nargs="+", type=int, default=[10, 11, 12])
    parser.add_argument("--pictures", type=int, default=120, help="of 720 × 576 px")
    parser.add_argument("--pictures-hd", type=int, default=40, help="of 1920 × 1200 px")
    parser.add_argument("--only", nargs="+", help="finders to run")
    parser.add_argument("--cache", type=Path, help="keep pictures and results here")
    return parser.parse_args()


def run(part: Part, name: str, finder: AbstractExtractor, cache: Path) -> None:
    """Judge one finder by one recording, and keep the result as JSON."""
    recorded = part.recorded(cache)
    recording, rig = recorded.recording, recorded.rig
    sample, frames = recording.sample(_LEARNT_FROM), list(recording.frames())
    start = time.process_time()
    background = finder.learn(sample, rig)
    learnt = time.process_time()
    found = Stripe.concatenate(list(finder.extract(frames, rig, background)))
    done = time.process_time()
    result = judge(match_stripes(found, recorded.truth))
    result["seconds"] = {"learn": learnt - start, "extract": done - learnt, "frames": len(frames)}
    path = result_path(part, name, cache)
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(result), "utf-8")


def result_path(part: Part, name: str, cache: Path) -> Path:
    return cache / part.name / "judged" / f"{name}.json"


def load_result(part: Part, name: str, cache: Path) -> dict[str, Any]:
    return json.loads(result_path(part, name, cache).read_text("utf-8"))


def show(part: Part, name: str, cache: Path) -> None:
    """Print one line of figures."""
    result = load_result(part, name, cache)
    figures = pool([result])
    line = " ".join(
        f"{figure} {figures[figure]:.3f}" for figure in SHOWN if not math.isnan(figures[figure])
    )
    seconds = result["seconds"]
    print(f"{part.name} {name}: {line} | {1e3 * seconds['extract'] / seconds['frames']:.1f} ms",
          flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
