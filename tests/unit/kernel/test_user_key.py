"""The key of a user: made once, read by this user alone."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from beltdyn.kernel import user_key
from beltdyn.kernel.user_key import KEY_VARIABLE, SIGNATURE_SIZE, UserKeyWarning, is_signed, signature

PROGRAM = "from beltdyn.kernel.user_key import signature; print(signature(b'content').hex())"
posix = pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners and permissions of POSIX")


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A key in a folder that is not there yet."""
    path = tmp_path / "data" / "key"
    monkeypatch.setenv(KEY_VARIABLE, str(path))
    user_key._key.cache_clear()
    yield path
    user_key._key.cache_clear()


def test_processes_at_once_have_one_key(file: Path) -> None:
    processes = [subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True) for _ in range(4)]
    tags = {process.communicate()[0].strip() for process in processes}
    assert tags == {signature(b"content").hex()}
    assert [path.name for path in file.parent.iterdir()] == ["key"]


def test_signatures_are_of_one_content_and_one_key(file: Path) -> None:
    tag = signature(b"content")
    assert len(tag) == SIGNATURE_SIZE
    assert is_signed(b"content", tag)
    assert not is_signed(b"contents", tag)
    file.unlink()
    user_key._key.cache_clear()
    assert not is_signed(b"content", tag)


@posix
def test_a_key_is_for_its_user_alone(file: Path) -> None:
    signature(b"content")
    assert file.stat().st_mode & 0o077 == 0
    file.chmod(0o644)
    user_key._key.cache_clear()
    with pytest.warns(UserKeyWarning, match="other users can read"):
        signature(b"content")


@pytest.mark.parametrize(("content", "fault"), [(b"", "it has 0 bytes"), (bytes(31), "it has 31 bytes")])
def test_a_short_key_signs_for_this_process_alone(content: bytes, fault: str, file: Path) -> None:
    signature(b"content")
    file.write_bytes(content)
    user_key._key.cache_clear()
    with pytest.warns(UserKeyWarning, match=fault):
        tag = signature(b"content")
    assert is_signed(b"content", tag)


def test_a_key_that_cannot_be_kept(file: Path) -> None:
    file.parent.write_text("a file where the folder would be", encoding="utf-8")
    with pytest.warns(UserKeyWarning, match="cannot be read or written"):
        assert is_signed(b"content", signature(b"content"))
