from collections.abc import Callable

import pytest

from beltdyn.model import Drive, install

MakeDrive = Callable[..., Drive]


def test_tension_law(make_drive: MakeDrive) -> None:
    """The belt of a given tension is as long as its path, shortened by the penetrations, at the stretch of its law."""
    drive = make_drive("flat", installed_tension=700.0, contact={"stiffness": 1e6})
    installation = install(drive)
    shortened = drive.path.length - drive.path.wrap_angles @ installation.penetrations
    assert drive.belt.stretch_parameters.tension(shortened / drive.belt_length) == pytest.approx(700.0, rel=1e-10)
