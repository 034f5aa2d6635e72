"""A drive checked in Python: at rest, with its warnings, and where there is no equilibrium."""

import pytest

import beltdyn as bd
import beltdyn.show.check as check_module
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, install


def test_a_drive_is_checked_at_rest() -> None:
    drive = bd.example("alternator_drive")
    checked = bd.check(drive)
    assert checked.failure is None
    assert checked.installation.tension == pytest.approx(300.0, rel=1e-4)  # as specified, of the equilibrium
    assert checked.drive.belt.length == checked.drive.belt_length
    text = str(checked)
    for words in ("300 N as specified, set by tensioners", "Pulleys at rest", "crank", "Tensioners at rest"):
        assert words in text
    table = text[text.index("Spans at rest") :].splitlines()[1:6]
    assert len({len(row) for row in table if row}) == 1  # columns are aligned
    assert "crank to tensioner" in checked._repr_html_()


def test_what_is_probably_not_meant_is_said(drive: Drive) -> None:
    thick = bd.check(drive.with_({"belt.elements": 12}))
    assert thick.warnings
    assert str(thick).count("warning: ") == len(thick.warnings)
    assert repr(thick).endswith(f"{len(thick.warnings)} warnings" if thick.warnings[1:] else "1 warning")


def test_estimates_are_left_where_there_is_no_equilibrium(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ConvergenceError("no static equilibrium found with 10 elements")

    monkeypatch.setattr(check_module, "bring_to_rest", fail)
    checked = bd.check(drive)
    assert str(checked.failure).startswith("no static equilibrium")
    assert checked.installation.tension == install(drive).tension
    assert "N at rest (estimated)" in repr(checked)
