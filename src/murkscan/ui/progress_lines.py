"""How far a command is, as lines for a program that runs it."""

import json
import sys
import time

ASK = "MURKSCAN_PROGRESS"
"""Environment variable by which such a program asks for lines instead of bars: `lines`."""
_EVERY = 0.1
"""Seconds between two lines of one stage, at least."""
_HEAD = '{"progress": '


class ProgressLines:
    """A `Progress` that writes a line of JSON to the error output at every step worth one."""

    def __init__(self) -> None:
        self._stage, self._told = "", 0.0

    def __call__(self, stage: str, done: int, total: int | None) -> None:
        """Tell how far a stage is; the first and the last step of it always."""
        now = time.monotonic()
        if stage == self._stage and now < self._told + _EVERY and done != total:
            return
        self._stage, self._told = stage, now
        print(json.dumps({"progress": [stage, done, total]}), file=sys.stderr, flush=True)


def read_progress(line: str) -> tuple[str, int, int | None] | None:
    """Read such a line; None where it is another."""
    if not line.startswith(_HEAD):
        return None
    try:
        stage, done, total = json.loads(line)["progress"]
    except (ValueError, KeyError, TypeError):
        return None
    return str(stage), int(done), None if total is None else int(total)
