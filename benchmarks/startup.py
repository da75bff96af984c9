"""How long the command line takes to its first word, against an empty Python."""

import os
import pty
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from harness import Figure, tell

RUNS = 9
HELPS = ("--help", "scan --help")
INSTALLED = {name: it for name, it in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""Modules are compiled once, as a user's are, also where the environment forbids to keep that."""
WRONG = {
    "no such recording": "scan nothing --rig no.toml --step-mm 1 --out x",
    "no rig file": "scan . --rig no.toml --step-mm 1 --out x",
    "no motion": "scan . --rig . --out x",
    "no setting": "extract . --rig . --out x --set clutter",
    "no photos": "calibrate camera nothing --board 9x6 --square-mm 30 --rig x",
    "no scan": "measure nothing area",
    "no such command": "frobnicate",
}


def shortest_time(*arguments: str) -> float:
    """Give the time of a fresh Python with these arguments [s], where others disturbed it least."""
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        command = [sys.executable, *arguments]
        subprocess.run(command, check=False, capture_output=True, env=INSTALLED)
        times.append(time.perf_counter() - start)
    return min(times)


def first_sight(arguments: list[str], wanted: bytes) -> float:
    """Give the shortest time until a terminal shows some words [s]; the command is then ended."""
    times = []
    for _ in range(5):
        ours, its = pty.openpty()
        start = time.perf_counter()
        command = [sys.executable, *arguments]
        child = subprocess.Popen(command, stdout=its, stderr=its, env=INSTALLED)
        os.close(its)
        shown = b""
        while wanted not in shown:
            shown += os.read(ours, 4096)
        times.append(time.perf_counter() - start)
        child.terminate()
        child.wait()
        os.close(ours)
    return min(times)


def scan_words(folder: str) -> tuple[float, float]:
    """Give the time to a scan's first word, and until it has loaded all and says what is wrong."""
    from murkscan.simulate import read_scene

    _, _, scenes = read_scene("plane")
    rig, out = scenes / "rigs" / "pal.toml", Path(folder) / "out"
    (Path(folder) / "frames").mkdir()
    words = ["-m", "murkscan", "scan", f"{folder}/frames", "--rig", str(rig), "--out", str(out)]
    words += ["--step-mm", "1"]
    return first_sight(words, b"loading"), first_sight(words, b"murkscan: ")


def main() -> None:
    shortest_time("-c", "pass")  # warms the disk
    empty = shortest_time("-c", "pass")
    helps = {words: shortest_time("-m", "murkscan", *words.split()) for words in HELPS}
    wrong = {name: shortest_time("-m", "murkscan", *words.split()) for name, words in WRONG.items()}
    with tempfile.TemporaryDirectory() as folder:
        first, loaded = scan_words(folder)
    figures = [
        Figure(f"murkscan {words}", spent, "s", at_most=0.3) for words, spent in helps.items()
    ]
    figures += [
        Figure("a wrong call, slowest of seven", max(wrong.values()), "s", at_most=0.4),
        Figure("a scan's first word", first, "s", at_most=1.2),
        Figure("a scan's stages loaded, recording opened", loaded, "s", at_most=1.2),
        Figure("murkscan --help / empty Python", helps["--help"] / empty, ": 1"),
        Figure("wrong call / empty Python", max(wrong.values()) / empty, ": 1"),
        Figure("scan's stages / empty Python", loaded / empty, ": 1"),
    ]
    tell(
        "startup",
        "Time to the first word",
        figures,
        note=f"The shortest of up to {RUNS} runs: that which others disturbed least.",
    )


if __name__ == "__main__":
    main()
