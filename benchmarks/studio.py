"""From the first board to a measured model in the browser, by clicks and keys alone."""

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

from harness import Figure, skip, tell
from studio_streams import SDP, Streams, make_recordings

PORTS = {"boards": 42110, "lines": 42120, "dive": 42130}
BOARDS, SQUARE, SPEED, KNOWN, RADIUS = 12, 30, 40, 0.1, 60.0
"""Photos a step; the board's squares [mm]; the camera's speed [mm/s], and how well it is known [%];
the ball's radius [mm]."""
NEAR, WITHIN = "0,0.3,0.58", 40
"""Where the ball is looked for [m], and how far around [mm]."""
PATIENCE = 300_000
SIZES = {"laptop": (1280, 800), "phone": (390, 844)}
PAGES = ("rig", "calibrate/camera", "live", "look", "plan")
FLAGS = (
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync"),
)
MURKSCAN = (sys.executable, "-m", "murkscan")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pictures", type=Path, help="folder for a picture of each page")
    pictures = parser.parse_args().pictures
    if shutil.which("chromium") is None:
        skip("studio", "the system has no chromium")
    with tempfile.TemporaryDirectory() as scratch:
        made, work = Path(scratch) / "made", Path(scratch) / "work"
        make_recordings(made)
        work.mkdir()
        for name, port in PORTS.items():
            (work / f"{name}.sdp").write_text(SDP.format(port=port))
        figures = _click(made, work, pictures)
        by_commands, half = _by_commands(made)
        ours = figures.pop("radius")
        tell(
            "studio",
            "The studio, from the first board to a measure",
            [
                *(Figure(*one) for one in figures.pop("figures")),
                Figure("ball of 60 mm, off by clicks", ours[0] - RADIUS, "mm"),
                Figure("its own ± 95 %", ours[1], "mm"),
                Figure("the same by commands, off", by_commands - RADIUS, "mm"),
                Figure("its ± 95 %", half, "mm"),
                Figure(
                    "difference of both over the interval of the clicks",
                    abs(ours[0] - by_commands) / ours[1],
                    at_most=1.0,
                ),
            ],
            note=_NOTE,
        )


_NOTE = """
Chromium without a screen draws by the processor and clicks through the studio: photographs of a
board from a stream, the camera, photographs of the laser's line, the laser, the check on the same
photographs, a dive, and a ball measured. Boards, lines and the dive (c = 1.5 /m) are simulated, and
come as H.264 by RTP over the loopback interface; the commands are given the pictures that the
streams were made of. The time depends on what else the machine does.
"""


def _click(made: Path, work: Path, pictures: Path | None) -> dict:
    """Go from the boards to the measure, and look at all pages."""
    from playwright.sync_api import sync_playwright

    faults: list[str] = []
    with sync_playwright() as playwright, _serving(work) as address, Streams(made) as streams:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=list(FLAGS)
        )
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.on("console", lambda said: said.type == "error" and faults.append(said.text))
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto(address)
        page.wait_for_selector("html[data-ready]")
        began = time.monotonic()
        for step, stream in (("camera", "boards"), ("laser", "lines")):
            _photograph(page, step, stream, streams)
            _calibrate(page, step)
        _check(page)
        _dive(page, streams)
        radius = _measure(page, work)
        minutes = (time.monotonic() - began) / 60
        too_wide = _look_at_all(browser, address, pictures)
        browser.close()
    print("\n".join(faults))
    return {
        "radius": radius,
        "figures": [
            ("from the first board to the measure", minutes, "min", 10.0),
            ("errors in the browser's console", len(faults), "", 0.0),
            ("pages that are wider than their screen, of 20", too_wide, "", 0.0),
        ],
    }


