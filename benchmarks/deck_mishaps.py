"""What goes wrong on deck, done to the programs as they are used: what is kept and said."""

import json
import math
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from harness import Figure, skip, tell
from kept import Kept, make_in_pieces
from live import _encode, _send
from studio import FLAGS, _serving
from studio_streams import SDP

from murkscan.capture import open_recording

PORT = 42500
AWAY, ASLEEP = 20.0, 60.0
"""Time for which the stream is lost, and for which the laptop sleeps [s]."""
LONG = 400.0
"""Longest wait for anything [s]; machines are busy."""
WIDTH, HEIGHT = 320, 240
RIG = f"""format = 1
wavelength_nm = 532

[camera]
size = [{WIDTH}, {HEIGHT}]
focal_length = [250.0, 250.0]
principal_point = [159.5, 119.5]
distortion = [0, 0, 0, 0, 0]

[[laser]]
kind = "baseline_angle"
baseline_mm = 200.0
angle_deg = 68.2
axis = "x"
"""
FLAGS_OF_LIVE = ("--speed-mm-s", "100", "--extractor", "gray-gravity", "--fields", "progressive")


@dataclass(frozen=True)
class Outcome:
    """What became of one mishap."""

    name: str
    words: str
    """What is said."""
    lost: float
    """What the recording lacks of what had come before [s]; NaN: nothing came."""
    is_right: bool


def main() -> None:
    if shutil.which("chromium") is None:
        skip("deck_mishaps", "the system has no chromium")
    outcomes = make_in_pieces(_try_all)
    right = [one for one in outcomes if one.is_right]
    lost = [one.lost for one in outcomes if not math.isnan(one.lost)]
    figures = [
        Figure(f"told in one sentence, and gone on with, of {len(outcomes)}", len(right),
               at_least=len(outcomes)),
        Figure("recording lost at most", max(lost), "s", at_most=2.0),
    ]  # fmt: skip
    rows = [f"| {one.name} | {one.words} |" for one in outcomes]
    note = "\n".join([_NOTE, "", "| mishap | what is said |", "|---|---|", *rows])
    tell("deck_mishaps", "Mishaps on deck", figures, note=note)


_NOTE = """
H.264 by RTP over the loopback interface, 320 × 240 px at 25 /s. The stream is taken away for 20 s;
the program is killed and begun anew; the disk is a file system of its own with 300 kB left; two
browsers are open, of which the second tries to begin something as well; asleep are studio, dive and
source for 60 s, by SIGSTOP and SIGCONT.
"""


def _try_all(kept: Kept) -> list[Outcome]:
    runs: Mapping[str, Callable[[Path], list[Outcome]]] = {
        "sdp": _give_wrong_sdp,
        "lost": _lose_and_kill,
        "full": _fill_the_disk,
        "asleep": _sleep,
    }
    outcomes = []
    for name, run in runs.items():
        found = kept.take(name, partial(_alone, run))
        outcomes += [Outcome(**one) for one in found]
        print(*outcomes[-len(found) :], sep="\n", flush=True)
    return outcomes


def _alone(run: Callable[[Path], list[Outcome]]) -> list[dict[str, Any]]:
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch)
        (root / "rig.toml").write_text(RIG)
        (root / "cam.sdp").write_text(SDP.format(port=PORT))
        return [asdict(one) for one in run(root)]


def _give_wrong_sdp(root: Path) -> list[Outcome]:
    """Give text that is no SDP, and one of a port to which nobody sends."""
    (root / "bad.sdp").write_text("this is no description\n")
    told = []
    for name, file in (("a file that is no SDP", "bad.sdp"), ("an SDP of another port", "cam.sdp")):
        words = _live(root, file, out=f"dive-{file}", timeout="3")
        done = subprocess.run(words, cwd=root, capture_output=True, text=True, check=False)
        lines = [one for one in done.stderr.splitlines() if one.startswith("murkscan: ")]
        is_right = done.returncode == 2 and len(lines) == 1 and file in lines[0]
        told.append(Outcome(name, " ".join(lines).replace(str(root), "."), math.nan, is_right))
    return told


