"""The studio's server: bound to this machine, one a folder, ended by Ctrl-C."""

import re
import secrets
import socket
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

import uvicorn

from ..errors import DeviceError, InputError
from ..project.lock import hold
from .app import make_app
from .jobs import Jobs
from .sandbox import Sandbox

_TOKEN_BYTES = 24
_ALL = ("", "0.0.0.0", "::")
"""Addresses that stand for all: under which of them a page was opened could not be checked."""


def serve(
    folder: Path, *, host: str = "127.0.0.1", port: int = 0, tell: Callable[[str], None] = print
) -> None:
    """Show a folder until Ctrl-C.

    Args:
        folder: What to show; made where it is missing.
        host: Address of this machine at which to listen.
        port: Port; 0 takes that of the studio that was here before, or a free one.
        tell: Told the address to open, which carries the token, and at the end what goes on.

    Raises:
        InputError: Another studio shows this folder, it cannot be one, or the address is none.
        DeviceError: The port is taken, or the folder cannot be written.
    """
    if host in _ALL:
        raise InputError(
            f"--host {host} means all addresses at once; give the one by which others reach this "
            "machine, such as 192.168.2.1."
        )
    name = f"[{host}]" if ":" in host else host
    if not folder.exists():
        tell(f"{folder} is a new folder: there was none of that name.")
    sandbox = Sandbox.open(folder)
    with hold(sandbox.own(), ("studio", str(folder))), ExitStack() as stack:
        before, token = _recall(sandbox.own("address"))
        listening = stack.enter_context(_listen_again(host, port, before))
        place = listening.getsockname()[1]
        _remember(sandbox.own("address"), place, token)
        tell(f"http://{name}:{place}/{token}/")
        app = make_app(folder, token, hosts=(name,))
        config = uvicorn.Config(
            app, log_level="warning", server_header=False, timeout_graceful_shutdown=2,
            access_log=False, h11_max_incomplete_event_size=1 << 15,
        )  # fmt: skip
        uvicorn.Server(config).run(sockets=[listening])
    running = [job["text"] for job in Jobs(sandbox).newest() if job["state"] == "running"]
    for text in running:
        tell(f"`{text}` goes on without the studio; begin the studio again to see or stop it.")


def _recall(path: Path) -> tuple[int, str]:
    """Give the port and the token of the studio that was here before, or a new token."""
    with suppress(OSError):
        known = re.fullmatch(r"(\d{1,5}) ([\w-]{20,})\n", path.read_text("ascii", "replace"))
        if known is not None:
            return int(known[1]), known[2]
    return 0, secrets.token_urlsafe(_TOKEN_BYTES)


def _remember(path: Path, port: int, token: str) -> None:
    """Keep the address, so that pages that are open go on when the studio is begun again.

    Nobody else on this machine may read it.
    """
    path.unlink(missing_ok=True)
    path.touch(mode=0o600)
    path.write_text(f"{port} {token}\n", "ascii")


def _listen_again(host: str, port: int, before: int) -> socket.socket:
    """Listen at the port that was asked for, else at that of before, else at a free one."""
    if port == 0 and before:
        with suppress(DeviceError):
            return _listen(host, before)
    return _listen(host, port)


def _listen(host: str, port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
    except OSError as error:
        listening.close()
        raise DeviceError(
            f"Cannot listen at {host}, port {port}: {error.strerror}. Leave --port out, and a free "
            "one is taken."
        ) from error
    return listening
