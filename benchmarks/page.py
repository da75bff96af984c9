"""How soon the page with a million points is seen, and how long a frame takes, by software."""

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from harness import Figure, skip, tell

from murkscan.types.cloud import PointCloud
from murkscan.types.mesh import Mesh
from murkscan.view import model_of_scan, render_viewer

PROFILES, MORE_PROFILES, LINES = 1000, 2000, 1000
SIGMA = 2e-4
SIZE = {"width": 1280, "height": 800}
FLAGS = (
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync"),
)
FRAMES = 5
VIEWER = Path(__file__).resolve().parents[1] / "src/murkscan/view/viewer"
BARE = Path(__file__).with_name("page_bare.js")


def sea_bed(profiles: int) -> tuple[PointCloud, Mesh]:
    """Make a wavy plate of 2 m, of a thousand points a profile, and a smooth surface past them."""
    random = np.random.default_rng(0)
    y, x = (
        axis.ravel() for axis in np.mgrid[0 : 2 : LINES * 1j, 0 : 2 : profiles * 1j].swapaxes(1, 2)
    )
    z = 1 + 0.05 * np.sin(6 * x) * np.cos(5 * y)
    # Noise on every axis, as a scan has it: without, the file would be smaller than any real one.
    noise = random.normal(0, SIGMA, (3, len(x)))
    x, y, z = np.stack([x, y, z]) + noise
    ones = np.ones(len(x), np.float32)
    frame, line = np.divmod(np.arange(len(x)), LINES)
    cloud = PointCloud(
        points=np.stack([x, y, z], axis=1),
        normals=np.tile(np.float32([0, 0, -1]), (len(x), 1)),
        signal=(50 + 20 * random.standard_normal(len(x))).astype(np.float32),
        posterior=ones,
        sigma=np.float32(SIGMA) * ones,
        sigma_common=0 * ones,
        frame=frame.astype(np.int32),
        scan_line=line.astype(np.int32),
        laser=np.zeros(len(x), np.uint8),
        branch=np.zeros(len(x), np.uint8),
    )
    a = np.arange(len(x)).reshape(profiles, LINES)
    a, b, c, d = a[:-1, :-1].ravel(), a[:-1, 1:].ravel(), a[1:, :-1].ravel(), a[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    # As the grid mesher smooths: towards the truth, by one sigma at most.
    vertices = cloud.points.copy()
    vertices[:, 2] -= 0.99 * np.clip(noise[2], -SIGMA, SIGMA)
    return cloud, Mesh(vertices, faces)


def write_page(profiles: int, file: Path) -> float:
    """Write the page of a sea bed, and give the time to join and pack it [s]."""
    cloud, mesh = sea_bed(profiles)
    start = time.perf_counter()
    model = model_of_scan("sea bed", cloud, mesh=mesh)
    file.write_text(render_viewer([model], title="sea bed"), "utf-8")
    return time.perf_counter() - start


def time_page(browser, file: Path, kind: str) -> tuple[float, float]:
    """Give the time to the first picture, and the median of full frames while it is turned [s]."""
    page = browser.new_page(viewport=SIZE)
    start = time.perf_counter()
    page.goto(file.as_uri())
    page.wait_for_function(
        "() => Number(document.getElementById('canvas').dataset.frames) > 0",
        timeout=120_000,
        polling=50,
    )
    first = time.perf_counter() - start
    costs = []
    for _ in range(FRAMES):
        costs.append(page.evaluate(f"() => {kind}"))
    page.close()
    return first, float(np.median(costs)) / 1e3


def coarse_frame(browser, file: Path) -> float:
    """Give the median time between frames while the model is being turned [s]."""
    page = browser.new_page(viewport=SIZE)
    page.goto(file.as_uri())
    page.wait_for_function("() => window.murkscan?.stage.isAtRest", timeout=120_000, polling=50)
    times = page.evaluate(
        """async () => {
          const times = [];
          for (let k = 0; k < 12; k++) {
            murkscan.stage.turn(0.02, 0);
            const start = performance.now();
            murkscan.stage.draw();
            const gl = murkscan.stage.renderer.getContext();
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
            times.push(performance.now() - start);
            await new Promise((resolve) => setTimeout(resolve, 10));
          }
          return times;
        }"""
    )
    page.close()
    return float(np.median(times)) / 1e3


def time_views(browser, file: Path) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Time a page as surface, as points, and while it is turned."""
    surface = time_page(browser, file, FULL)
    return surface, time_page(browser, file, AS_POINTS), coarse_frame(browser, file)


FULL = """(() => {
  const { stage } = murkscan;
  stage.turn(0.05, 0.02);
  stage.moving = false;
  stage.draw();
  return stage.cost;
})()"""
AS_POINTS = f"(murkscan.stage.kind = 'points', {FULL})"


def bare_page(folder: Path) -> Path | None:
    """Build the least page that shows a million points by three.js; None where node is absent."""
    if shutil.which("npm") is None:
        print("three.js alone is not measured: npm is absent", file=sys.stderr)
        return None
    for name in ("package.json", ".npmrc"):
        shutil.copy(VIEWER / name, folder)
    shutil.copy(BARE, folder / "bare.js")
    install = ["npm", "install", "--no-fund", "--no-audit", "--silent"]
    bundle = ["npx", "esbuild", "bare.js", "--bundle", "--minify", "--outfile=out.js"]
    for command in (install, bundle):
        if subprocess.run(command, cwd=folder, check=False, capture_output=True).returncode:
            print("three.js alone is not measured: npm could not fetch it", file=sys.stderr)
            return None
    file = folder / "bare.html"
    script = (folder / "out.js").read_text("utf-8")
    file.write_text(
        "<!doctype html><style>body{margin:0}canvas{width:100vw;height:100vh}</style>"
        f"<canvas id=canvas></canvas><script>{script}</script>",
        "utf-8",
    )
    return file


def main() -> None:
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        skip("page", "playwright is not installed")
    chromium = shutil.which("chromium")
    if chromium is None:
        skip("page", "the system has no chromium")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        page, more = Path(name) / "index.html", Path(name) / "more.html"
        made, made_more = write_page(PROFILES, page), write_page(MORE_PROFILES, more)
        browser = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS))
        surface, points, turning = time_views(browser, page)
        surface_more, points_more, turning_more = time_views(browser, more)
        bare = bare_page(Path(name))
        peer = (np.nan, np.nan) if bare is None else time_page(browser, bare, "bare()")
        browser.close()
        size, size_more = (file.stat().st_size / 1e6 for file in (page, more))
    tell(
        "page",
        "The page with a million points, drawn by the processor",
        [
            Figure("first picture, 2 million triangles", surface[0], "s", at_most=10),
            Figure("a whole frame, as surface", surface[1], "s", at_most=1.5),
            Figure("a whole frame, as points", points[1], "s", at_most=1.5),
            Figure("a frame while it is turned", turning, "s"),
            Figure("three.js alone, points: first picture", peer[0], "s"),
            Figure("three.js alone, points: a frame", peer[1], "s"),
            Figure("size of the file", size, "MB"),
            Figure("making it: join and pack", made, "s"),
            Figure("two million points: first picture", surface_more[0], "s"),
            Figure("two million points: a whole frame, as surface", surface_more[1], "s"),
            Figure("two million points: a whole frame, as points", points_more[1], "s"),
            Figure("two million points: a frame while it is turned", turning_more, "s"),
            Figure("two million points: size of the file", size_more, "MB"),
            Figure("two million points: making it", made_more, "s"),
        ],
        note="Chromium without a graphics chip (SwiftShader), 1280 x 800. three.js alone draws as "
        "many points, made in the page and not unpacked, with nothing around them. While the model "
        "is turned, the page draws a fair sample of the points, and all of them when it rests.",
    )


if __name__ == "__main__":
    main()
