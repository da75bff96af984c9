"""The door: commands by name, and what a failure says."""

import io
import os
import shutil
import sys
import traceback
from typing import get_args

from cyclopts import App, CoercionError, CycloptsError, MissingArgumentError

from ..errors import MurkscanError
from .help import Formatter
from .memory import share_freed_memory
from .typed import WORDS
from .words import wrap

_COMMANDS = {
    "demo": "Scan the built-in sample and say how far the model is from the truth.",
    "calibrate": "Find out what the camera and the laser are.",
    "capture": "Record a stream or a camera into a file, as it comes.",
    "dive": "List what an MCAP, a bag or a .tlog holds: topics, rates, holes, clock steps.",
    "live": "Record a dive, see it while it goes on, and scan it when it is over.",
    "scan": "Turn a recording into a measured 3D model: all stages in order.",
    "extract": "Find the stripe in every frame of a recording.",
    "triangulate": "Turn stripes into profiles in the camera's frame.",
    "motion": "Find where the camera was in each frame.",
    "cloud": "Merge the profiles into one cloud of points.",
    "merge": "Lay several scans of one object on another, as one cloud.",
    "georeference": "Lay a scan on control points, for exports in a coordinate system.",
    "mesh": "Make a surface from the cloud.",
    "measure": "Take measures of a scan, each with its uncertainty.",
    "accept": "Hold a scan of a ball bar, a plate or a step against limits, on a page to sign.",
    "view": "Draw the surface, and write a page to turn, cut and measure it on.",
    "report": "Write a page on how the scan went.",
    "check": "Compare every file of a scan with what was written.",
    "simulate": "Make a recording whose truth is known.",
    "turntable": "Write the pose log of an object on a turntable.",
    "plan": "Say what a rig will see in a water, before it is built.",
    "studio": "Calibrate, scan, look and measure in the browser.",
}
"""Each lies in the file of its name, and is imported when it is called: --help stays instant."""
_MATRIX_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""What NumPy's matrix products heed when it is first imported."""


def _version() -> str:
    from importlib.metadata import version

    return version("murkscan")


app = App(
    name="murkscan",
    help="Measured 3D models of objects in murky water, from a camera and a line laser.",
    version=_version,
    version_flags=["--version"],
    help_format="plaintext",
    help_formatter=Formatter(),
    suppress_keyboard_interrupt=False,
)
for _place, (_name, _help) in enumerate(_COMMANDS.items()):
    _target = "app" if _name in ("calibrate", "measure") else _name
    app.command(f"murkscan.cli.{_name}:{_target}", name=_name, help=_help, sort_key=_place)


def main() -> None:
    """Run the command line.

    Exits with 0 when done, 2 when the user's input is at fault, 130 when interrupted, and 1 when
    murkscan itself is.
    """
    for name in _MATRIX_THREADS:
        # Stages and workers fill the cores; products of small matrices only wait for one another
        # there: looking for fields took four times as long, a whole scan a sixth longer.
        os.environ.setdefault(name, "1")
    share_freed_memory()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may be no text
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run one command and give its exit status."""
    WORDS.set(tuple(arguments))
    for number, word in enumerate(arguments):
        # A path of no letters would mean the folder one happens to be in.
        if not word or (word.startswith("--") and word.endswith("=")):
            typed = " ".join(["murkscan", *arguments[: number + 1]]).rstrip(" =")
            return _say(f"what follows `{typed}` is empty; say what is meant.", 2)
    try:
        app(
            _ask_the_measure(arguments),
            exit_on_error=False,
            print_error=False,
            result_action="return_value",
        )
    except MurkscanError as error:
        return _say(str(error), 2)
    except CycloptsError as error:
        # Where we found the fault ourselves while the words were read, our own sentence says it.
        ours = isinstance(error.__cause__, MurkscanError)
        return _say(str(error.__cause__) if ours else _in_our_words(error), 2)
    except KeyboardInterrupt:
        return _say("stopped; what is finished is kept. Run the same command again.", 130)
    except OSError as error:
        return _say(f"{error.filename or 'a file'} cannot be used: {error.strerror}.", 2)
    except Exception:
        traceback.print_exc()
        return _say("this is a fault of murkscan; please report it with the lines above.", 1)
    return 0


def _ask_the_measure(arguments: list[str]) -> list[str]:
    """Let `measure OUT section --help` say what a section wants to know."""
    first, *others = arguments or [""]
    if first != "measure" or not {"--help", "-h"}.intersection(others):
        return arguments
    from .measure import What

    return [first, *[word for word in others if word in get_args(What)][:1], "--help"]


def _in_our_words(error: CycloptsError) -> str:
    """Say what is wrong with the words, without those of a programmer."""
    if isinstance(error, CoercionError) and error.token and error.target_type in (int, float):
        kind = "whole number" if error.target_type is int else "number"
        name = error.token.keyword or (error.argument.name if error.argument else "It")
        return f'{name} takes a {kind} and nothing behind it, got "{error.token.value}".'
    if isinstance(error, MissingArgumentError) and error.command_chain and error.argument:
        name, is_first = error.argument.name, error.argument.index is not None
        if name in WORDS.get():
            return f"{name} needs something behind it; the same with --help says what."
        wanted = name.lstrip("-").upper() if is_first else name
        return f"{error.command_chain[-1]} needs {wanted}; the same with --help says what that is."
    return str(error)


def _say(sentence: str, status: int) -> int:
    width = shutil.get_terminal_size().columns if sys.stderr.isatty() else 10_000
    for line in f"murkscan: {sentence}".splitlines():
        print(wrap(line, width) if len(line) > width else line, file=sys.stderr)
    return status
