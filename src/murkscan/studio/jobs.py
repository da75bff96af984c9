"""Commands as child processes: one at a time, told how far they are, stopped as by Ctrl-C."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ..errors import FormatError, InputError
from ..io.json_files import load_json, save_json
from ..ui.progress_lines import ASK, read_progress
from .commands import Command
from .sandbox import Sandbox

_TAIL = 1 << 16
"""Bytes of what a job says that are shown: its end."""
_SHOWN = 8
"""Jobs that the page lists."""
State = Literal["running", "done", "refused", "stopped", "failed"]
_STATES: dict[int, State] = {0: "done", 2: "refused", 130: "stopped", -2: "stopped"}
"""What exit statuses mean; all else is our own fault."""


@dataclass(frozen=True)
class Job:
    """A command that was begun here."""

    name: str
    """Its file's, which sorts by time."""
    text: str
    """As it would be typed in the folder."""
    page: str
    """The page that began it."""
    out: str
    """The folder that it works in, within the studio's; empty where that is none of its own."""
    process: int
    began: float


class Jobs:
    """The jobs of a folder: what they say goes to files, so that they outlive the studio."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox, self._folder = sandbox, sandbox.own("jobs")
        self._children: dict[str, subprocess.Popen[bytes]] = {}
        self._lock = threading.Lock()

    def start(self, command: Command) -> dict[str, Any]:
        """Begin a command.

        Raises:
            InputError: Another one runs.
            DeviceError: The folder cannot be written.
        """
        with self._lock:
            running = [one for one in self.newest() if one["state"] == "running"]
            if running:
                raise InputError(
                    f"One thing at a time: `{running[0]['text']}` is at work. Wait until it is "
                    "done, or stop it."
                )
            name = f"{time.time_ns() // 1_000_000:013d}"
            self._folder.mkdir(parents=True, exist_ok=True)
            child = self._spawn(name, command)
            job = Job(name, command.text, command.page, command.out, child.pid, time.time())
            self._children[name] = child
            save_json(self._folder / f"{name}.json", vars(job))
        return self.tell(job)

    def stop(self, name: str) -> dict[str, Any]:
        """Stop a command as Ctrl-C does: it ends its work so that it can go on later.

        Raises:
            InputError: There is no such job.
        """
        job = next((one for one in self._load() if one.name == name), None)
        if job is None:
            raise InputError("There is no such job.")
        if self._state(job) == "running":
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(job.process, signal.SIGINT)
        return self.tell(job)

    def newest(self) -> list[dict[str, Any]]:
        """Tell of the last jobs, the newest first."""
        return [self.tell(job) for job in self._load()]

    def tell(self, job: Job) -> dict[str, Any]:
        """Say what a job is, how far it is, and what it said."""
        said = _tail(self._folder / f"{job.name}.out")
        progress, errors = None, list[str]()
        for line in _tail(self._folder / f"{job.name}.err").splitlines():
            read = read_progress(line)
            progress = read or progress
            if read is None:
                errors.append(line)
        state = self._state(job)
        is_fault = state in ("refused", "failed")
        sentence = next((e for e in reversed(errors) if e.startswith("murkscan: ")), "")
        return {
            **{key: value for key, value in vars(job).items() if key != "process"},
            "state": state,
            "progress": progress if state == "running" else None,
            "said": said,
            "sentence": sentence.removeprefix("murkscan: ") if is_fault or sentence else "",
            "errors": "\n".join(errors[-40:]) if state == "failed" else "",
        }

    def _spawn(self, name: str, command: Command) -> "subprocess.Popen[bytes]":
        out, err = (self._folder / f"{name}.{kind}" for kind in ("out", "err"))
        with out.open("wb") as said, err.open("wb") as faults:
            return subprocess.Popen(
                [sys.executable, "-m", "murkscan", *command.words],
                cwd=self._sandbox.root,
                env=os.environ | {ASK: "lines", "PYTHONIOENCODING": "utf-8"},
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=faults,
                # Of its own, so that neither the studio's end nor its Ctrl-C ends a recording.
                start_new_session=True,
            )

    def _load(self) -> list[Job]:
        jobs = []
        for path in sorted(self._folder.glob("*.json"), reverse=True)[:_SHOWN]:
            with suppress(FormatError, TypeError):
                jobs.append(Job(**load_json(path)))
        return jobs

    def _state(self, job: Job) -> State:
        child = self._children.get(job.name)
        if child is not None:
            status = child.poll()
            return "running" if status is None else _STATES.get(status, "failed")
        # Begun by a studio that is gone: whether it ended well, only its words tell.
        if _is_alive(job.process):
            return "running"
        errors = _tail(self._folder / f"{job.name}.err")
        return "refused" if "\nmurkscan: " in f"\n{errors}" else "done"


def _is_alive(process: int) -> bool:
    """Tell whether a process still runs, and is one of ours: numbers are given out again."""
    try:
        os.kill(process, 0)
        command = Path(f"/proc/{process}/cmdline")
        return not command.exists() or b"murkscan" in command.read_bytes()
    except OSError:
        return False


def _tail(path: Path) -> str:
    try:
        with path.open("rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(file.tell() - _TAIL, 0))
            return file.read().decode("utf-8", "replace")
    except OSError:
        return ""