def _lose_and_kill(root: Path) -> list[Outcome]:
    """Take the stream away, bring it back; kill the program, begin it anew."""
    status = partial(_status, root / "dive")
    with _running(root) as dive:
        with _sending(root):
            _wait(lambda: status()["recorded"]["time_s"] > 4 and status()["state"] == "live")
        before = status()["recorded"]
        time.sleep(AWAY)
        words, state = status()["message"], status()["state"]
        with _sending(root):
            _wait(lambda: status()["recorded"]["time_s"] > before["time_s"] + AWAY + 2)
            is_back = status()["state"] == "live"
            after, points = status()["recorded"], status()["points"]["count"]
            dive.kill()
            dive.wait()
            kept = _recorded(root / "dive")
            gone = Outcome(
                f"the stream is away for {AWAY:g} s", words, before["time_s"] - kept.before(AWAY),
                state == "lost" and is_back,
            )  # fmt: skip
            with _running(root) as again:
                _wait(lambda: status()["points"]["count"] > points)
                message = status()["message"]
                _stop(again)
    whole = _recorded(root / "dive")
    is_scanned = status()["state"] == "done"
    killed = Outcome(
        "the program is killed in the dive", f"{message} … {status()['message']}",
        after["time_s"] - kept.last, is_scanned and whole.last > kept.last,
    )  # fmt: skip
    return [gone, killed]


def _fill_the_disk(root: Path) -> list[Outcome]:
    """Record onto a file system that is nearly full."""
    disk = root / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(disk)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        print("no file system can be mounted: the full disk is left out")
        return []
    try:
        (disk / "other").write_bytes(bytes(3_700_000))
        with _sending(root):
            words = _live(root, "cam.sdp", out="disk/dive")
            done = subprocess.run(
                words, cwd=root, capture_output=True, text=True, check=False, timeout=LONG
            )
        lines = [one for one in done.stderr.splitlines() if one.startswith("murkscan: ")]
        kept = _recorded(disk / "dive")
        is_right = len(lines) == 1 and "No space left" in lines[0] and kept.last > 0
        words_ = " ".join(lines).replace(str(root), ".")
        return [Outcome("the disk is full", words_, math.nan, is_right)]
    finally:
        subprocess.run(["umount", str(disk)], check=False)


def _sleep(root: Path) -> list[Outcome]:
    """Open two browsers, then let studio, dive and source sleep."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright, _serving(root) as address, _sending(root) as source:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=list(FLAGS)
        )
        first, second = browser.new_page(), browser.new_page()
        for page in (first, second):
            page.goto(f"{address}#live")
            page.wait_for_selector("html[data-ready]")
        _begin(first)
        second.locator(".badge.good", has_text="live").wait_for(timeout=1e3 * LONG)
        said = second.evaluate(_ORDER)
        two = Outcome("two browsers", said, math.nan, "One thing at a time" in said)
        before = _status(root / "dive")["recorded"]
        dive = _status(root / "dive")["pid"]
        studio = _studio_of(root)
        for process in (source.pid, dive, studio):
            os.kill(process, signal.SIGSTOP)
        first.locator("#gone").wait_for(timeout=20_000)
        words = first.locator("#gone").inner_text()
        time.sleep(ASLEEP - 10)
        for process in (studio, dive, source.pid):
            os.kill(process, signal.SIGCONT)
        first.locator("#gone").wait_for(state="hidden", timeout=30_000)
        _wait(lambda: _status(root / "dive")["recorded"]["pictures"] > before["pictures"] + 50)
        first.locator(".badge.good", has_text="live").wait_for(timeout=1e3 * LONG)
        os.kill(dive, signal.SIGKILL)
        browser.close()
    kept = _recorded(root / "dive")
    asleep = Outcome(
        "the laptop sleeps for a minute", words, max(before["time_s"] - kept.last, 0.0), True
    )
    return [two, asleep]


_ORDER = """async () => {
  const values = { source: "cam.sdp", rig: "rig.toml", out: "other", "speed-mm-s": "100" };
  const asked = { command: "live", page: "live", values };
  const answer = await fetch("api/jobs", { method: "POST", body: JSON.stringify(asked),
    headers: { "content-type": "application/json" } });
  return answer.text();
}"""


def _begin(page: Any) -> None:
    page.locator("input[name=source]").fill("cam.sdp")
    page.locator("select[name=rig]").select_option("rig.toml")
    page.get_by_label("Speed or step").fill("100")
    page.locator("code.typed", has_text="cam.sdp --rig rig.toml --out dive").wait_for()
    page.get_by_role("button", name="Record and scan live").click()


def _studio_of(root: Path) -> int:
    """Find the studio's own process: the one that serves this folder."""
    for entry in Path("/proc").iterdir():
        with suppress(OSError):
            words = (entry / "cmdline").read_bytes().split(b"\0")
            if entry.name.isdigit() and b"studio" in words and str(root).encode() in words:
                return int(entry.name)
    raise SystemExit("the studio does not run")


