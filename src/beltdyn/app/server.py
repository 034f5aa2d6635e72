"""The server, on this machine only, at a free port and a secret address."""

import asyncio
import secrets
import socket
import threading
import webbrowser
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from typing import Any

import uvicorn
from fastapi import FastAPI
from nicegui import ui

from beltdyn.app.main_page import Page
from beltdyn.app.workspace import Workspace
from beltdyn.errors import ModelError

# Access control of the server: only a browser on this machine that knows the address, and no other pages

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

LARGEST_REQUEST = 5_000_000
"""Limit of a request or socket message, bytes."""
_HEADERS = (
    (b"referrer-policy", b"no-referrer"),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"SAMEORIGIN"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (
        b"content-security-policy",
        b"frame-ancestors 'self'; form-action 'self'; base-uri 'self'; object-src 'none'; connect-src 'self'",
    ),
)


def new_token() -> str:
    """A secret token in the address."""
    return secrets.token_urlsafe(24)


class Guard:
    """An application that forwards permitted requests and rejects all others.

    A page of another site may send requests to a server on this machine, and find its port. It cannot know the token
    with which all addresses begin, be of the same origin, or, by a host name of its own, send the right Host.
    """

    def __init__(self, application: Application, token: str, hosts: Iterable[str]) -> None:
        self._application = application
        self._token = token
        self._hosts = {host.encode() for host in hosts}
        self._origins = {b"http://" + host for host in self._hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or open a socket."""
        if scope["type"] not in ("http", "websocket"):
            await self._application(scope, receive, send)
            return
        refused = self.refusal(scope)
        if refused is not None:
            await _refuse(scope, send, *refused)
            return
        await self._application(scope, _bounded(receive), _with_headers(send))

    def refusal(self, scope: Scope) -> tuple[int, str] | None:
        """Status and reason of a rejected request; None for a permitted one."""
        headers = [(name.lower(), value) for name, value in scope["headers"]]
        hosts = [value for name, value in headers if name == b"host"]
        origins = [value for name, value in headers if name == b"origin"]
        lengths = [value for name, value in headers if name == b"content-length"]
        if len(hosts) != 1 or hosts[0] not in self._hosts:
            return 421, "This server answers only to its own address."
        if any(origin not in self._origins for origin in origins):
            return 403, "Other pages may not access this page."
        if scope["type"] == "websocket" and not origins:
            return 403, "A socket request needs an Origin header."
        parts = str(scope["path"]).split("/", 2)
        if len(parts) < 3 or not secrets.compare_digest(parts[1].encode(), self._token.encode()):
            return 404, "Open the complete address printed by `beltdyn app`."
        if any(not length.isdigit() or int(length) > LARGEST_REQUEST for length in lengths):
            return 413, f"The limit of a request is {LARGEST_REQUEST:,} bytes."
        return None


def _bounded(receive: Receive) -> Receive:
    """Cut off a request of unstated length that exceeds the limit."""
    taken = 0

    async def bounded() -> Message:
        nonlocal taken
        message = await receive()
        if message["type"] == "http.request":
            taken += len(message.get("body", b""))
            if taken > LARGEST_REQUEST:
                return {"type": "http.disconnect"}
        return message

    return bounded


def _with_headers(send: Send) -> Send:
    """Tell the browser to keep the address to itself, and the page out of frames."""

    async def told(message: Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message.get("headers", ()), *_HEADERS]
        await send(message)

    return told


async def _refuse(scope: Scope, send: Send, status: int, reason: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": reason})
        return
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": reason.encode()})


_HOST = "127.0.0.1"
_NAMES = (_HOST, "localhost")


def serve(workspace: Workspace, port: int, show: bool, tell: Callable[[str], None]) -> None:
    """Serve the page until Ctrl-C."""
    with _listening(port) as listening:
        port, token = listening.getsockname()[1], new_token()
        address = f"http://{_HOST}:{port}/{token}/"
        application = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
        ui.run_with(
            application,
            root=lambda: Page(workspace).build(),
            title="beltdyn",
            favicon=_ICON,
            dark=None,
            mount_path=f"/{token}",
            reconnect_timeout=30.0,
            show_welcome_message=False,
        )
        guard = Guard(application, token, [f"{name}:{port}" for name in _NAMES])
        server = _Server(
            uvicorn.Config(
                guard,
                log_level="error",
                ws_max_size=LARGEST_REQUEST,
                timeout_graceful_shutdown=1,
                server_header=False,
            )
        )
        server.when_started = lambda: _announce(address, show, tell)
        try:
            asyncio.run(server.serve(sockets=[listening]))
        finally:
            workspace.close()


def _announce(address: str, show: bool, tell: Callable[[str], None]) -> None:
    tell(address)
    if show:
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


class _Server(uvicorn.Server):
    """A server that says when it answers."""

    when_started: Callable[[], None]

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """As in the base."""
        await super().startup(sockets)
        if self.started:
            self.when_started()


def _listening(port: int) -> socket.socket:
    """A socket on the loopback device."""
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listening.bind((_HOST, port))
    except (OSError, OverflowError) as error:
        listening.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise ModelError(
            f"port = {port} cannot be used: {reason.lower()}. Choose another --port, or omit it."
        ) from error
    return listening


_ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32" fill="none" stroke="#2b6cb0" stroke-width="3">'
    '<circle cx="9" cy="20" r="6"/><circle cx="24" cy="12" r="4"/><path d="M6 15 L22 8 M11 26 L26 16"/></svg>'
)
