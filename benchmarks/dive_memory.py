"""What listing and reading a very large dive's file take of memory.

Run: python benchmarks/dive_memory.py [--gigabytes 10] [--work FOLDER]
"""

import argparse
import shutil
from pathlib import Path

import numpy as np
from dive import FILLER, PICTURES, RATE, SPEED, START, UNREST, measure_memory
from dive_files import Dive, encode_h264
from harness import tell

from murkscan.simulate import drive

NOTE = f"""
An MCAP as BlueOS writes it, of pictures of mere noise in H.264, each padded by {FILLER // 1000} kB,
and attitude and depth at 10 Hz; made by the format's own library. *listing* is `murkscan dive FILE`
of the whole file, *reading* a hundred pictures at its end and 48 spread over it. Memory is the
largest resident set of the process beyond that of one which only imports the same. Times are of a
machine of two cores on which others worked.
"""


def make_dive() -> Dive:
    """Give a dive whose pictures are cheap to make."""
    length = PICTURES / RATE
    way = drive(UNREST, np.array([0.0, SPEED, 0.0]), np.array(START), length, seed=1)
    random = np.random.default_rng(0)
    noise = [random.normal(40, 3, (576, 720)).clip(0, 255).astype(np.uint8) for _ in range(25)]
    packets = encode_h264(noise * (PICTURES // len(noise)), RATE)
    logged = way.at(np.arange(-1.0, length + 1.0, 0.1))
    return Dive(packets, np.arange(PICTURES) / RATE, logged)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gigabytes", default="10")
    parser.add_argument("--work", type=Path, default=Path("dive-memory-work"))
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    sizes = [float(size) for size in given.gigabytes.split(",")]
    try:
        figures = measure_memory(given.work, make_dive(), sizes)
    finally:
        shutil.rmtree(given.work)
    tell("dive_memory", "A dive's file of ten gigabytes", figures, note=NOTE)


if __name__ == "__main__":
    main()
