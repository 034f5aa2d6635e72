"""The server, as a browser on this machine meets it."""

import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from beltdyn.app.server import _listening
from beltdyn.errors import ModelError


def test_it_answers_at_its_address_alone_and_ends_with_ctrl_c(tmp_path: Path, alternator_text: str) -> None:
    (tmp_path / "drive.toml").write_text(alternator_text, encoding="utf-8")
    program = "from beltdyn.cli import main; main(['app', 'drive.toml', '--no-show'])"
    server = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        found = re.search(r"http://127\.0\.0\.1:(\d+)/[\w-]{32,}/", server.stdout.readline())
        assert found is not None
        page = httpx.get(found[0])
        assert page.status_code == 200
        assert page.headers["referrer-policy"] == "no-referrer"
        script = re.search(r'src="(/[^"]+)"', page.text)
        assert script is not None
        assert httpx.get(f"http://127.0.0.1:{found[1]}{script[1]}").status_code == 200
        assert httpx.get(f"http://127.0.0.1:{found[1]}/").status_code == 404
        assert httpx.get(found[0], headers={"Host": "evil.example"}).status_code == 421
        assert sorted(one.name for one in tmp_path.iterdir()) == ["drive.toml"]
    finally:
        server.send_signal(signal.SIGINT)
        assert server.wait(timeout=30) in (0, 130)
        if server.stdout is not None:
            server.stdout.close()


def test_a_port_that_is_taken_is_one_error() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(ModelError, match=r"port = \d+ cannot be used"):
            _listening(taken.getsockname()[1])
