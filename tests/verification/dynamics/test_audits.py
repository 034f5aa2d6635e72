"""Audits of real runs: each speaks of a drive that violates it, and its remedy silences it.

The drive of the paper under a load of 2 N m, at 12 rad/s, with 40 elements.
"""

from importlib.resources import files
from typing import Any

import pytest

from beltdyn import simulate
from beltdyn.model import Drive, loads
from beltdyn.results import Run, summarize


def loaded(torque: float = -2.0, **contact: Any) -> Drive:
    """The drive with a load from 0.6 s on, for three turns of the belt."""
    drive = loads(files("beltdyn").joinpath("examples", "two_pulley.toml").read_text(encoding="utf-8"))
    driver, driven = drive.pulleys
    ramp = {"kind": "cosine_ramp", "start": 0.6, "end": 1.2, "value": torque}
    return drive.replace(
        pulley=[driver, driven.replace(torque=ramp)],
        belt=drive.belt.replace(elements=40),
        contact=drive.contact.arguments | contact,
        simulation=drive.simulation.replace(duration=4.0, output_interval=2e-3),
    )


def remedy(run: Run, words: str) -> float:
    """The number that the remedy of the only finding with these words names."""
    (finding,) = (one for one in run.findings if words in one.fault)
    return float(finding.remedy.split(" to ")[1].split()[0])


@pytest.mark.slow
@pytest.mark.parametrize("slope", [1e3, 1e4])
def test_slope_of_the_friction_law(slope: float) -> None:
    """Slip of 20 % at 1e3 kg/(m s); with the law chosen without its keys, friction adds little to creep."""
    soft = simulate(loaded(creep_rate_factor=slope))
    (finding,) = (one for one in soft.findings if "friction builds up too slowly" in one.fault)
    assert "omit contact.friction_law and contact.creep_rate_factor" in finding.remedy
    steep = simulate(loaded(friction_law="relative_creep", creep_rate_factor=None))
    assert not [warning for warning in steep.warnings if "friction builds up too slowly" in warning]
    before, after = summarize(soft).pulleys[1], summarize(steep).pulleys[1]
    assert before.regularization > 5.0 * before.elastic_creep
    assert after.regularization < 0.25 * after.elastic_creep


@pytest.mark.slow
def test_contact_damping_that_takes_power() -> None:
    """Under a tenth of the load, of which damping of a hundred times the critical one takes 3 %."""
    damped = simulate(loaded(torque=-0.2, damping=1e5))
    free = simulate(loaded(torque=-0.2, damping=remedy(damped, "contact damping dissipates")))
    assert not [warning for warning in free.warnings if "contact damping dissipates" in warning]
    assert summarize(free).balance.losses["contact damping"] < 2e-3 * summarize(free).balance.power_in


@pytest.mark.slow
def test_load_of_the_wrong_sign() -> None:
    """Of a load of the right sign nothing is said but what the published mesh and contact damping do."""
    (finding,) = (one for one in simulate(loaded(torque=2.0)).findings if "a load drives" in one.fault)
    assert "the sign of its speed: driven, 2 N m at 114.9 rpm, 24" in finding.fault
    sound = simulate(loaded(friction_law="relative_creep", creep_rate_factor=None))
    assert {one.kind for one in sound.findings} <= {"flutter", "unresolved_by_mesh", "off_steady_running"}
