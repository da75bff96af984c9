"""A cruiser's propeller and sonar dome, scanned in murk and held against their drawing.

`python benchmarks/ship.py CG-57.ac --keep FOLDER`: the model is of Debian's flightgear-data-models
(GPL-2+), and no part of this project. It takes an hour; what is in the folder is not done again,
so give a new one once scene or passes have changed.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np
from harness import DOCS, Figure, skip, tell
from page import FLAGS
from scipy.spatial import KDTree
from ship_scene import (
    BENT_BY,
    DENT_DEPTH,
    HUB,
    JOBS,
    Job,
    draw_ship,
    drift,
    is_bent_blade,
    place_dent,
)

from murkscan import Mesh, Project, open_recording
from murkscan.geometry.closest import find_closest
from murkscan.io.deviation_files import load_deviation_ply
from murkscan.io.mesh_files import load_mesh, save_mesh
from murkscan.io.parquet import load_true_stripe
from murkscan.io.poses import save_poses

HERE = Path(__file__).parent
MODEL = Path("/usr/share/games/flightgear/Models/Maritime/Military/CG-57-high-detail/CG-57.ac")
FALSE, FOUND = 0.01, 0.005
"""A point farther than this from the ship is false; a true place is found that has a point no
farther away than this [m]."""
SAMPLES = 200_000
TIP_FROM = 2.3
PICTURES = {
    "propeller": "propeller/propeller/view/isometric.png",
    "deviation": "propeller/propeller/measure/deviation-front.png",
    "dome": "dome/dome/measure/dents-front.png",
}
"""What docs/ship.md shows, and where it lies in the folder that keeps all."""
SHOWN, WIDTH = 300, 1000
"""Frame of the propeller's third pass that is shown; width of pictures [px]."""
NOTE = f"""
The guided-missile cruiser CG-57 of Debian's `flightgear-data-models`, below the water line, in its
own size and frame: x aft, z up. The ship differs from its drawing in one blade of a propeller,
whose outer third is bent aft by up to {BENT_BY * 1e3:g} mm, and in a dent of
{DENT_DEPTH * 1e3:g} mm in its sonar dome. Water of c = 1.5 /m with particles; camera and laser of
`ship_rig.toml` 0.6 to 2.4 m away, 8 to 10 mm from picture to picture; six passes down behind the
propeller, five along the dome. Each pass's log knows how waves push the vehicle, but is off as a
whole by some 15 mm and 0.2° from pass to pass, but for the first. What was typed:

```sh
murkscan simulate scene1/scene.toml sea1                        # and so on for each pass
murkscan scan sea1/recording.mkv --rig sea1/rig.toml --poses log1.csv --out pass1
murkscan merge pass1 pass2 pass3 pass4 pass5 pass6 --out propeller
murkscan mesh propeller
murkscan view propeller
murkscan measure propeller deviation --reference drawing.ply
murkscan measure dome dents --reference drawing.ply --largest-mm 600 --least-depth-mm 3
```

Errors are distances to the true ship, its damage included, as far as 0.1 m; *false* are points more
than {FALSE * 1e3:g} mm from it; *found* are places of the true stripe with a point within
{FOUND * 1e3:g} mm. The tip is what lies beyond {TIP_FROM:g} m from the propeller's axis.
"""


def murkscan(*words: object) -> None:
    """Run a command as a user does, and show what it prints."""
    print("$ murkscan", *words, flush=True)
    subprocess.run([sys.executable, "-m", "murkscan", *map(str, words)], check=True)


