"""The server, on this machine only, at a free port and a secret address."""

import asyncio
import socket
import threading
import webbrowser
from collections.abc import Callable

import uvicorn
from fastapi import FastAPI
from nicegui import ui

from beltdyn.app.guard import LARGEST_REQUEST, Guard, new_token
from beltdyn.app.page import Page
from beltdyn.app.workspace import Workspace
from beltdyn.errors import ModelError

_HOST = "127.0.0.1"
_NAMES = (_HOST, "localhost")


def serve(workspace: Workspace, port: int, show: bool, tell: Callable[[str], None]) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    workspace : Workspace
        The folder, and the drive file that a new tab opens.
    port : int
        The port; zero for one that is free.
    show : bool
        Open the browser.
    tell : callable
        Is given the address once the server answers.

    Raises
    ------
    ModelError
        If the port is taken.
    """
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
