"""The questions that pages ask, and who answers them."""

import mimetypes
import os
import shutil
from collections.abc import Awaitable, Callable
from dataclasses import asdict
from functools import partial
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import anyio
from anyio import to_thread
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp

from ..errors import FormatError, InputError, MurkscanError
from .boards import Boards, ask_for_photo, tell_sight
from .commands import make_command
from .dives import pack_points, tell_dive
from .finds import look_around
from .guard import Guard
from .jobs import Jobs
from .plans import tell_best, tell_plan
from .rigs import tell_rig
from .sandbox import Sandbox
from .scans import tell_scan
from .uploads import take_upload

_LARGEST_UPLOAD = 4_000_000_000
"""Bytes of a file that a page brings: some twenty minutes of video."""
_HOSTS = ("127.0.0.1", "localhost", "[::1]")
_FORECASTS = 1
"""Plans that are computed at once; others wait."""
_SMALL = 2_000_000
"""Bytes up to which a file is read whole before it is sent."""
_DIGITS = 9
"""Digits of a part's number, at most."""
_BROKEN = (ValueError, RecursionError, ClientDisconnect)
_OTHER = (KeyError, TypeError, AttributeError)
"""What a question raises that cannot be read, or was cut off for its length; and one of another
kind."""
Answer = Callable[[Request], Awaitable[Response]]


def make_app(
    folder: Path, token: str, *, hosts: tuple[str, ...] = (), largest_upload: int = _LARGEST_UPLOAD
) -> ASGIApp:
    """Make the application for a folder.

    Args:
        folder: The one folder that it shows and works in.
        token: What every address begins with.
        hosts: More names or addresses by which browsers may call this machine.
        largest_upload: Largest file that it takes [bytes].

    Raises:
        InputError: The folder cannot be one.
    """
    sandbox = Sandbox.open(folder)
    studio = _Studio(sandbox, Jobs(sandbox))
    web = files("murkscan.studio") / "web"
    routes = [
        Route("/", studio.page),
        Route("/api/folder", _said(studio.folder)),
        Route("/api/rig", _said(studio.rig)),
        Route("/api/plan", _said(studio.plan)),
        Route("/api/plan/best", _said(studio.best)),
        Route("/api/scan", _said(studio.scan)),
        Route("/api/boards", _said(studio.boards)),
        Route("/api/sight", _said(studio.sight)),
        Route("/api/sight/take", _said(studio.photo), methods=["POST"]),
        Route("/api/dive", _said(studio.dive)),
        Route("/api/points", _said(studio.points)),
        Route("/api/command", _said(studio.command), methods=["POST"]),
        Route("/api/jobs", _said(studio.start), methods=["POST"]),
        Route("/api/jobs/{name}/stop", _said(studio.stop), methods=["POST"]),
        Route("/api/upload/{name:path}", _said(studio.upload), methods=["PUT"]),
        Route("/files/{name:path}", _said(studio.file)),
        Mount("/web", StaticFiles(directory=str(web))),
    ]

    inner = Starlette(
        routes=[Mount(f"/{token}", routes=routes)],
        exception_handlers={HTTPException: _refuse, Exception: _fail},
    )
    return Guard(inner, token, (*_HOSTS, *hosts), largest_upload)