def prepare(job: Job, model: Path, folder: Path) -> int:
    """Write drawing, ship, rig, and scene, poses and log of each pass; give how many there are."""
    folder.mkdir(parents=True, exist_ok=True)
    drawing = draw_ship(model)
    save_mesh(folder / "drawing.ply", drawing)
    passes = job.plan(drawing)
    for number, (true, log) in enumerate(zip(passes, drift(passes), strict=True), 1):
        scene = folder / f"scene{number}"
        scene.mkdir(exist_ok=True)
        save_mesh(scene / "ship.ply", job.damage(drawing))
        shutil.copy(HERE / "ship_rig.toml", scene / "rig.toml")
        shutil.copy(HERE / "ship_scene.toml", scene / "scene.toml")
        save_poses(scene / "poses.csv", true)
        save_poses(folder / f"log{number}.csv", log)
    return len(passes)


def survey(job: Job, count: int, folder: Path) -> None:
    """Simulate and scan each pass, lay them on one another, and compare them with the drawing."""
    passes = [folder / f"pass{number}" for number in range(1, count + 1)]
    for number, out in enumerate(passes, 1):
        sea = folder / f"sea{number}"
        if not (sea / "truth" / "mesh.ply").exists():
            murkscan("simulate", folder / f"scene{number}" / "scene.toml", sea)
        rig, log = sea / "rig.toml", folder / f"log{number}.csv"
        murkscan("scan", sea / "recording.mkv", "--rig", rig, "--poses", log, "--out", out)
    merged, drawing = folder / job.name, folder / "drawing.ply"
    if not (merged / "motion").exists():
        murkscan("merge", *passes, "--out", merged)
    murkscan("mesh", merged)
    if not (merged / "measure" / "deviation.json").exists():
        murkscan("measure", merged, "deviation", "--reference", drawing)
    if job.name == "dome" and not (merged / "measure" / "dents.json").exists():
        flags = ("--largest-mm", 600, "--least-depth-mm", 3)
        murkscan("measure", merged, "dents", "--reference", drawing, *flags)
    murkscan("view", merged)


