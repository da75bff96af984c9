"""Jobs that are killed at a chosen moment and begun again, in processes of their own.

Run as `python -m tests.kills FOLDER JOB MOMENT … JOB MOMENT …`: makes what the jobs need in FOLDER,
and for each moment prints a line of JSON: what differs after the kill and a second run from a run
that nothing disturbed, but for stated times. A moment is a number of a file operation, before which
the process kills itself, or with a dot a number of seconds; `any` draws an operation by the job's
name, and `count` tells how many there are.
"""

import contextlib
import importlib
import json
import os
import random
import re
import shutil
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

FRAMES = 70
"""Two parts."""
SPEED = 0.1
_CHANGES = ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.truncate")


def make_inputs(folder: Path) -> None:
    """Simulate two small recordings of the same hull, and scan both, in a process of its own."""
    from functools import partial

    from murkscan.survey import view
    from murkscan.survey.simulate import simulate_recording
    from murkscan.view import draw_pictures

    from .scenes import hull_scene, smaller

    if (folder / "b").exists():
        return
    scene = smaller(hull_scene(num_frames=FRAMES), 3)
    simulate_recording(scene, folder / "recording")
    view.draw_pictures = partial(draw_pictures, size=(320, 240))  # as large, they take longest
    run_scan(folder, folder / "a")
    shutil.copytree(folder / "a", folder / "b")


def model(folder: Path, out: Path, speed: float) -> None:
    """Run the stages up to the surface: those that come in parts."""
    import murkscan as ms
    from murkscan.survey.cloud import build_cloud
    from murkscan.survey.extract import extract_recording
    from murkscan.survey.mesh import build_mesh
    from murkscan.survey.motion import follow_motion
    from murkscan.survey.scan import begin_scan
    from murkscan.survey.triangulate import triangulate_stripes

    recording, rig = opened(folder)
    project = ms.Project(out)
    begin_scan(project, recording, rig, settings={})
    extract_recording(project, recording, rig, ms.GrayGravity())
    triangulate_stripes(project, rig, ms.RaySheet())
    follow_motion(project, ms.ConstantSpeed(speed, "y"))
    build_cloud(project, rig)
    build_mesh(project, ms.GridMesh())


def opened(folder: Path) -> Any:
    import murkscan as ms

    rig = ms.load_rig(folder / "recording" / "rig.toml")
    frames = folder / "recording" / "frames"
    return ms.open_recording(frames, wavelength=rig.wavelength), rig


def run_scan(folder: Path, out: Path) -> None:
    """Scan into a new folder, to the report."""
    import murkscan as ms

    recording, rig = opened(folder)
    motion = ms.ConstantSpeed(SPEED, "y")
    ms.scan(recording, rig, motion, out=out, extractor=ms.GrayGravity())


def run_model(folder: Path, out: Path) -> None:
    """Make a surface in a new folder."""
    model(folder, out, SPEED)


def run_again(folder: Path, out: Path) -> None:
    """Make it with another speed in a folder that holds a scan."""
    model(folder, out, 0.9 * SPEED)


def run_pages(folder: Path, out: Path) -> None:
    """Draw the pictures and write the pages of a scan anew."""
    from murkscan.project import Project
    from murkscan.survey.report import write_report
    from murkscan.survey.view import draw_views

    draw_views(Project(out), most=1000)
    write_report(Project(out))


def run_mesh(folder: Path, out: Path) -> None:
    """Make the surface anew, with fewer triangles."""
    from murkscan.mesh import GridMesh
    from murkscan.project import Project
    from murkscan.survey.mesh import Finish, build_mesh

    build_mesh(Project(out), GridMesh(), finish=Finish(faces=2000))


def run_merge(folder: Path, out: Path) -> None:
    """Merge two scans."""
    from murkscan.survey.merge import merge_passes

    merge_passes([folder / "a", folder / "b"], out)


def run_measure(folder: Path, out: Path) -> None:
    """Cut a section, of which there was one with other files, and measure a plane."""
    import numpy as np

    from murkscan.measure import measure_plane
    from murkscan.project import Project
    from murkscan.survey.measure import measure_cut, measure_points
    from murkscan.types.plane import Plane

    project = Project(out)
    across = Plane.through(project.load_cloud().points.mean(axis=0), np.array([0.0, 1.0, 0.0]))
    for formats in (["csv", "svg"], ["svg"]):  # DXF states the time and a number drawn at random
        measure_cut(project, across, formats=formats)
    measure_points(project, measure_plane)


def run_simulate(folder: Path, out: Path) -> None:
    """Simulate a recording where there is another one."""
    from murkscan.survey.simulate import simulate_recording

    from .scenes import hull_scene, smaller

    for frames in (6, 4):
        simulate_recording(smaller(hull_scene(num_frames=frames), 3), out)


