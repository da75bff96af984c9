"""The demo's hull: how far the cloud is from the truth."""

import tempfile
import time
from pathlib import Path

from harness import Figure, tell

from murkscan.survey.demo import FALSE, Judged, run_demo


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        ours, paper = run_demo(Path(folder))
        spent = time.perf_counter() - start
    errors = ours.errors
    tell(
        "demo",
        "The demo against its truth",
        [
            Figure("RMS distance to the true hull", errors.rms * 1e3, "mm"),
            Figure("95 % within", errors.within_95 * 1e3, "mm"),
            Figure(f"false points, more than {FALSE * 1e3:g} mm off", false(ours), "%"),
            Figure("the paper's threshold and skeleton: RMS", paper.errors.rms * 1e3, "mm"),
            Figure("the paper's threshold and skeleton: false points", false(paper), "%"),
            Figure("points compared", errors.count),
            Figure("time, with the simulation and both scans", spent, "s", at_most=45),
        ],
        note="A simulated ship model's hull in water of c = 3 /m, 0.73 to 0.85 m before an "
        "interlaced PAL camera behind a window, 200 pictures, scanned with the default settings, "
        "and once more with the paper's way to find the stripe.",
    )


def false(scan: Judged) -> float:
    return 100 * scan.errors.false / max(scan.errors.count, 1)


if __name__ == "__main__":
    main()
