"""The drive of the paper, which the unit tests bend into every shape."""

from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import settings

from beltdyn.model import Drive, loads

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
