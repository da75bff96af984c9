"""An hour's dive replayed: what the program and the page hold of memory, and how fast it draws."""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from deck_mishaps import RIG, _draw, _status
from harness import Figure, skip, tell
from studio import FLAGS, _serving

PICTURES = 36_000
"""An hour's at ten a second."""
RATE = 1000
"""The recording's own pictures a second: more than can be followed."""
STEP = 10.0
"""From one picture to the next [mm]: the dive goes 360 m, as at 100 mm/s in an hour."""
EVERY = 2.0
"""Time from one sample of the memory to the next [s]."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pictures", type=int, default=PICTURES)
    count = parser.parse_args().pictures
    if shutil.which("chromium") is None:
        skip("live_hour", "the system has no chromium")
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch)
        (root / "rig.toml").write_text(RIG)
        _record(root / "hour.mkv", count)
        figures = _replay(root, count)
    tell("live_hour", "An hour replayed", figures, note=_note(count))


def _note(count: int) -> str:
    return (
        f"{count} pictures of 320 × 240 px, those of an hour at ten a second, on 360 m, by gray "
        "gravity, replayed as fast as they can be looked at, while Chromium, which draws by the "
        "processor, shows the dive. Grows is from a quarter of the pictures to the end, by the "
        "medians of a tenth of the samples. The page's frame is the median time between two "
        f"pictures while its model is turned; load was {os.getloadavg()[0]:.1f} on "
        f"{os.cpu_count()} cores."
    )


def _record(path: Path, count: int) -> None:
    """Encode a second, and write its packets over and over."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=RATE)
        stream.height, stream.width = _draw(0).shape
        stream.pix_fmt = "yuv420p"
        stream.codec_context.options = {"g": "50", "preset": "ultrafast", "tune": "zerolatency"}
        packets = []
        for number in range(50):
            frame = av.VideoFrame.from_ndarray(_draw(number), "gray").reformat(format="yuv420p")
            frame.pts, frame.time_base = number, Fraction(1, RATE)
            packets += stream.encode(frame)
        packets += stream.encode(None)
        for number in range(count):
            packet = packets[number % len(packets)]
            copy = av.Packet(bytes(packet))
            copy.stream, copy.time_base = stream, Fraction(1, RATE)
            copy.pts = copy.dts = number
            copy.is_keyframe = packet.is_keyframe
            container.mux(copy)


def _replay(root: Path, count: int) -> list[Figure]:
    from playwright.sync_api import sync_playwright

    words = [
        *(sys.executable, "-m", "murkscan", "live", "hour.mkv", "--rig", "rig.toml"),
        *("--out", "dive", "--step-mm", str(STEP), "--extractor", "gray-gravity"),
        *("--fields", "progressive"),
    ]
    with _serving(root) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=list(FLAGS)
        )
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(f"{address}#live")
        page.wait_for_selector("html[data-ready]")
        with subprocess.Popen(words, cwd=root, stderr=subprocess.DEVNULL) as dive:
            try:
                server, shown = _sample(root, dive.pid, page, count)
            finally:
                dive.kill()
        frame = _turn(page)
        browser.close()
    return [
        Figure("the program, resident at the end", _end(server), "MB", at_most=900.0),
        Figure("the program grows by", _end(server) - _quarter(server), "MB", at_most=50.0),
        Figure("the page, resident at the end", _end(shown), "MB", at_most=600.0),
        Figure("the page grows by", _end(shown) - _quarter(shown), "MB", at_most=100.0),
        Figure("the page's frame", 1e3 * frame, "ms", at_most=100.0),
    ]


def _sample(root: Path, dive: int, page: Any, count: int) -> tuple[list[float], list[float]]:
    """Note what program and page hold until the replay is over [MB]."""
    server, shown = list[float](), list[float]()
    while True:
        status = _status(root / "dive")
        if status["state"] in ("scanning", "done", "failed"):
            return server, shown
        if status["state"] == "live":
            server.append(_resident(dive))
            shown.append(max(map(_resident, _renderers()), default=0.0))
            if len(server) % 10 == 1:
                share = status["recorded"]["pictures"] / count
                print(f"{share:.0%}: {server[-1]:.0f} MB, {shown[-1]:.0f} MB", flush=True)
        page.wait_for_timeout(1e3 * EVERY)


def _renderers() -> list[int]:
    """Find the processes that draw pages, this program's children's."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes()
        except OSError:
            continue
        if entry.name.isdigit() and b"--type=renderer" in words and _is_ours(int(entry.name)):
            found.append(int(entry.name))
    return found


def _is_ours(process: int) -> bool:
    while process > 1:
        if process == os.getpid():
            return True
        try:
            process = int(Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            return False
    return False


def _resident(process: int) -> float:
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except OSError:
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _quarter(samples: Sequence[float]) -> float:
    few = max(len(samples) // 10, 1)
    return float(np.median(samples[len(samples) // 4 :][:few]))


def _end(samples: Sequence[float]) -> float:
    return float(np.median(samples[-max(len(samples) // 10, 1) :]))


def _turn(page: Any) -> float:
    """Turn the model, and give the median time from one picture to the next [s]."""
    page.evaluate(
        "() => { window.times = []; const note = (now) => { window.times.push(now); "
        "requestAnimationFrame(note); }; requestAnimationFrame(note); }"
    )
    box = page.locator("canvas.cloud").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    until = time.monotonic() + 10.0
    while time.monotonic() < until:
        page.mouse.move(x + 60 * np.sin(3 * time.monotonic()), y)
    page.mouse.up()
    steps = np.diff(page.evaluate("window.times"))
    return float(np.median(steps)) / 1e3


if __name__ == "__main__":
    main()
