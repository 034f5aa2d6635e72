"""Losses, by part, and slip under settings of mesh and time steps, on random drives of two and three pulleys.

Each run over time is right against steady running on a mesh refined to a fifth of the usual error, or says by how much
it is not.  `theory/test_smoothed_friction.py` has the same for the slope of the friction law.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
import pytest

from beltdyn import Drive, simulate, steady_state, summarize
from beltdyn.results import Summary
from tests.lumped.drawn_drives import drawn_drive
from tests.verification.theory.test_smoothed_friction import drive_of

FINEST = 2e-3
"""Error of contact forces of the reference."""
LOSS_UNSAID, SLIP_UNSAID = 0.015, 0.025
"""Largest errors without a word: 1 and 2 %, and the error of the steady running that a run compares itself with."""
SURE = 2.0
"""Largest factor between the error that is said and the true one."""
TURNS = 2.5
LOAD = 0.5
"""Of what the drive transmits."""
SETTINGS: Mapping[str, Mapping[str, Any]] = {
    "chosen": {},
    "rtol 1e-2": {"rtol": 1e-2},
    "uniform": {"mesh": "uniform"},
    "uniform, rtol 1e-2": {"mesh": "uniform", "rtol": 1e-2},
    "travelling": {"frame": "travelling"},
    "travelling, rtol 1e-2": {"frame": "travelling", "rtol": 1e-2},
    "travelling, equal": {"frame": "travelling", "elements": 80},
}
QUICK = {("drawn 0", "rtol 1e-2"), ("drawn 17", "uniform"), ("drawn 17", "rtol 1e-2"), ("drawn 9", "uniform")}
DRAWN = (0, 1, 8, 9, 16, 17, 24, 25, 32, 33, 40, 41)
"""Seeds of drives of two and three pulleys."""
RIBBED = range(6)


def drive_named(name: str) -> Drive:
    kind, seed = name.split()
    return drawn_drive(int(seed)).under(LOAD) if kind == "drawn" else drive_of(int(seed))


def cases() -> Iterator[Any]:
    for name in (*(f"drawn {seed}" for seed in DRAWN), *(f"ribbed {seed}" for seed in RIBBED)):
        for setting in SETTINGS:
            marks = () if (name, setting) in QUICK else pytest.mark.slow
            yield pytest.param(name, setting, marks=marks, id=f"{name}, {setting}")


def running(drive: Drive, settings: Mapping[str, Any]) -> Drive:
    """The drive over some turns of the belt, from steady running."""
    driver = drive.reference
    speed = drive.pulleys[driver].speed
    assert speed is not None
    turn = drive.belt_length / float(abs(speed.at([0.0])[0]) * drive.rolling_radii[driver])
    settings = dict(settings)
    elements = settings.pop("elements", 80 if settings.get("mesh") else None)
    settings |= {"duration": TURNS * turn, "output_interval": turn / 200.0, "start": "steady"}
    belt = drive.belt.replace(elements=elements) if elements else drive.belt
    return drive.replace(belt=belt, simulation=drive.simulation.replace(**settings))


def errors(found: Summary, right: Summary) -> dict[str, float]:
    """Of the losses, as a whole and by part over the whole, and of the slips over the largest."""
    lost = right.balance.lost
    parts = {cause: (power - right.balance.losses[cause]) / lost for cause, power in found.balance.losses.items()}
    slips = np.array([[one.slip for one in summary.pulleys] for summary in (found, right)])
    off = slips[0] - slips[1]
    return {
        "losses": found.balance.lost / lost - 1.0,
        **parts,
        "slip": float(off[np.argmax(np.abs(off))] / np.abs(slips[1]).max()),
    }


def said(found: Summary) -> dict[str, float]:
    """The errors that a run tells of itself."""
    words = " ".join(one for one in found.warnings if one.startswith("compared with steady running"))
    patterns = {"losses": r"losses are off by (\S+)%", "slip": r"by (\S+)% of the largest"}
    numbers = {name: re.search(pattern, words) for name, pattern in patterns.items()}
    parts = re.search(r"\((.*) of the losses\)", words)
    found_parts = (part.rsplit(" ", 1) for part in (parts[1].split(", ") if parts else ()))
    return {name: float(match[1]) / 100.0 for name, match in numbers.items() if match} | {
        cause: float(number.rstrip("%")) / 100.0 for cause, number in found_parts
    }


@pytest.mark.parametrize(("name", "setting"), list(cases()))
def test_a_setting_is_right_or_says_by_how_much_it_errs(name: str, setting: str, measured: Callable[..., None]) -> None:
    drive = drive_named(name)
    right = summarize(steady_state(drive, force_tolerance=FINEST))
    found = summarize(simulate(running(drive, SETTINGS[setting])))
    true, told = errors(found, right), said(found)
    measured(**{key.replace(" ", "_"): value for key, value in true.items()}, said=len(told))
    for quantity, error in true.items():
        unsaid = SLIP_UNSAID if quantity == "slip" else LOSS_UNSAID
        if abs(error) > unsaid:
            assert quantity in told
        if quantity in told and abs(told[quantity]) > unsaid:
            assert 1.0 / SURE < told[quantity] / error < SURE
    if setting == "chosen":
        assert not told
