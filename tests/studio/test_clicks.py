"""The studio as its users meet it: in a browser, by clicks and keys alone."""

import re
import signal
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest

pytest.importorskip("uvicorn", reason="the extra [studio] is not installed")

from murkscan import load_rig
from murkscan.io.images import write_image
from murkscan.io.poses import save_poses
from murkscan.io.rig_toml import save_rig
from murkscan.live import GapMap, LiveFolder, LiveStatus
from murkscan.survey.simulate import simulate_recording
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

from ..calibrate.boards import CAMERA, draw, poses
from ..scenes import hull_scene, smaller
from ..view.browser import chromium

PATIENCE = 60_000
"""Milliseconds in which a small scan ends on a busy machine."""


_CLICK = """() => {
  const app = window.murkscan, { canvas } = app.stage, box = canvas.getBoundingClientRect();
  const [x, y] = app.stage.project(app.model.positions.slice(3 * 800, 3 * 800 + 3));
  const at = { clientX: box.left + x, clientY: box.top + y, isPrimary: true, button: 0,
    pointerType: "mouse", bubbles: true, pointerId: 1 };
  canvas.dispatchEvent(new PointerEvent("pointerdown", at));
  canvas.dispatchEvent(new PointerEvent("pointerup", at));
}"""
"""Clicks on a point of the model, wherever it is drawn."""


@contextmanager
def serving(folder, port="0"):
    """Run the command, and give the address that it says and the process."""
    words = [sys.executable, "-m", "murkscan", "studio", str(folder), "--no-browser"]
    with subprocess.Popen([*words, "--port", port], stdout=subprocess.PIPE, text=True) as process:
        try:
            yield re.search(r"http://\S+", process.stdout.readline())[0], process
        finally:
            process.kill()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studio")
    simulate_recording(smaller(hull_scene(24)), folder / "dive")
    return folder


@pytest.fixture(scope="module")
def opened(folder):
    """A page that is open, and a list that gets every error and every request that leaves it."""
    with chromium() as browser, serving(folder) as (address, process):
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        faults = []
        page.on("console", lambda said: said.type == "error" and faults.append(said.text))
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", lambda asked: at_home(asked.url, address) or faults.append(asked.url))
        page.goto(address)
        page.wait_for_selector("html[data-ready]")
        yield page, faults, process


def at_home(address, home):
    return address.startswith((home, "data:", "blob:"))


def test_from_a_recording_to_a_measure_by_clicks_alone(opened):
    page, faults, _ = opened
    page.get_by_role("link", name="Look", exact=True).click()
    page.get_by_label("Speed or step").fill("100")
    page.get_by_label("Folder for the scan").fill("hull")
    typed = "murkscan scan dive/frames --rig dive/rig.toml --out hull --speed-mm-s 100"
    page.get_by_text(typed).wait_for()
    page.get_by_role("button", name="Scan", exact=True).click()
    page.locator("#job .state.done").wait_for(timeout=PATIENCE)
    laptop = page.viewport_size
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.set_viewport_size(laptop)
    model = page.frame_locator("iframe.viewer")
    model.locator("html[data-ready]").wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Plane", exact=True).click()
    page.get_by_role("button", name="Measure", exact=True).click()
    measure = page.locator(".measure", has_text="murkscan measure hull plane --name plane")
    measure.wait_for(timeout=PATIENCE)
    assert "±" in measure.inner_text()
    assert faults == []


def test_what_is_measured_on_the_model_is_taken_by_the_command_for_it(opened):
    page, faults, _ = opened
    frame = next(one for one in page.frames if "view/index.html" in one.url)
    frame.evaluate("murkscan.measure(20, 800)")
    frame.get_by_role("button", name="Take this measure").click()
    measure = page.locator(".measure", has_text="murkscan measure hull distance --from-m")
    measure.wait_for(timeout=PATIENCE)
    assert "mm" in measure.inner_text()
    assert faults == []


def test_a_ball_is_picked_by_a_click_on_the_model(opened):
    page, faults, _ = opened
    frame = next(one for one in page.frames if "view/index.html" in one.url)
    page.get_by_role("button", name="Sphere", exact=True).click()
    page.get_by_role("button", name="Pick", exact=True).click()
    page.get_by_role("button", name="Click in the model").wait_for()
    # A click beside the model gives no place, and the next one is waited for.
    frame.evaluate("window.parent.postMessage({ place: '<b>1,2,3' }, '*')")
    frame.evaluate(_CLICK)
    field = page.locator("input[name=near-m]")
    page.wait_for_function("() => document.querySelector('input[name=near-m]').value")
    assert re.fullmatch(r"-?[\d.]+,-?[\d.]+,-?[\d.]+", field.input_value())
    page.get_by_text(f"measure hull sphere --near-m={field.input_value()}").or_(
        page.get_by_text(f"measure hull sphere --near-m {field.input_value()}")
    ).wait_for()
    assert page.get_by_role("button", name="Pick", exact=True).count() == 1
    assert faults == []