def judge(job: Job, count: int, folder: Path) -> list[Figure]:
    """Hold the merged cloud, and what was measured on it, against the truth."""
    ship = load_mesh(folder / "scene1" / "ship.ply")
    passes = [Project(folder / f"pass{number}").load_cloud() for number in range(1, count + 1)]
    logged = np.concatenate([distances(cloud.points, ship) for cloud in passes])
    cloud = Project(folder / job.name).load_cloud()
    off = distances(cloud.points, ship)
    truths = [
        load_true_stripe(folder / f"sea{i}/truth/stripes.parquet") for i in range(1, count + 1)
    ]
    places = np.concatenate([truth.points for truth in truths])
    some = places[:: max(len(places) // SAMPLES, 1)]
    away, _ = KDTree(cloud.points).query(some, distance_upper_bound=FOUND)
    return [
        Figure(f"{job.name}: passes", count),
        Figure(f"{job.name}: points", len(cloud)),
        Figure(
            f"{job.name}: RMS to the ship, passes as logged",
            1e3 * rms(logged[np.isfinite(logged)]),
            "mm",
        ),
        Figure(f"{job.name}: RMS to the ship, merged", 1e3 * rms(off[np.isfinite(off)]), "mm"),
        Figure(f"{job.name}: 95 % within", 1e3 * float(np.quantile(off, 0.95)), "mm"),
        Figure(f"{job.name}: false", 100 * float(np.mean(off >= FALSE)), "%"),
        Figure(f"{job.name}: found", 100 * float(np.mean(np.isfinite(away))), "%"),
        *(judge_blade(folder / job.name, ship, folder) if job.name == "propeller" else ()),
        *(judge_dent(folder / job.name, folder) if job.name == "dome" else ()),
    ]


def judge_blade(merged: Path, ship: Mesh, folder: Path) -> list[Figure]:
    """Compare the tip's deviation from the drawing with the true one, and look at all else."""
    points, deviations, _ = load_deviation_ply(merged / "measure" / "deviation.ply")
    known = np.isfinite(deviations)
    points, deviations = points[known], deviations[known]
    is_tip = is_bent_blade(points) & (np.hypot(*(points[:, 1:] - HUB).T) > TIP_FROM)
    places = find_closest(points[is_tip], ship, within=FALSE).places
    places = places[np.isfinite(places).all(axis=1)]
    true = find_closest(places, load_mesh(folder / "drawing.ply"), within=0.1).distance
    sound = np.abs(deviations[~is_bent_blade(points)])
    return [
        Figure("propeller: the tip stands out, truly", 1e3 * float(np.median(true)), "mm"),
        Figure(
            "propeller: the tip stands out, measured",
            1e3 * float(np.median(deviations[is_tip])),
            "mm",
        ),
        Figure(
            "propeller: 95 % of the sound blades from their drawing within",
            1e3 * float(np.quantile(sound, 0.95)),
            "mm",
        ),
    ]


def judge_dent(merged: Path, folder: Path) -> list[Figure]:
    """Compare the dent that was found with the true one."""
    found = json.loads((merged / "measure" / "dents.json").read_text())["details"]["dents"]
    skin, inwards = place_dent(load_mesh(folder / "drawing.ply"))
    place = skin + DENT_DEPTH * inwards
    away = [float(np.linalg.norm(np.array(dent["place_m"]) - place)) for dent in found]
    nearest = int(np.argmin(away)) if away else 0
    depth = abs(found[nearest]["depth_m"]["value"]) if away else float("nan")
    return [
        Figure("dome: dents and bumps found, of one", len(found)),
        Figure("dome: the dent's depth, truly", 1e3 * DENT_DEPTH, "mm"),
        Figure("dome: the dent's depth, measured", 1e3 * depth, "mm"),
        Figure("dome: the dent is placed to", 1e3 * min(away, default=float("nan")), "mm"),
    ]


def show(folder: Path) -> None:
    """Copy the pictures that docs/ship.md shows, and one frame as recorded and brightened."""
    pictures = DOCS.parent / "ship"
    pictures.mkdir(exist_ok=True)
    for name, path in PICTURES.items():
        picture = cv2.imread(str(folder / path))
        height = round(picture.shape[0] * WIDTH / picture.shape[1])
        small = cv2.resize(picture, (WIDTH, height), interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(pictures / f"{name}.png"), small)
    recording = open_recording(folder / "propeller/sea3/recording.mkv")
    frame = next(recording.frames(SHOWN)).image
    brightened = np.minimum(255 * (np.maximum(frame - 4.0, 0) / 251) ** 0.45, 255).astype(np.uint8)
    cv2.imwrite(str(pictures / "frame.png"), np.hstack([frame, brightened]))

    photograph(folder / "propeller/propeller/view/index.html", pictures / "page.png")


def photograph(page: Path, picture: Path) -> None:
    """Take a picture of a page, where there is a browser; otherwise the one of before stays."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return
    if (chromium := shutil.which("chromium")) is None:
        return
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS))
        tab = browser.new_page(viewport={"width": 1280, "height": 800})
        tab.goto(page.resolve().as_uri())
        tab.wait_for_timeout(60_000)
        tab.screenshot(path=picture)
        browser.close()


def distances(points: np.ndarray, ship: Mesh) -> np.ndarray:
    """Give how far a fair choice of points lies from the ship [m]; infinite beyond 0.1 m."""
    return find_closest(points[:: max(len(points) // SAMPLES, 1)], ship, within=0.1).distance


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model", type=Path, nargs="?", default=MODEL)
    parser.add_argument("--keep", type=Path, help="folder that keeps recordings and scans")
    given = parser.parse_args()
    if not given.model.exists():
        skip("ship", f"there is no {given.model}; apt-get install flightgear-data-models")
    with tempfile.TemporaryDirectory() as scratch:
        figures, root = [], given.keep or Path(scratch)
        for job in JOBS:
            count = prepare(job, given.model, root / job.name)
            survey(job, count, root / job.name)
            figures += judge(job, count, root / job.name)
        show(root)
    tell("ship", "A cruiser's propeller and sonar dome in murk", figures, note=NOTE)


if __name__ == "__main__":
    main()
