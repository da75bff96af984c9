"""murkscan dive: what an MCAP, a bag or a .tlog holds."""

from pathlib import Path

from .progress import progress_bars


def dive(file: Path) -> None:
    """List what a dive's recording holds, and what of it a scan can use.

    Parameters
    ----------
    file
        An MCAP, a bag of ROS 1 or 2, or a .tlog.
    """
    from ..io.dive.gather import gather_contents
    from ..io.dive.listing import list_contents

    with progress_bars() as progress:
        contents = gather_contents(
            file, lambda done, total: progress("dive", done >> 20, total >> 20)
        )
    for line in list_contents(contents):
        print(line)
