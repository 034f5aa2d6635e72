"""A drive checked in Python: at rest, with its warnings, and where there is no equilibrium."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
import beltdyn.show.rest_sheet as check_module
from beltdyn.errors import ConvergenceError
from beltdyn.kernel import compiles_quickly, holds_kernels
from beltdyn.model import Drive


def test_a_drive_is_checked_at_rest() -> None:
    drive = bd.example("alternator_drive")
    checked = bd.check(drive, equilibrium=True)
    assert checked.failure is None
    assert checked.computed
    assert checked.installation.tension == pytest.approx(300.0, rel=1e-4)  # as specified, of the equilibrium
    assert checked.drive.belt.length == checked.drive.belt_length
    text = str(checked)
    for words in ("300 N as specified, set by tensioners", "Pulleys at rest", "crank", "Tensioners at rest"):
        assert words in text
    table = text[text.index("Spans at rest") :].splitlines()[1:6]
    assert len({len(row) for row in table if row}) == 1  # columns are aligned
    assert "crank to tensioner" in checked._repr_html_()


def test_guides_that_stand_still_have_no_sense_and_no_speed_ratio() -> None:
    handrail = bd.load(Path(__file__).parents[3] / "docs" / "tasks" / "handrail.toml")
    lines = str(bd.check(handrail, equilibrium=False)).splitlines()
    rows = [line.split() for line in lines if line.startswith(("drive ", "lower newel ")) and "°" in line]
    assert [(row[-8], row[-7], row[-4]) for row in rows] == [("prescribed", "ccw", "1.0000"), ("stands", "–", "–")]


def test_what_is_probably_not_meant_is_said(drive: Drive) -> None:
    thick = bd.check(drive.with_({"belt.elements": 12}))
    assert thick.warnings
    assert str(thick).count("warning: ") == len(thick.warnings)
    assert repr(thick).endswith(f"{len(thick.warnings)} warnings" if thick.warnings[1:] else "1 warning")


def test_estimates_are_left_where_there_is_no_equilibrium(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ConvergenceError("no static equilibrium found with 10 elements")

    monkeypatch.setattr(check_module, "bring_to_rest", fail)
    checked = bd.check(drive, equilibrium=True)
    assert str(checked.failure).startswith("no static equilibrium")
    assert checked.installation.tension == bd.check(drive, equilibrium=False).installation.tension
    assert "N at rest (closed form)" in repr(checked)


COLD = """
import sys
import beltdyn as bd
from beltdyn.kernel import watch_compilation

told = []
with watch_compilation(lambda done, total: told.append(total)):
    checked = bd.check(bd.example("accessory_drive"))
print(len(told), checked.computed, "numba" in sys.modules)
"""


def test_nothing_is_compiled_with_an_empty_cache(tmp_path: Path) -> None:
    process = subprocess.run(
        [sys.executable, "-c", COLD],
        env={**os.environ, "BELTDYN_CACHE_DIR": str(tmp_path)},
        check=True,
        capture_output=True,
        text=True,
    )
    assert process.stdout.split() == ["0", "False", "False"]
    assert not holds_kernels(tmp_path)


def test_equilibrium_is_computed_where_its_kernels_are_compiled(drive: Drive) -> None:
    bd.check(drive, equilibrium=True)
    assert bd.check(drive).computed or not compiles_quickly()
    said = str(bd.check(drive, equilibrium=False))
    assert "closed form, within 1 %" in said
    assert "computed" in str(bd.check(drive, equilibrium=True))


def test_a_search_that_takes_too_long_leaves_closed_forms_and_says_so(
    drive: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(check_module, "is_compiled", lambda _: True)
    monkeypatch.setattr(check_module, "_LONGEST_SEARCH", 0.0)
    checked = bd.check(drive)
    assert (checked.computed, checked.failure) == (False, None)
    assert checked.warnings[0].startswith("no static equilibrium is known: the search was ended after 0 s")
    assert checked.installation.tension == bd.check(drive, equilibrium=False).installation.tension
    assert bd.check(drive, equilibrium=True).computed  # that was asked for


def test_closed_forms_that_do_not_hold_are_named(drive: Drive) -> None:
    checked = bd.check(drive.with_({"belt.thickness": 0.3}), equilibrium=False)
    assert "closed forms with bending stiffness and weight do not hold" in str(checked)
    assert "without bending stiffness and weight" in str(checked.sheet)
    assert "do not hold" not in str(bd.check(drive, equilibrium=False))


@pytest.mark.parametrize("name", ["alternator_drive", "washing_machine", "package_conveyor"])
def test_a_script_in_which_numpy_raises_is_no_obstacle(name: str) -> None:
    """Numbers that underflow, such as the instant after zero, are no errors."""
    with np.errstate(all="raise"):
        assert bd.check(bd.example(name), equilibrium=False).installation.tension > 0.0