def _live(root: Path, source: str, *, out: str = "dive", timeout: str = "30") -> list[str]:
    return [
        *(sys.executable, "-m", "murkscan", "live", source, "--rig", "rig.toml", "--out", out),
        *FLAGS_OF_LIVE, "--timeout-s", timeout, "--patience-s", "60",
    ]  # fmt: skip


@contextmanager
def _running(root: Path) -> Iterator["subprocess.Popen[bytes]"]:
    with (root / "said.txt").open("ab") as said:
        process = subprocess.Popen(_live(root, "cam.sdp"), cwd=root, stdout=said, stderr=said)
        try:
            yield process
        finally:
            process.kill()
            process.wait()


def _stop(process: "subprocess.Popen[bytes]") -> None:
    """End a dive as Ctrl-C does, and wait for its scan."""
    process.send_signal(signal.SIGINT)
    process.wait(LONG)


@contextmanager
def _sending(root: Path) -> Iterator[multiprocessing.Process]:
    """Send a line that moves over the picture, over and over."""
    file = root / "stream.mkv"
    if not file.exists():
        _encode(file, [_draw(number) for number in range(50)])
    context = multiprocessing.get_context("spawn")
    sender = context.Process(target=_send, args=(str(file), PORT), daemon=True)
    sender.start()
    try:
        yield sender
    finally:
        sender.kill()
        sender.join()


def _draw(number: int) -> np.ndarray:
    random = np.random.default_rng(number)
    image = 20 + random.normal(0, 2, (HEIGHT, WIDTH))
    at = 60 + 3 * min(number, 50 - number)
    image[:, at : at + 4] = 200
    return np.clip(image, 0, 255).astype(np.uint8)


@dataclass(frozen=True)
class _Recorded:
    """What can be read of a recording."""

    times: np.ndarray

    @property
    def last(self) -> float:
        """Time of its last picture [s]."""
        return float(self.times[-1])

    def before(self, gap: float) -> float:
        """Give the time of the last picture before the recording pauses for most of a time [s]."""
        pauses = np.flatnonzero(np.diff(self.times) > gap / 2)
        return float(self.times[pauses[0] if len(pauses) else -1])


def _recorded(out: Path) -> _Recorded:
    files = sorted((out / "capture").glob("*.mkv"))
    times = [frame.time for frame in open_recording(files).frames()]
    return _Recorded(np.array(times))


def _status(out: Path) -> dict[str, Any]:
    with suppress(OSError, ValueError):
        return json.loads((out / "live" / "status.json").read_text("utf-8"))
    return {
        "recorded": {"time_s": 0.0, "pictures": 0}, "state": "", "message": "",
        "points": {"count": 0},
    }  # fmt: skip


def _wait(is_so: Callable[[], bool]) -> None:
    until = time.monotonic() + LONG
    while not is_so():
        if time.monotonic() > until:
            raise SystemExit("it took too long; is the machine busy?")
        time.sleep(0.2)


if __name__ == "__main__":
    main()
