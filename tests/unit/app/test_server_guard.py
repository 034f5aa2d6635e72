"""Who may talk to the server."""

import asyncio
from typing import Any

import pytest

from beltdyn.app.server import LARGEST_REQUEST, Guard, new_token

TOKEN = "word"
HOST = (b"host", b"127.0.0.1:8000")
ORIGIN = (b"origin", b"http://127.0.0.1:8000")


async def _answer(scope: Any, receive: Any, send: Any) -> None:
    while (message := await receive())["type"] == "http.request" and message.get("more_body"):
        pass
    if message["type"] == "http.request":
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"page"})


def ask(path: str, headers: list[tuple[bytes, bytes]], kind: str = "http", pieces: int = 1) -> list[Any]:
    guard = Guard(_answer, TOKEN, ["127.0.0.1:8000", "localhost:8000"])
    sent: list[Any] = []
    left = iter(range(pieces, 0, -1))

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": b"x" * 1_000_000, "more_body": next(left) > 1}

    async def send(message: Any) -> None:
        sent.append(message)

    asyncio.run(guard({"type": kind, "path": path, "headers": headers}, receive, send))
    return sent


def status(path: str, headers: list[tuple[bytes, bytes]]) -> int:
    return int(ask(path, headers)[0]["status"])


def test_the_address_with_its_token_is_answered_and_keeps_itself_to_itself() -> None:
    start, body = ask(f"/{TOKEN}/", [HOST])
    assert (start["status"], body["body"]) == (200, b"page")
    assert dict(start["headers"])[b"referrer-policy"] == b"no-referrer"
    assert b"frame-ancestors 'self'" in dict(start["headers"])[b"content-security-policy"]
    assert status(f"/{TOKEN}/_nicegui/x", [(b"host", b"localhost:8000"), ORIGIN]) == 200


@pytest.mark.parametrize("path", ["/", "/word", "/wordy/", "/other/x", "//word/", "/WORD/", "/wörd/"])
def test_without_the_token_nothing_is_there(path: str) -> None:
    assert status(path, [HOST]) == 404


@pytest.mark.parametrize("host", [b"evil.example", b"127.0.0.1:8001", b"127.0.0.1", b"127.0.0.1:8000.evil.example"])
def test_another_host_is_refused(host: bytes) -> None:
    assert status(f"/{TOKEN}/", [(b"host", host)]) == 421
    assert status(f"/{TOKEN}/", []) == 421
    assert status(f"/{TOKEN}/", [HOST, (b"Host", host)]) == 421


@pytest.mark.parametrize(
    "origin", [b"http://evil.example", b"null", b"https://127.0.0.1:8000", b"http://127.0.0.1:8001"]
)
def test_another_origin_is_refused(origin: bytes) -> None:
    assert status(f"/{TOKEN}/", [HOST, (b"origin", origin)]) == 403
    (closed,) = ask(f"/{TOKEN}/_nicegui_ws/", [HOST, (b"origin", origin)], "websocket")
    assert (closed["type"], closed["code"]) == ("websocket.close", 1008)


def test_a_socket_says_where_it_comes_from() -> None:
    assert ask(f"/{TOKEN}/_nicegui_ws/", [HOST], "websocket")[0]["type"] == "websocket.close"
    assert all(one["type"] != "websocket.close" for one in ask(f"/{TOKEN}/ws/", [HOST, ORIGIN], "websocket"))


def test_requests_are_bounded_also_where_they_do_not_say_how_long_they_are() -> None:
    for length in (str(LARGEST_REQUEST + 1).encode(), b"-1", b"x"):
        assert status(f"/{TOKEN}/", [HOST, (b"content-length", length)]) == 413
    assert ask(f"/{TOKEN}/", [HOST], pieces=3)[0]["status"] == 200
    assert ask(f"/{TOKEN}/", [HOST], pieces=9) == []


def test_tokens_differ_and_are_long() -> None:
    assert len({new_token() for _ in range(50)}) == 50
    assert len(new_token()) >= 32
