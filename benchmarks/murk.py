"""The judge of finders: how many points each finds, and how well, in ever murkier water.

Usage: python benchmarks/murk.py [--cases c3 ...] [--seeds 10 ...] [--pictures N] [--only NAME ...]

All of it takes half an hour on two cores, with --peers three quarters. It can be run in parts that
share a --cache; --page then makes the page of what is there:
python benchmarks/murk.py --cases --cache DIR --page

A quick look while tuning, at 20 pictures of one rung, which the folder keeps for the next time:
python benchmarks/murk.py --cases c3 --seeds 0 --pictures 20 --only Murk --cache DIR
"""

import argparse
import contextlib
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import cv2
import numba
from murk_cases import CASES, HD, Part, parts_of
from murk_finders import PEERS, own_finders
from murk_foreign import foreign_finders
from murk_judge import pool
from murk_page import tell_page
from murk_run import judge_part

from murkscan.extract import AbstractExtractor

SHOWN = ("recall", "recall ≤ 0.1", "recall 0.1–0.3", "recall 0.3–0.5", "recall 0.5–2",
         "recall 2–4.6", "recall 4.6–10", "precision", "false", "in holes", "lasers", "ratio",
         "bias", "mean", "absolute", "within sigma", "calibration", "jump", "paint", "pull along",
         "pull across")  # fmt: skip


def main() -> None:
    options = parse_options()
    cv2.setNumThreads(1)
    numba.set_num_threads(1)
    with kept_in(options.cache) as cache:
        finders = choose_finders(options)
        for part in parts_of(options.cases, options.seeds, options.pictures, options.pictures_hd):
            run_part(part, finders, cache)
        if options.page or options.is_all:
            tell_page(cache)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", "--rungs", nargs="*", choices=CASES, help="default: all")
    parser.add_argument("--seeds", nargs="+", type=int, default=[10, 11, 12])
    parser.add_argument("--pictures", type=int, default=120, help="of 720 × 576 px")
    parser.add_argument("--pictures-hd", type=int, default=40, help="of 1920 × 1200 px")
    parser.add_argument("--only", nargs="+", help="finders to run")
    parser.add_argument("--cache", type=Path, help="keep pictures and results here")
    parser.add_argument("--peers", type=Path, help="an environment for other packages' finders")
    parser.add_argument("--page", action="store_true", help="make the page of what the cache holds")
    options = parser.parse_args()
    options.is_all = options.cases is None and options.only is None
    options.cases = list(CASES) if options.cases is None else options.cases
    return options


@contextlib.contextmanager
def kept_in(cache: Path | None) -> Iterator[Path]:
    """Give the folder of pictures and results, or one that is gone afterwards."""
    if cache is not None:
        cache.mkdir(parents=True, exist_ok=True)
        yield cache
        return
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def choose_finders(options: argparse.Namespace) -> dict[str, AbstractExtractor]:
    """Give the finders that are asked for, by name."""
    finders = own_finders() | PEERS
    if options.peers is not None:
        finders |= foreign_finders(options.peers)
    return {name: finders[name] for name in finders if not options.only or name in options.only}


def run_part(part: Part, finders: dict[str, AbstractExtractor], cache: Path) -> None:
    """Judge finders by one recording, and print a line for each; peers see PAL alone."""
    own = own_finders()
    for name, finder in finders.items():
        if part.case in HD and name not in own:
            continue
        result = judge_part(part, name, finder, cache)
        figures, seconds = pool([result]), result["seconds"]
        told = (f"{one} {figures[one]:.3f}" for one in SHOWN if not math.isnan(figures[one]))
        each = 1e3 * seconds["extract"] / seconds["frames"]
        print(f"{part.name} {name}: {', '.join(told)}, {each:.1f} ms a frame", flush=True)


if __name__ == "__main__":
    main()
