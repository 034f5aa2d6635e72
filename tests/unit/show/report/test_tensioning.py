"""How a belt is tensioned: a string under its tension vibrates and deflects as a textbook has it."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, install
from beltdyn.show.report.tensioning import tensioning


def number(words: str) -> float:
    return float(words.partition(" ")[0])


def test_frequency_and_deflection_are_those_of_a_string(drive: Drive) -> None:
    """f = sqrt(T/m)/2L and F = 4 T d/L; bending stiffness raises the frequency by some per cent at most."""
    facts = dict(tensioning(drive))
    found = install(drive)
    tension, length = found.tension, float(found.path.span_lengths.max())
    assert number(facts["tension at rest"]) == pytest.approx(tension, rel=1e-3)
    string = np.sqrt(tension / drive.belt.mass_per_length) / (2.0 * length)
    assert string < 1.01 * number(facts["frequency meter"]) < 1.15 * string
    deflection = 1e-3 * number(facts["force and deflection"].rpartition(" by ")[2])
    assert number(facts["force and deflection"]) == pytest.approx(4.0 * tension * deflection / length, rel=0.01)


def test_the_tension_of_the_file_counts(drive: Drive) -> None:
    once, twice = (dict(tensioning(drive, tension)) for tension in (100.0, 400.0))
    assert twice["tension at rest"].startswith("400 N")
    assert number(twice["frequency meter"]) == pytest.approx(2.0 * number(once["frequency meter"]), rel=0.01)


def test_a_drive_without_an_estimate_at_rest_has_no_instruction(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(_: Drive) -> None:
        raise ModelError("no equilibrium")

    monkeypatch.setattr("beltdyn.show.report.tensioning.install", none)
    assert tensioning(drive) == []
