"""One finder on one recording: its figures, its time, and where both are kept."""

import json
import time
from pathlib import Path
from typing import Any

from murk_cases import Part
from murk_foreign import STEP, Foreign
from murk_judge import judge
from murk_match import match_stripes, pick_frames

from murkscan.extract import AbstractExtractor
from murkscan.types.frame import Frame
from murkscan.types.stripe import Stripe

_LEARNT_FROM = 24
"""Frames that a finder learns from: as many as `murkscan scan` takes."""
_WARM = 10
"""Frames by which compiled loops are made ready before time is taken."""
_JUDGED = "judged"


def judge_part(part: Part, name: str, finder: AbstractExtractor, cache: Path) -> dict[str, Any]:
    """Judge one finder by one recording, and keep the result as JSON."""
    recorded = part.recorded(cache)
    recording, rig = recorded.recording, recorded.rig
    start = time.process_time()
    frames = list(recording.frames())
    decode = time.process_time() - start
    if isinstance(finder, Foreign):
        frames = frames[::STEP]
    sample = recording.sample(_LEARNT_FROM)
    runs = [_extract(finder, frames, sample, rig, laser) for laser in range(len(rig.lasers))]
    found = Stripe.concatenate([stripe for stripe, _ in runs])
    seconds = {name: sum(spent[name] for _, spent in runs) for name in ("extract", "clock")}
    seconds["frames"] = len(frames)
    truth = pick_frames(recorded.truth, [frame.index for frame in frames])
    lines = len(frames) * rig.camera.size[0]
    matched = match_stripes(found, truth, part.paint(truth), visible=part.visible, reach=part.reach)
    result = judge(matched, lines)
    result["seconds"] = seconds | {"decode": decode}
    path = cache / part.name / _JUDGED / f"{name}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(result), "utf-8")
    return result


def _extract(
    finder: AbstractExtractor, frames: list[Frame], sample: list[Frame], rig: Any, laser: int
) -> tuple[Stripe, dict[str, float]]:
    """Find one laser's stripe in all frames; take the processor's time and the clock's [s]."""
    background = finder.learn(sample, rig, laser=laser)
    if not isinstance(finder, Foreign):
        list(finder.extract(frames[:_WARM], rig, background, laser=laser))
    clock, start = time.perf_counter(), time.process_time()
    found = Stripe.concatenate(list(finder.extract(frames, rig, background, laser=laser)))
    spent, passed = time.process_time() - start, time.perf_counter() - clock
    return found, {"extract": spent, "clock": passed}


def load_results(cache: Path) -> dict[str, dict[str, dict[Part, dict[str, Any]]]]:
    """Give what the cache holds, by case, finder and part; of each case its longest parts alone."""
    results: dict[str, dict[str, dict[Part, dict[str, Any]]]] = {}
    parts = {path: _part_of(path.parent.parent.name) for path in cache.glob(f"*/{_JUDGED}/*.json")}
    longest = {one.case: max(p.pictures for p in parts.values() if p.case == one.case)
               for one in parts.values()}  # fmt: skip
    for path, part in sorted(parts.items()):
        if part.pictures == longest[part.case]:
            kept = results.setdefault(part.case, {}).setdefault(path.stem, {})
            kept[part] = json.loads(path.read_text("utf-8"))
    return results


def _part_of(name: str) -> Part:
    rest, _, pictures = name.rpartition("-")
    case, _, seed = rest.rpartition("-seed")
    return Part(case, int(seed), int(pictures))
