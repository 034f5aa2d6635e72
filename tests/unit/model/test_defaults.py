"""Numbers of computation that a drive chooses: what they are for, they keep."""

from typing import Any

import numpy as np
import pytest

from beltdyn import example
from beltdyn.model import (
    Belt,
    Contact,
    Drive,
    advise,
    dumps,
    elements_needed,
    install,
    loads,
    mesh_errors,
    prepare,
    unresolved,
)
from beltdyn.model.defaults import critical_damping
from beltdyn.model.resolution import Running

MOTOR = {"name": "motor", "center": (0.0, 0.0), "radius": 0.05, "speed": {"kind": "constant", "value": 100.0}}
FAN: dict[str, Any] = {"name": "fan", "center": (0.5, 0.0), "radius": 0.1, "inertia": 0.01}
FAN["load"] = [{"kind": "resistance", "constant": 5.0}]
BELT = {
    "width": 0.02,
    "thickness": 4e-3,
    "axial_stiffness": 2e5,
    "bending_stiffness": 1e-2,
    "mass_per_length": 0.1,
    "installed_tension": 400.0,
}
RUN = {"duration": 1.0, "output_interval": 1e-3}


SETTLED = {"friction": 0.4, "stiffness": 1e8, "damping": 7.0, "creep_ratio": 1e-3, "standstill_creep": 1e-6}


def drive(belt: dict[str, Any] | None = None, **parts: Any) -> Drive:
    given: dict[str, Any] = {
        "belt": BELT | (belt or {}),
        "pulley": [MOTOR, FAN],
        "contact": {"friction": 0.4},
        "simulation": RUN,
    }
    return Drive(**given | parts)


def test_nothing_but_friction_is_needed() -> None:
    assert drive(contact=Contact(friction=0.4)) == drive()
    belt = Belt(**BELT, friction=0.4)
    own = Drive(belt=belt, pulley=[MOTOR, FAN], simulation=RUN)
    assert own.completed.contact.replace(friction=0.4) == drive().completed.contact
    assert own.contact == Contact()
    assert loads(dumps(own)) == own


def test_what_is_given_is_not_chosen() -> None:
    given = drive({"elements": 50}, contact=SETTLED)
    assert given.completed.choices == ()
    assert (given.elements, given.contact_stiffness, given.contact_damping) == (50, 1e8, 7.0)
    assert given.friction_parameters.saturation(1.0, 0.4, 10.0) == pytest.approx(1e-2, rel=1e-5)
    some = drive({"elements": 50}, contact={"friction": 0.4, "stiffness": 1e8})
    assert [choice.key for choice in some.completed.choices] == [
        "contact.damping",
        "contact.creep_ratio",
        "contact.standstill_creep",
    ]


def test_every_choice_has_its_reason() -> None:
    chosen = {choice.key: choice for choice in drive().completed.choices}
    of_friction = ["contact.creep_ratio", "contact.standstill_creep"]
    assert list(chosen) == ["contact.stiffness", "contact.damping", *of_friction, "belt.elements"]
    assert all(choice.reason for choice in chosen.values())
    assert chosen["contact.stiffness"].value == drive().contact_stiffness
    assert chosen["belt.elements"].value == drive().elements


@pytest.mark.parametrize("thickness", [4e-3, 1e-4])
@pytest.mark.parametrize("load", [4.0, 400.0, 1000.0])
def test_penetration_takes_little(load: float, thickness: float) -> None:
    """At most 0.5 % of the tension, 0.1 % of the smallest radius and 2 % of the thickness; one of them is reached."""
    given = drive({"installed_tension": load, "thickness": thickness})
    here = install(given)
    lost = 1.0 - here.tension / here.laid_tension
    deepest = float(here.penetrations.max())
    shares = np.array([lost / 0.005, deepest / (0.001 * 0.05), deepest / (0.02 * thickness)])
    assert shares.max() == pytest.approx(1.0, rel=0.03)  # stretch, here up to 0.5 %, is left out


def test_a_belt_of_given_length_sinks_in_as_little() -> None:
    """The tension on hard pulleys follows from the length, and 0.5 % of it is lost."""
    long = drive()
    given = drive({"installed_tension": None, "length": long.belt_length})
    here = install(given)
    assert here.tension == pytest.approx(0.995 * here.laid_tension, rel=1e-3)
    laid = given.belt.stretch_parameters.tension(given.path.length / long.belt_length)
    assert here.laid_tension == pytest.approx(float(laid), rel=1e-9)


def test_the_belts_own_compressibility_counts_where_it_is_hard() -> None:
    assert drive({"contact_stiffness": 3e11}).contact_stiffness == 3e11
    assert drive({"contact_stiffness": 3e7}).contact_stiffness == drive().contact_stiffness > 3e7


def test_damping_is_a_share_of_critical() -> None:
    """A mass m on a spring k_p and a damper 2 sqrt(k_p m) has a double root: it does not swing."""
    given = drive()
    damping, mass = critical_damping(given.contact_stiffness, 0.1), 0.1
    roots = np.roots([mass, damping, given.contact_stiffness])
    assert roots[0] == pytest.approx(roots[1], rel=1e-6)
    assert prepare(given).critical_damping == damping
    assert 0.0 < given.contact_damping < damping


