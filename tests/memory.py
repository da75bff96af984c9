"""The memory that a process of a test has held."""

import resource
from pathlib import Path


def peak_kib() -> int:
    """The most that this process has held so far.

    Linux hands what the starting process had held on as `ru_maxrss`: in a long run of tests that
    is gigabytes, beside which nothing is seen. What it writes in /proc is the process's own.
    """
    status = Path("/proc/self/status")
    if not status.exists():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1])