def test_without_webgl_the_pictures_stand_for_the_model(opened):
    page, _, _ = opened
    other, faults = page.context.browser.new_page(), []
    other.on("console", lambda said: said.type == "error" and faults.append(said.text))
    other.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    other.goto(f"{page.url.split('#')[0]}#look")
    other.get_by_text("This browser has no WebGL 2").wait_for()
    assert other.locator(".gallery img").count() >= 7
    other.wait_for_function("() => document.querySelector('.gallery img').naturalWidth > 0")
    assert other.locator("iframe.viewer").count() == 0
    other.close()
    assert faults == []


def test_a_report_is_headed_and_acceptance_and_control_points_are_offered(opened, folder):
    page, faults, _ = opened
    (folder / "acceptance.toml").write_text("[[ball]]\n")
    page.reload()
    page.locator("input[name=client]").fill("Harbour office")
    page.locator("input[name=place]").fill("Pier 3")
    page.get_by_text("murkscan report hull --client 'Harbour office' --place 'Pier 3'").wait_for()
    page.locator("input[name=test]").fill("acceptance.toml")
    page.get_by_text("murkscan accept hull --test acceptance.toml").wait_for()
    page.locator("input[name=control]").fill("acceptance.toml")
    page.locator("input[name=crs]").fill("EPSG:25832")
    typed = "murkscan georeference hull --control acceptance.toml --crs EPSG:25832"
    page.get_by_text(typed).wait_for()
    assert faults == []


def test_a_rig_that_is_not_built_yet_is_described_and_planned(opened, folder):
    page, faults, _ = opened
    page.get_by_role("link", name="Rig", exact=True).click()
    page.locator("input[name=rig]").wait_for()
    page.wait_for_function("() => document.querySelector('input[name=rig]').value !== 'rig.toml'")
    said = {"rig": "boat.toml", "size-px": "720x576", "view-deg": "66", "baseline-mm": "300",
            "angle-deg": "65", "temperature-c": "15", "salinity-psu": "35"}  # fmt: skip
    for key, value in said.items():
        page.locator(f"input[name={key}]").fill(value)
    page.locator("select[name=kind]").select_option("window-mm")
    page.locator("input[name=far]").fill("30")
    page.locator("input[name=glass-mm]").fill("8")
    for name in ("Rig", "Plan", "Rig"):  # what was typed stays, whatever else is looked at
        page.get_by_role("link", name=name, exact=True).click()
        page.get_by_role("heading", name=name, exact=True, level=1).wait_for()
    page.get_by_text("--window-mm 30").or_(page.get_by_text("--glass-mm 8 ")).first.wait_for()
    page.get_by_role("button", name="Write it").click()
    page.locator("#job .line", has_text="describe").locator(".done").wait_for(timeout=PATIENCE)
    assert load_rig(folder / "boat.toml").camera.port is not None
    page.get_by_role("link", name="Plan", exact=True).click()
    page.get_by_label("Rig", exact=True).select_option("boat.toml")
    page.locator(".facts", has_text="300 mm, 65.0°").wait_for(timeout=PATIENCE)
    assert faults == []


def test_a_mount_is_calibrated_by_clicks_and_told_of_before(opened, folder):
    page, faults, _ = opened
    tilts = [(x, y) for x in (-25, 0, 25) for y in (-25, 25)]
    boards = list(poses(np.random.default_rng(1), tilts))
    for number, board in enumerate(boards):
        write_image(folder / "stand" / f"{number}.png", draw(board)[0].astype(np.uint8))
    rows = "".join(f"{number}.png,{number}\n" for number in range(len(boards)))
    (folder / "stand" / "times.csv").write_text(f"file,time_s\n{rows}")
    vehicles = [board.inverse() for board in boards]
    save_poses(
        folder / "vehicle.csv",
        Trajectory(
            np.arange(len(boards), dtype=float),
            np.stack([pose.translation for pose in vehicles]),
            np.concatenate([pose.as_quaternion() for pose in vehicles]),
        ),
    )
    save_rig(folder / "lens.toml", Rig(CAMERA))
    page.goto(f"{page.url.split('#')[0]}#calibrate/mount")
    page.locator("select[name=images]").select_option("stand")
    page.locator("select[name=rig]").select_option("lens.toml")
    page.locator("select[name=poses]").select_option("vehicle.csv")
    page.locator("input[name=square-mm]").fill("30")
    page.locator(".progress.named", has_text="camera's place").wait_for(timeout=PATIENCE)
    page.locator(".progress.named", has_text="camera's direction").get_by_text("good").wait_for()
    page.get_by_role("button", name="Calibrate", exact=True).click()
    page.locator("#job .line", has_text="mount").locator(".done").wait_for(timeout=PATIENCE)
    page.locator("h2", has_text="Mount").locator(".badge").wait_for(timeout=PATIENCE)
    mount = load_rig(folder / "lens.toml").vehicle_from_camera
    # Corners of drawn boards are found to a tenth of a pixel: a millimetre at 0.7 m.
    assert np.linalg.norm(mount.translation) < 5e-3
    page.get_by_role("link", name="Rig", exact=True).click()
    page.locator("#job").wait_for(state="hidden")
    assert faults == []