def test_creep_lengths_fill_the_smallest_gripping_arc() -> None:
    """T mu / (s E A) e-folds a radian, 16 of them on the arc of the motor; an idler without load does not count."""
    given = drive()
    (choice,) = (one for one in given.completed.choices if one.key == "contact.creep_ratio")
    folds = 0.4 * 400.0 / (choice.value * 2e5)
    assert folds * given.path.wrap_angles[0] == pytest.approx(16.0)
    idler = {"name": "idler", "center": (0.25, -0.08), "radius": 0.02, "inertia": 1e-4, "side": "outside"}
    with_idler = drive(pulley=[MOTOR, idler, FAN])
    ratios = [one.completed.contact.given("creep_ratio") for one in (given, with_idler)]
    wraps = [one.path.wrap_angles[[0, -1]].min() for one in (given, with_idler)]
    assert ratios[0] / ratios[1] == pytest.approx(wraps[0] / wraps[1])


def test_the_mesh_resolves_tension_and_slip() -> None:
    given = drive(simulation=RUN | {"frame": "travelling"})
    errors = mesh_errors(given, Running(400.0), given.elements)
    coarser = mesh_errors(given, Running(400.0), given.elements - 1)
    assert errors["tension"] <= 0.005
    assert errors["slip"] <= 0.015
    assert coarser["tension"] > 0.005 or coarser["slip"] > 0.015


def test_the_mesh_of_a_belt_with_teeth_follows_the_tension_alone() -> None:
    """Teeth hold it, so that it does not slip; a quintic follows the small radii of toothed pulleys."""
    given = example("timing_drive").with_({"belt.toothing.law": "discrete"})
    running = Running(prepare(given).installation.tension)
    errors, needed = mesh_errors(given, running, given.elements), elements_needed(given, running)
    assert given.element_kind.name == "quintic"
    assert given.elements % 113 == 0
    assert errors["tension"] <= 0.005 < mesh_errors(given, running, given.elements - 113)["tension"]
    assert np.isnan([errors["slip"], errors["losses"]]).all()
    assert unresolved(errors, needed, pressures=False) == []


def test_it_is_told_which_mesh_resolves_pressures() -> None:
    run = RUN | {"frame": "travelling", "start": "steady"}
    given = drive(simulation=run)
    (reason,) = (choice.reason for choice in given.completed.choices if choice.key == "belt.elements")
    finer = int(reason.rpartition("contact pressures need ")[2])
    assert finer > given.elements
    assert advise(given, install(given)) == []
    (finding,) = advise(drive({"elements": given.elements}, simulation=run), install(given))
    assert f"Set belt.elements = {finer} for all of these" in str(finding)
    assert advise(drive({"elements": finer}, simulation=run), install(given)) == []


def test_a_settled_drive_keeps_what_was_chosen() -> None:
    """Its length changes a little, and the numbers of computation stay."""
    given = drive()
    settled = prepare(given).tightened(1e-6).drive
    assert settled.completed.choices == ()
    assert settled.completed.contact == given.completed.contact
    assert settled.elements == given.elements


def test_a_belt_that_does_not_slide_has_numbers_too() -> None:
    """Without friction nothing grips, and any creep ratio will do."""
    assert drive(contact={"friction": 0.0}).friction_parameters.saturation(1.0, 0.0, 1.0) > 0.0


def test_friction_is_as_steep_as_at_a_twentieth_of_the_speed_where_nothing_turns() -> None:
    """The motor turns at 100 rad/s; without a motor a belt moves by its own strain, at the speed of axial waves."""
    contact = drive().completed.contact
    assert contact.standstill_creep == pytest.approx(0.05 * contact.creep_ratio * 100.0 * drive().radii[0])
    still = drive(pulley=[{key: MOTOR[key] for key in ("name", "center", "radius")} | {"inertia": 1e-3}, FAN])
    contact, strain = still.completed.contact, install(still).strain
    wave = (2e5 / 0.1) ** 0.5
    assert contact.standstill_creep == pytest.approx(0.05 * contact.creep_ratio * strain * wave, rel=1e-2)


def test_friction_is_less_steep_where_the_belt_slides_over_a_guide() -> None:
    """A belt that breaks away on a whole arc at once needs it; the guide drives nothing, wherever it is listed."""
    guide = {"name": "guide", "center": (0.5, 0.0), "radius": 0.1, "speed": 0.0}
    given = drive(pulley=[guide, MOTOR])
    contact = given.completed.contact
    assert (given.driver, given.guides.tolist()) == (1, [True, False])
    assert contact.standstill_creep == pytest.approx(0.5 * contact.creep_ratio * 100.0 * given.radii[1])
    assert not drive(pulley=[guide | {"center": (0.0, 0.0)}, FAN]).guides.any()
