"""The door: who may ask, from where, how much, and how many at once."""

import hmac
from collections.abc import Sequence
from dataclasses import dataclass, field

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_LARGEST = 1 << 16
"""Bytes of a question that is no upload."""
_AT_ONCE = 40
"""Questions that are answered at once; a page asks four or five."""
_PAGES = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; frame-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
_FILES = (
    "sandbox allow-scripts allow-downloads allow-popups; default-src 'self' 'unsafe-inline' data: "
    "blob:; frame-ancestors 'self'"
)
"""A page that lies in the folder runs as a stranger: it can ask the studio for nothing."""


@dataclass
class Guard:
    """Lets through what comes from the studio's own page, with the token in its address.

    The token is the first part of every path, so that a page's relative addresses carry it and no
    cookie is needed that another program on this machine could be sent.
    """

    app: ASGIApp
    token: str
    hosts: Sequence[str]
    """Names by which this machine is addressed; of others the page is somebody else's trick."""
    largest_upload: int
    """Bytes."""
    open: int = field(default=0, init=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a question through, or say in a sentence why not."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        refusal = self._refuse(scope)
        if refusal is not None:
            await refusal(scope, receive, send)
            return
        self.open += 1
        try:
            await self.app(scope, _counted(receive, self._limit(scope)), _guarded(send, scope))
        finally:
            self.open -= 1

    def _refuse(self, scope: Scope) -> PlainTextResponse | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if host.rsplit(":", 1)[0] not in self.hosts:
            return _say(403, "The studio does not answer to this name; use the address it printed.")
        given = scope["path"].split("/", 2)[1].encode()
        if not hmac.compare_digest(given, self.token.encode()):
            return _say(403, "This address lacks the studio's token; use the one it printed.")
        if scope["method"] not in ("GET", "HEAD") and headers.get("origin") != f"http://{host}":
            return _say(403, "Only the studio's own page may ask for this.")
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > self._limit(scope):
            return _say(413, _too_large(self._limit(scope)))
        if self.open >= _AT_ONCE:
            return _say(503, "Too many questions at once; the page asks again by itself.")
        return None

    def _limit(self, scope: Scope) -> int:
        is_upload = scope["method"] == "PUT"
        return self.largest_upload if is_upload else _LARGEST


def _too_large(limit: int) -> str:
    return f"That is larger than {limit:,} bytes, the most allowed."


def _say(status: int, sentence: str) -> PlainTextResponse:
    return PlainTextResponse(sentence, status, {"X-Content-Type-Options": "nosniff"})


def _counted(receive: Receive, limit: int) -> Receive:
    """Count what comes, since a length need not be said; what is too much is refused."""
    got = 0

    async def counted() -> Message:
        nonlocal got
        message = await receive()
        got += len(message.get("body", b""))
        if got > limit:
            raise HTTPException(413, _too_large(limit))
        return message

    return counted


def _guarded(send: Send, scope: Scope) -> Send:
    """Put on every answer what browsers shall not do with it."""
    is_file = scope["path"].split("/", 3)[2:3] == ["files"]

    async def guarded(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers["Content-Security-Policy"] = _FILES if is_file else _PAGES
            headers["X-Content-Type-Options"] = "nosniff"
            headers["Referrer-Policy"] = "same-origin"
            headers["Cache-Control"] = "no-store" if not is_file else "no-cache"
            if not is_file:
                headers["Cross-Origin-Resource-Policy"] = "same-origin"
        await send(message)

    return guarded
