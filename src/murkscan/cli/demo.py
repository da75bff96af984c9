"""murkscan demo: scan the built-in sample."""

from pathlib import Path

from .progress import progress_bars


def demo(out: Path = Path("murkscan-demo")) -> None:
    """Scan the built-in sample and say how far the model is from the truth.

    The sample is a simulated recording: a ship model's hull in slightly murky water, filmed by
    an interlaced PAL camera behind a window, as the paper's rig would.

    Parameters
    ----------
    out
        Folder for the recording and for everything that is made of it.
    """
    from ..survey.demo import FALSE, run_demo
    from .summary import print_summary

    with progress_bars() as progress:
        project, errors = run_demo(out, progress=progress)
    print(f"recording  {out / 'recording'}: a ship model's hull in slightly murky water, simulated")
    print_summary(project)
    print(
        f"error      RMS {errors.rms * 1e3:.3f} mm, 95 % within {errors.within_95 * 1e3:.3f} mm of "
        f"the true hull ({errors.count - errors.false:,} points compared); "
        f"{errors.false / max(errors.count, 1):.1%} of the points are false, more than "
        f"{FALSE * 1e3:g} mm off"
    )