@contextmanager
def _serving(folder: Path):
    words = [*MURKSCAN, "studio", str(folder), "--no-browser"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield re.search(r"http://\S+", process.stdout.readline())[0]
        finally:
            process.kill()


def _photograph(page, step: str, stream: str, streams: Streams) -> None:
    """Hold boards before the camera until there are enough photos of them."""
    page.evaluate(f"location.hash = 'calibrate/{step}'")
    page.get_by_text("Take photographs by a live picture").click()
    page.locator("input[name=source]").fill(f"{stream}.sdp")
    page.locator("input[name=count]").fill(str(BOARDS))
    page.locator("input[name=square-mm]").fill(str(SQUARE))
    _typed(page, f"{stream}.sdp boards-{step} --board 9x6 --boards {BOARDS}")
    with streams.sending(stream, PORTS[stream], hold=2.0):
        page.get_by_role("button", name="Begin").click()
        _wait_for(page, "calibrate photograph")


def _calibrate(page, step: str) -> None:
    if step == "camera":
        page.locator("input[name=rig]").fill("rig.toml")
    _typed(page, f"murkscan calibrate {step} boards-{step} ")
    page.get_by_role("button", name="Calibrate", exact=True).click()
    _wait_for(page, f"calibrate {step}")


def _check(page) -> None:
    """Measure the board's squares by the laser's line; the board was typed before."""
    page.evaluate("location.hash = 'calibrate/check'")
    page.locator("select[name=source]").select_option("boards-laser")
    _typed(page, f"murkscan calibrate check boards-laser --board 9x6 --square-mm {SQUARE}")
    page.get_by_role("button", name="Calibrate", exact=True).click()
    _wait_for(page, "calibrate check")
    page.get_by_text("side of a square").wait_for(timeout=PATIENCE)


def _dive(page, streams: Streams) -> None:
    """Record a dive, end it when it is over, and wait for its scan."""
    page.evaluate("location.hash = 'live'")
    page.locator("input[name=source]").fill("dive.sdp")
    page.locator("select[name=rig]").select_option("rig.toml")
    page.get_by_label("Speed or step").fill(str(SPEED))
    page.locator(".wet details summary").click()
    page.get_by_label("How well that is known").fill(str(KNOWN))
    said = f"--speed-mm-s {SPEED} --speed-sigma-percent {KNOWN}"
    _typed(page, f"dive.sdp --rig rig.toml --out dive --spacing-mm 5 {said}")
    page.get_by_role("button", name="Record and scan live").click()
    page.locator(".badge", has_text="waiting").wait_for(timeout=PATIENCE)
    with streams.sending("dive", PORTS["dive"], once=True) as sender:
        sender.join()
    page.keyboard.press("e")
    page.keyboard.press("e")
    _wait_for(page, "live dive.sdp")


def _measure(page, work: Path) -> tuple[float, float]:
    page.evaluate("location.hash = 'look/dive'")
    page.get_by_label("Around X,Y,Z").fill(NEAR)
    page.get_by_label("as far as").fill(str(WITHIN))
    page.get_by_role("button", name="Measure", exact=True).click()
    page.locator(".measure", has_text="sphere").wait_for(timeout=PATIENCE)
    return _radius(work / "dive")


def _typed(page, words: str) -> None:
    """Wait until a form shows the command that was meant."""
    page.locator("code.typed", has_text=words).wait_for()


def _wait_for(page, words: str) -> None:
    """Wait until a command is done; what it says instead ends the benchmark."""
    line = page.locator("#job .line", has_text=words)
    line.locator(".state:not(.running)").wait_for(timeout=PATIENCE)
    if line.locator(".state.done").count() == 0:
        raise SystemExit(page.locator("#job").inner_text())


def _look_at_all(browser, address: str, pictures: Path | None) -> int:
    """Open each page at both sizes in both themes; counts those that do not fit."""
    too_wide = 0
    for size, (width, height) in SIZES.items():
        for theme in ("light", "dark"):
            page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=theme)
            for name in PAGES:
                page.goto("about:blank")
                page.goto(f"{address}#{name}")
                page.wait_for_selector("html[data-ready]")
                page.wait_for_timeout(4000)
                too_wide += page.evaluate("document.documentElement.scrollWidth > innerWidth")
                if pictures is not None:
                    file = pictures / f"{name.replace('/', '-')}-{size}-{theme}.png"
                    page.screenshot(path=file, full_page=True)
            page.close()
    return too_wide


def _by_commands(made: Path) -> tuple[float, float]:
    """Do the same by commands, with the pictures that the streams were made of."""
    board = ("--board", "9x6", "--square-mm", str(SQUARE), "--rig", "rig.toml")
    speed = ("--speed-mm-s", str(SPEED), "--speed-sigma-percent", str(KNOWN))
    for words in (
        ("calibrate", "camera", "boards/frames", *board),
        ("calibrate", "laser", "lines/frames", *board),
        ("scan", "dive/frames", "--rig", "rig.toml", *speed, "--out", "scan"),
        ("measure", "scan", "sphere", "--near-m", NEAR, "--within-mm", str(WITHIN)),
    ):
        subprocess.run([*MURKSCAN, *words], cwd=made, check=True, capture_output=True)
    return _radius(made / "scan")


def _radius(scan: Path) -> tuple[float, float]:
    """Read the ball's radius and half of its interval [mm]."""
    radius = json.loads((scan / "measure/sphere.json").read_text())["quantities"]["radius_m"]
    low, high = radius["interval_95"]
    return 1e3 * radius["value"], 1e3 * (high - low) / 2


if __name__ == "__main__":
    main()
