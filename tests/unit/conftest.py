"""The drive of the paper, which the unit tests bend into every shape."""

import signal
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import settings

from beltdyn.model import Drive, loads
from beltdyn.signals import ENDING

settings.register_profile("patient", deadline=None)  # loading units and kernels takes its time once
settings.load_profile("patient")


@pytest.fixture(scope="session")
def drive_text() -> str:
    return files("beltdyn").joinpath("examples", "two_pulley.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def drive(drive_text: str) -> Drive:
    return loads(drive_text)


@pytest.fixture
def drive_file(tmp_path: Path, drive_text: str) -> Path:
    file = tmp_path / "drive.toml"
    file.write_text(drive_text, encoding="utf-8")
    return file


@pytest.fixture
def signal_defaults() -> Iterator[None]:
    """The signals that a program gets in the foreground: a shell starts one in the background with some ignored."""
    before = {number: signal.getsignal(number) for number in ENDING}
    for number in ENDING:
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)
