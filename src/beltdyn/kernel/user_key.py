"""The secret key with which a user's own files are signed, where their content reaches machine code."""

import hmac
import os
import secrets
import tempfile
import warnings
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from beltdyn.kernel.fingerprint import fault_of_file

KEY_VARIABLE = "BELTDYN_KEY_FILE"
"""Environment variable that moves the key (default: the user's data folder)."""

SIGNATURE_SIZE = 32
"""Bytes of a signature, and of the key: more than the hash has would not make it safer."""


class UserKeyWarning(UserWarning):
    """What is signed now can be read by this process alone."""


def key_file() -> Path:
    """File of the key."""
    return Path(os.environ.get(KEY_VARIABLE) or platformdirs.user_data_path("beltdyn") / "key")


def signature(content: bytes | memoryview) -> bytes:
    """Signature of some bytes, which only who has the key can make."""
    return hmac.digest(_key(), content, "sha256")


def is_signed(content: bytes | memoryview, tag: bytes | memoryview) -> bool:
    """Whether a signature of some bytes was made with the key."""
    return hmac.compare_digest(signature(content), tag)


@cache
def _key() -> bytes:
    """The key, made by the first process that needs it; one of this process where it cannot be kept."""
    path = key_file()
    try:
        key = path.read_bytes() if path.exists() else _new_key(path)
        fault = fault_of_file(path) or (f"it has {len(key)} bytes" if len(key) != SIGNATURE_SIZE else "")
    except OSError as error:
        fault = f"it cannot be read or written ({error.strerror or error})"
    if not fault:
        return key
    warnings.warn(
        f"The key {path} is not usable: {fault}. Checkpoints and states of units can be read by this process alone. "
        f"Remove the file, or set {KEY_VARIABLE} to one in a folder of your own.",
        UserKeyWarning,
        stacklevel=4,
    )
    return secrets.token_bytes(SIGNATURE_SIZE)


def _new_key(path: Path) -> bytes:
    """Write a key, whole and readable by this user alone, unless another process is faster; read what stays."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        new = Path(folder, path.name)
        new.touch(mode=0o600)
        new.write_bytes(secrets.token_bytes(SIGNATURE_SIZE))
        with suppress(FileExistsError):
            os.link(new, path)
    return path.read_bytes()
