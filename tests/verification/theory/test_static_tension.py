"""Verified: the tension of a belt at rest on its pulleys, and how penetration lessens it.

Against: the closed form, and the boundary-value problem of running so slowly that friction and inertia vanish.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.state.installation import drawn_in
from beltdyn.state.static import find_equilibrium
from beltdyn.system.build import drive_system
from beltdyn.system.observe import observe
from beltdyn.system.state import laid
from beltdyn.theory.running_drive import RunningDrive, run_steadily
from beltdyn.theory.span import open_belt
from beltdyn.theory.static_tension import StaticTension, static_tension

Change = Callable[..., Drive]
MESHES = [20, 30, 40, 60, 80, 120, 240]


def simulated(drive: Drive) -> tuple[float, float]:
    """Mean tension of the spans, and tension of the rightmost element, on the arc of the driven pulley, N.

    The search begins with the belt as deep in its pulleys as it will be: on the rims rounding decides what touches.
    """
    system = drive_system(prepare(drive))
    state = find_equilibrium(system, laid(system, drawn_in(prepare(drive), 1.0))).state
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    x = state.nodes(system)[:, 0]
    return float(seen.span_tension.mean()), float(seen.belt_tension[0, np.argmax(x + np.roll(x, -1))])


def closed_form(numbers: RunningDrive) -> StaticTension:
    return static_tension(
        numbers.length,
        numbers.distance,
        numbers.radii,
        law=numbers.law,
        contact_stiffness=numbers.stiffness,
        bending_stiffness=numbers.bending,
    )


@pytest.fixture(scope="module")
def drives(table_1: Change, loaded: Change) -> dict[str, Callable[[int], Drive]]:
    return {
        "case 1": lambda elements: table_1(elements),
        "case 2": lambda elements: loaded(elements, 1e4),
        "unequal radii": lambda elements: table_1(elements, driven={"radius": 0.1218}),
    }


@pytest.mark.parametrize(
    ("case", "closure", "finest"),
    [
        ("case 1", 3e-3, 1e-4),  # layers of bending and of penetration overlap: both are of a few mm
        ("case 2", 1e-3, 1e-5),  # d / R = 0.026: its square
        ("unequal radii", 1e-3, None),
    ],
)
def test_tension_of_the_installed_belt(
    drives: dict[str, Callable[[int], Drive]],
    running: Callable[..., RunningDrive],
    measured: Callable[..., None],
    curve: Callable[..., None],
    case: str,
    closure: float,
    finest: float | None,
) -> None:
    numbers = running(drives[case](20), 1e-6, 0.0)
    closed, found = closed_form(numbers), np.array([simulated(drives[case](n)) for n in MESHES])
    spans, arcs = found.T
    rigid = float(numbers.law.tension(open_belt(numbers.distance, numbers.radii).length / numbers.length))
    exact = closed.tension if finest is None else float(run_steadily(numbers).tension[0])
    errors = spans / exact - 1.0
    measured(
        rigid=rigid,
        closed=closed.tension,
        exact=exact,
        finest=spans[-1],
        arc=closed.arc_tension[1],
        finest_arc=arcs[-1],
        closed_error=closed.tension / exact - 1.0,
        **{f"error_{n}": error for n, error in zip(MESHES, errors, strict=True)},
        arc_error=arcs[-1] / closed.arc_tension[1] - 1.0,
    )
    curve("static_tension", MESHES, np.abs(errors), case)
    assert closed.tension == pytest.approx(spans[-1], rel=closure)
    assert closed.arc_tension[1] == pytest.approx(arcs[-1], rel=closure)
    if finest is not None:
        assert spans[-1] == pytest.approx(exact, rel=finest)
        assert np.abs(errors[-1]) < 0.1 * np.abs(errors[0])


def test_penetration_takes_forty_per_cent_of_case_2(
    drives: dict[str, Callable[[int], Drive]], running: Callable[..., RunningDrive], measured: Callable[..., None]
) -> None:
    numbers = running(drives["case 2"](20), 0.0, 0.0)
    soft, hard = closed_form(numbers), closed_form(replace(numbers, stiffness=1e4 * numbers.stiffness))
    measured(soft=soft.tension, rigid=hard.tension, loss=1.0 - soft.tension / hard.tension, depth=soft.penetration[0])
    assert 1.0 - soft.tension / hard.tension == pytest.approx(0.4, abs=0.01)
    assert simulated(drives["case 2"](60))[0] == pytest.approx(soft.tension, rel=1e-3)