def run_export(folder: Path, out: Path) -> None:
    """Write a cloud in another format."""
    from murkscan.project import Project
    from murkscan.survey.export import export_cloud

    export_cloud(Project(folder / "a"), out / "dive.laz")


JOBS: dict[str, Callable[[Path, Path], None]] = {
    "scan": run_scan,
    "model": run_model,
    "again": run_again,
    "pages": run_pages,
    "mesh": run_mesh,
    "merge": run_merge,
    "export": run_export,
    "measure": run_measure,
    "simulate": run_simulate,
}

ON_A_SCAN = ("again", "pages", "mesh", "measure")
"""Those that begin in a folder that holds a finished scan."""


def in_a_child(run: Callable[[], None]) -> int:
    """Run in a process of its own, and give how it ended as a shell does."""
    child = os.fork()
    if child == 0:
        try:
            run()
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def kill_before(operation: int, root: Path) -> list[int]:
    """Kill this process before its n-th file operation below a folder; 0: only count."""
    counted = [0]

    def watch(event: str, arguments: tuple[object, ...]) -> None:
        if event == "open":
            path, _, flags = arguments
            changes = isinstance(flags, int) and flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        else:
            path, changes = (*arguments, None)[0], event in _CHANGES
        if changes and isinstance(path, str | os.PathLike) and str(root) in str(path):
            counted[0] += 1
            if counted[0] == operation:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(watch)
    return counted


def kill_after(seconds: float) -> None:
    """Kill this process after a time."""
    threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGKILL)).start()


def contents(root: Path) -> dict[str, object]:
    """Read all that a folder holds, but for stated times and for who held it last."""
    return {
        file.relative_to(root).as_posix(): _without_times(file)
        for file in sorted(root.rglob("*"))
        if file.is_file() and file.name not in (".lock", ".lock.json")
    }


def _without_times(file: Path) -> object:
    if file.name.endswith("stage.json"):
        note = json.loads(file.read_text("utf-8"))
        # What the report says of the times stands in its checksums, too.
        names = set(note["files"]) if file.parent.name == "report" else note["files"]
        return {**note, "seconds": 0, "files": names}
    if file.name == "scan.json":
        return {**json.loads(file.read_text("utf-8")), "started": ""}
    if file.name in ("report.json", "index.html") and file.parent.name == "report":
        text = re.sub(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?", "", file.read_text("utf-8"))
        return re.sub(r"[\d.,]+( s\b| min\b|,?\n|</td>)", r"\1", text)
    return file.read_bytes()


def begin_in(folder: Path, out: Path, job: str) -> None:
    """Make a job's folder as it is before the job: there is none, or a scan in it."""
    shutil.rmtree(out, ignore_errors=True)
    if job in ON_A_SCAN:
        shutil.copytree(folder / "a", out)


def load_what_jobs_load(folder: Path) -> None:
    """Import what the first job has imported, so that its children need not, each anew."""
    for name in (folder / "modules").read_text().split():
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


def run_undisturbed(folder: Path, job: str) -> tuple[int, dict[str, object]]:
    """Run a job to its end; give how many file operations it makes, and what it leaves."""
    want = folder / f"want-{job}"
    begin_in(folder, want, job)

    def count() -> None:
        counted = kill_before(0, want)
        JOBS[job](folder, want)
        (folder / "count").write_text(str(counted[0]))
        (folder / "modules").write_text(" ".join(sorted(sys.modules)))

    assert in_a_child(count) == 0
    load_what_jobs_load(folder)
    return int((folder / "count").read_text()), contents(want)


def disturb(folder: Path, job: str, moment: str, expected: dict[str, object]) -> dict[str, Any]:
    """Kill a job at a moment, run it again, and compare what it leaves."""
    out = folder / f"out-{job}"
    begin_in(folder, out, job)

    def disturbed() -> None:
        if "." in moment:
            kill_after(float(moment))
        else:
            kill_before(int(moment), out)
        JOBS[job](folder, out)

    first = in_a_child(disturbed)
    second = in_a_child(lambda: JOBS[job](folder, out))
    got = contents(out)
    names = sorted({n for n in got.keys() | expected.keys() if got.get(n) != expected.get(n)})
    told = {"job": job, "moment": moment, "killed": first == -signal.SIGKILL}
    return told | {"failed": second != 0, "differ": names}


def main() -> None:
    folder, job, draw = Path(sys.argv[1]), "", random.Random()
    in_a_child(lambda: make_inputs(folder))
    for word in sys.argv[2:]:
        if word in JOBS:
            job, draw = word, random.Random(word)
            count, expected = run_undisturbed(folder, job)
            continue
        moment = str(draw.randint(1, count)) if word == "any" else word
        told = {"count": count} if word == "count" else disturb(folder, job, moment, expected)
        print(json.dumps(told), flush=True)


if __name__ == "__main__":
    main()
