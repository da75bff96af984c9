"""murkscan demo: scan the built-in sample."""

from pathlib import Path

from .progress import progress_bars


def demo(out: Path = Path("murkscan-demo")) -> None:
    """Scan the built-in sample and say how far the model is from the truth.

    The sample is a simulated recording of a ship model's hull by the paper's rig.

    Parameters
    ----------
    out
        Folder for the recording and for everything that is made of it.
    """
    from ..survey.demo import run_demo
    from .summary import print_summary

    with progress_bars() as progress:
        project, errors = run_demo(out, progress=progress)
    print(f"recording  {out / 'recording'}: a ship model's hull, 0.9 m, simulated")
    print_summary(project)
    print(
        f"error      RMS {errors.rms * 1e3:.3f} mm, 95 % within {errors.within_95 * 1e3:.3f} mm, "
        f"largest {errors.largest * 1e3:.3f} mm from the true hull ({errors.count:,} points)"
    )
