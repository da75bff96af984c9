"""How long the command line takes to say its help, against an empty Python."""

import statistics
import subprocess
import sys
import time

from harness import Figure, tell

RUNS = 15


def median_time(*arguments: str) -> float:
    """Give the median time of a fresh Python with these arguments [s]."""
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def main() -> None:
    median_time("-c", "pass")  # warms the disk
    empty = median_time("-c", "pass")
    helps = {
        words: median_time("-m", "murkscan", *words.split()) for words in ("--help", "scan --help")
    }
    figures = [
        Figure(f"murkscan {words}", spent, "s", at_most=0.5) for words, spent in helps.items()
    ]
    figures.append(Figure("murkscan --help / empty Python", helps["--help"] / empty, ": 1"))
    tell("startup", "Time to the first word of help", figures, note=f"Medians of {RUNS} runs.")


if __name__ == "__main__":
    main()
