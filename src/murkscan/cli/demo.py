"""murkscan demo: scan the built-in sample."""

from pathlib import Path

from .progress import progress_bars


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
    from ..survey.demo import FALSE, run_demo
    from .summary import print_summary

    with progress_bars() as progress:
        ours, paper = run_demo(out, progress=progress)
    print(
        f"recording  {out / 'recording'}: a ship model's hull in water of 3 attenuations per "
        "metre, simulated"
    )
    print_summary(ours.project)
    for one in (ours, paper):
        errors = one.errors
        print(
            f"truth      {one.name}: {errors.false / max(errors.count, 1):.1%} of the points are "
            f"false, more than {FALSE * 1e3:g} mm off; the others lie within "
            f"{errors.rms * 1e3:.2f} mm RMS of the true hull"
        )
    print(f"compared   {out / 'index.html'}")