def test_a_dive_without_a_map_shows_none_of_the_dive_before(opened, folder):
    page, faults, _ = opened
    mapped = GapMap(
        np.zeros((4, 4), np.uint8), ("too fast",), 0.005, (0.0, 0.0), np.eye(3)[0], np.eye(3)[1],
        1.0, 0.0,
    )  # fmt: skip
    for name in ("first", "second"):
        LiveFolder(folder / name / "live").save_status(LiveStatus(state="live"))
    LiveFolder(folder / "first" / "live").save_gaps(mapped)
    page.get_by_role("link", name="Live", exact=True).click()
    page.get_by_label("Dive", exact=True).select_option("first")
    page.get_by_text("100 % covered").wait_for()
    page.get_by_label("Dive", exact=True).select_option("second")
    page.get_by_text("the map comes with the first metres").wait_for()
    assert faults == []


def test_a_dive_follows_a_vehicle_over_mavlink(opened):
    page, faults, _ = opened
    page.get_by_role("link", name="Live", exact=True).click()
    page.locator("input[name=source]").fill("udp://0.0.0.0:5600")
    page.get_by_label("How the camera moves").select_option("mavlink")
    page.get_by_text("--mavlink 0.0.0.0:14550").wait_for()
    page.get_by_label("Speed or step").fill("100")
    page.get_by_text("--speed-mm-s 100").wait_for()
    page.get_by_label("How the camera moves").select_option("speed-mm-s")
    page.locator("code.typed", has_text="mavlink").wait_for(state="detached")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    assert faults == []


def test_what_a_command_needs_is_asked_for_before_it_is_begun(opened):
    page, faults, _ = opened
    page.get_by_role("link", name="Live", exact=True).click()
    before = page.locator("#job").inner_text()
    page.get_by_role("button", name="Record and scan live").click()
    assert page.locator("input[name=source]:invalid").count() == 1
    page.wait_for_timeout(300)
    assert page.locator("#job").inner_text() == before
    assert faults == []


def test_a_plan_follows_its_sliders(opened):
    page, faults, _ = opened
    page.get_by_role("link", name="Plan", exact=True).click()
    reach = page.locator(".facts b").first
    reach.wait_for(timeout=PATIENCE)
    clear = float(reach.inner_text().split()[2])
    page.get_by_role("spinbutton", name="A diver sees").fill("1")
    page.wait_for_function(
        f"() => parseFloat(document.querySelector('.facts b').textContent.split(' ')[2]) < {clear}",
        timeout=PATIENCE,
    )
    page.get_by_text("--visibility-m 1").wait_for()
    assert faults == []


def test_a_better_place_of_the_laser_is_found_and_tried(opened):
    page, faults, _ = opened
    page.get_by_label("Water by").select_option("secchi-m")
    page.get_by_text("--secchi-m 4.3").wait_for()
    page.get_by_role("button", name="Where would the laser better sit?").click()
    page.get_by_role("button", name="Try it").click(timeout=PATIENCE)
    baseline = page.locator("input[name=baseline-mm][type=number]").input_value()
    page.get_by_text(f"--baseline-mm {baseline} --angle-deg").wait_for()
    page.locator(".facts", has_text="as if").wait_for(timeout=PATIENCE)
    assert faults == []


@pytest.mark.parametrize("name", ["rig", "calibrate", "live", "look", "plan"])
def test_pages_fit_a_phone_and_show_names_as_they_are(opened, folder, name):
    page, faults, _ = opened
    hostile = "<img src=x onerror=window.broken=1>.toml"
    (folder / hostile).write_text((folder / "dive/rig.toml").read_text())
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(f"{page.url.split('#')[0]}#{name}")
    page.wait_for_function(f"() => document.body.innerHTML.includes({hostile[1:8]!r})")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.evaluate("window.broken") is None
    assert faults == []


def test_a_studio_that_is_gone_is_told_of_and_its_page_goes_on_when_it_is_back(opened, folder):
    page, _, process = opened
    process.send_signal(signal.SIGSTOP)  # as a laptop that sleeps
    page.locator("#gone").wait_for(timeout=PATIENCE)
    process.send_signal(signal.SIGCONT)
    page.locator("#gone").wait_for(state="hidden", timeout=PATIENCE)
    process.kill()
    process.wait()
    page.locator("#gone").wait_for(timeout=PATIENCE)
    assert "does not answer" in page.locator("#gone").inner_text()
    with serving(folder) as (address, _):
        assert page.url.startswith(address)
        page.locator("#gone").wait_for(state="hidden", timeout=PATIENCE)
