"""A server and a real browser: Chromium as the system has it, driven by Playwright (`make browser`).

With BELTDYN_PICTURES=FOLDER pictures are kept there, to be looked at.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright")

PATIENCE = 300_000
"""Time within which the page answers, on a machine that has much else to do too, ms."""
_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


playwright.expect.set_options(timeout=PATIENCE)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    found = os.environ.get("BELTDYN_BROWSER") or next(filter(None, map(shutil.which, _NAMES)), None)
    if found is None:
        pytest.fail("no browser was found: install chromium, or name one in BELTDYN_BROWSER")
    with playwright.sync_playwright() as started:
        launched = started.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def shoot() -> Callable[[Any, str], None]:
    """Keep a picture of a page, if a folder for pictures is named."""
    folder = os.environ.get("BELTDYN_PICTURES")

    def keep(page: Any, name: str) -> None:
        if folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=str(Path(folder) / f"{name}.png"))

    return keep


class Server:
    """`beltdyn app` in a folder."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        program = f"from beltdyn.cli import main; main(['app', '--no-show', *{list(arguments)!r}])"
        command = [sys.executable, "-c", program]
        self.process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        found = re.search(r"http\S+", self.process.stdout.readline())
        assert found is not None
        self.address = found[0]

    def end(self) -> str:
        """End it, and give what it said of errors."""
        self.process.terminate()
        _, said = self.process.communicate(timeout=300)
        return said


@pytest.fixture(scope="session")
def serve() -> Callable[..., Server]:
    """What starts a server in a folder."""
    return Server


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    text = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    (tmp_path / "drive.toml").write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def server(folder: Path) -> Iterator[Server]:
    started = Server(folder, "drive.toml")
    yield started
    said = started.end()
    assert "Traceback" not in said, said


@pytest.fixture
def open_page(browser: Any, server: Server) -> Iterator[Callable[..., Any]]:
    """Open the page in a tab of its own; nothing may be asked of other servers, and no script may fail."""
    contexts, faults = list[Any](), list[str]()

    def watch(request: Any) -> None:
        if not request.url.startswith(("http://127.0.0.1:", "ws://127.0.0.1:", "data:", "blob:", "mailto:")):
            faults.append(f"asks {request.url}")

    def opened(width: int = 1400, height: int = 900, scheme: str = "light") -> Any:
        context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)
        contexts.append(context)
        context.set_default_timeout(PATIENCE)
        page = context.new_page()
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", watch)
        page.goto(server.address)
        page.wait_for_selector(".bd-canvas")
        page.wait_for_function("document.querySelector('.bd-canvas').getAttribute('aria-label') !== ''")
        return page

    yield opened
    for context in contexts:
        context.close()
    assert faults == []