class _Studio:
    """One folder, and what runs in it."""

    def __init__(self, sandbox: Sandbox, jobs: Jobs) -> None:
        self._sandbox, self.jobs, self._boards = sandbox, jobs, Boards(sandbox)
        self._forecasts = anyio.CapacityLimiter(_FORECASTS)

    async def page(self, request: Request) -> Response:
        """Give the page itself."""
        index = files("murkscan.studio") / "web" / "index.html"
        return Response(index.read_bytes(), media_type="text/html")

    async def folder(self, request: Request) -> Any:
        """Say what lies in the folder and what runs."""
        found = await to_thread.run_sync(look_around, self._sandbox)
        jobs = await to_thread.run_sync(self.jobs.newest)
        return {
            "folder": str(self._sandbox.root),
            "version": version("murkscan"),
            "process": os.getpid(),
            "free_bytes": shutil.disk_usage(self._sandbox.root).free,
            "found": asdict(found),
            "jobs": jobs,
        }

    async def rig(self, request: Request) -> Any:
        """Say how well a rig is calibrated."""
        return await to_thread.run_sync(
            tell_rig, self._sandbox, request.query_params.get("name", "")
        )

    async def plan(self, request: Request) -> Any:
        """Say what a rig will see."""
        task = partial(tell_plan, self._sandbox, dict(request.query_params))
        return await to_thread.run_sync(task, limiter=self._forecasts)

    async def best(self, request: Request) -> Any:
        """Say where the laser would better sit."""
        task = partial(tell_best, self._sandbox, dict(request.query_params))
        return await to_thread.run_sync(task, limiter=self._forecasts)

    async def scan(self, request: Request) -> Any:
        """Say what a scan has come to."""
        name = request.query_params.get("name", "")
        return await to_thread.run_sync(tell_scan, self._sandbox, name)

    async def boards(self, request: Request) -> Any:
        """Say which photos of a folder show a board."""
        task = partial(self._boards.tell, dict(request.query_params))
        return await to_thread.run_sync(task)

    async def sight(self, request: Request) -> Any:
        """Say what the camera sees while photos are taken."""
        name = request.query_params.get("folder", "")
        return await to_thread.run_sync(tell_sight, self._sandbox, name)

    async def photo(self, request: Request) -> Any:
        """Ask for a photo."""
        name = request.query_params.get("folder", "")
        return await to_thread.run_sync(ask_for_photo, self._sandbox, name)

    async def dive(self, request: Request) -> Any:
        """Say what a running dive shows."""
        name = request.query_params.get("name", "")
        return await to_thread.run_sync(tell_dive, self._sandbox, name)

    async def points(self, request: Request) -> Response:
        """Give the points of a dive's preview from a part on."""
        first = request.query_params.get("first", "0")
        if not first.isdecimal() or len(first) > _DIGITS:
            raise InputError("Parts of a preview are numbered from 0.")
        task = partial(pack_points, self._sandbox, request.query_params.get("name", ""), int(first))
        packed, following = await to_thread.run_sync(task)
        kind = "application/octet-stream"
        return Response(packed, media_type=kind, headers={"x-next": str(following)})

    async def command(self, request: Request) -> Any:
        """Write a command as it would be typed, without running it."""
        return {"text": (await self._asked(request)).text}

    async def start(self, request: Request) -> Any:
        """Begin a command."""
        return await to_thread.run_sync(self.jobs.start, await self._asked(request))

    async def stop(self, request: Request) -> Any:
        """Stop a command."""
        return await to_thread.run_sync(self.jobs.stop, request.path_params["name"])

    async def upload(self, request: Request) -> Any:
        """Take a file into the folder."""
        return {"name": await take_upload(request, self._sandbox, request.path_params["name"])}

    async def file(self, request: Request) -> Response:
        """Give a file of the folder."""
        path = self._sandbox.existing(request.path_params["name"])
        if not path.is_file():
            raise InputError(f"{request.path_params['name']!r} is no file.")
        if path.stat().st_size > _SMALL:
            return FileResponse(path)
        # Read at once: pictures of a dive are replaced while they are sent.
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        return Response(await to_thread.run_sync(path.read_bytes), media_type=kind)

    async def _asked(self, request: Request) -> Any:
        try:
            asked = await request.json()
            name, values, page = asked["command"], dict(asked["values"]), str(asked.get("page", ""))
        except (*_BROKEN, *_OTHER) as error:
            raise InputError("That is no question of the studio's own page.") from error
        return make_command(self._sandbox, str(name), values, page=page[:40])


def _said(answer: Callable[[Request], Awaitable[Any]]) -> Answer:
    """Answer with JSON; what is wrong is said in its one sentence."""

    async def said(request: Request) -> Response:
        try:
            content = await answer(request)
        except (InputError, FormatError) as error:
            return PlainTextResponse(str(error), 400)
        except MurkscanError as error:
            return PlainTextResponse(str(error), 409)
        return content if isinstance(content, Response) else JSONResponse(content)

    return said


async def _refuse(_: Request, error: Exception) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else 500
    words = {404: "There is no such page.", 405: "That cannot be asked of this page."}
    if isinstance(error, HTTPException) and status == 413:
        words[status] = error.detail
    return PlainTextResponse(words.get(status, "The studio cannot answer that."), status)


async def _fail(_: Request, __: Exception) -> Response:
    sentence = "This is a fault of murkscan; please report it with what the terminal says."
    return PlainTextResponse(sentence, 500)
