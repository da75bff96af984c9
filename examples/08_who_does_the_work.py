"""Who does the work: threads, a cluster
=====================================

Who works through the frames is an argument, and whoever it is, the result is the same to the byte.
``Processes(4)`` is the fourth choice: several processes on this machine.

The Dask cluster is begun on this machine here; give ``Dask("tcp://host:8786")`` for a real one
(``pip install "murkscan[cluster]"``).
"""

import time
from hashlib import sha256
from importlib import import_module

import murkscan as ms
from murkscan.distribute import Dask, Serial, Threads
from murkscan.survey.extract import extract_recording

# Processes read this file again when they begin: what they shall not do stands behind this line.
if __name__ == "__main__":
    first = import_module("01_scan_a_recording")
    recording, rig = first.recording, first.rig
    for executor in (Serial(), Threads(2), Dask(workers=2)):
        name = type(executor).__name__.lower()
        project = ms.Project(first.folder / f"by-{name}")
        since = time.perf_counter()
        extract_recording(project, recording, rig, ms.GrayGravity(), executor=executor)
        parts = sorted((project.root / "extract" / "stripes").glob("*.parquet"))
        digest = sha256(b"".join(part.read_bytes() for part in parts)).hexdigest()[:12]
        print(f"{name:10} {time.perf_counter() - since:5.1f} s   stripes {digest}")
