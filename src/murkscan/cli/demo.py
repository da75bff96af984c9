"""murkscan demo: scan the built-in sample."""

from pathlib import Path
from typing import TYPE_CHECKING

from .progress import progress_bars
from .words import say, tell

if TYPE_CHECKING:
    from ..survey.demo import Errors


def demo(out: Path = Path("murkscan-demo")) -> None:
    """Scan the built-in sample and say how far the model is from the truth.

    The sample is a simulated recording: a ship model's hull in murky water, filmed by an
    interlaced PAL camera behind a window, as the paper's rig would. It is scanned twice: as we
    find the stripe, and as the paper does.

    Parameters
    ----------
    out
        Folder for the recording and for everything that is made of it.
    """
    say(
        "A ship model's hull, 0.5 m below a camera in water where a diver sees a metre and a half, "
        "is simulated (200 pictures, 400 fields) and scanned twice: as murkscan finds the stripe, "
        "and as the paper does. That takes about a minute on two cores, the first time half a "
        f"minute more; all of it goes into {out}."
    )
    with progress_bars() as progress:
        from ..survey.demo import run_demo
        from .summary import print_summary

        ours, paper = run_demo(out, progress=progress)
    tell("recording", f"a ship model's hull, simulated: {out / 'recording'}")
    print_summary(ours.project)
    tell("truth", *(_tell_errors(one.name, one.errors) for one in (ours, paper)))
    tell("compared", f"open {out / 'index.html'}: both scans side by side")
    tell("yours", 'README.md, section "Your own scan"; to practise: murkscan simulate --list')


def _tell_errors(name: str, errors: "Errors") -> str:
    from ..survey.demo import FALSE

    return (
        f"{name}: {errors.false / max(errors.count, 1):.1%} of the points are false, more than "
        f"{FALSE * 1e3:g} mm off; the others are off by {errors.rms * 1e3:.2f} mm (RMS)"
    )
