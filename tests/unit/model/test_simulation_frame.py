"""Which mesh a run has, and what makes it travel."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.model.simulation import unused_settings

BELT = {
    "width": 0.01,
    "thickness": 0.004,
    "axial_stiffness": 1e5,
    "bending_stiffness": 0.01,
    "mass_per_length": 0.1,
    "installed_tension": 400.0,
}
PULLEYS = [
    {"name": "motor", "center": [0.0, 0.0], "radius": 0.04, "speed": {"kind": "constant", "value": 100.0}},
    {"name": "fan", "center": [0.3, 0.0], "radius": 0.06, "inertia": 0.01},
]
RUN = {"duration": 1.0, "output_interval": 1e-3}


def drive(**groups: Any) -> Drive:
    given: dict[str, Any] = {"belt": BELT, "pulley": PULLEYS, "contact": {"friction": 0.4}, "simulation": RUN}
    return Drive(
        **{key: given.get(key, {}) | value for key, value in groups.items()}
        | {key: value for key, value in given.items() if key not in groups}
    )


def test_the_mesh_stays_unless_asked_otherwise() -> None:
    given = drive()
    assert (given.frame.name, given.frame.reason, given.frame.words) == ("staying", "", "staying")
    assert given.element_kind.name == given.completed.belt.discretization == "quintic"
    assert drive(simulation={"frame": "travelling"}).frame == ("travelling", "as given")
    assert drive(simulation={"frame": "travelling"}).element_kind.name == "ancf"


@pytest.mark.parametrize(
    ("groups", "reason"),
    [
        ({"simulation": {"start": "laid"}}, 'simulation.start = "laid"'),
        ({"simulation": {"integrator": "cvode"}}, 'simulation.integrator = "cvode"'),
        ({"simulation": {"joint": "multipliers"}}, 'simulation.joint = "multipliers"'),
        ({"belt": {"discretization": "ancf"}}, 'belt.discretization = "ancf"'),
        ({"belt": {"discretization": "truss"}}, 'belt.discretization = "truss"'),
        ({"belt": {"integration": "reduced"}}, 'belt.integration = "reduced"'),
        ({"belt": {"quadrature_points": 3}}, "belt.quadrature_points = 3"),
        ({"contact": {"sampling": "nodal"}}, 'contact.sampling = "nodal"'),
        ({"contact": {"integration": "fixed"}}, 'contact.integration = "fixed"'),
        ({"contact": {"quadrature_points": 11}}, "contact.quadrature_points = 11"),
    ],
)
def test_what_only_the_other_mesh_has_makes_it_travel(groups: dict[str, Any], reason: str) -> None:
    """And it does so too once the length of the belt is found, and read from a file."""
    given = drive(**groups)
    for one in (given, prepare(given).tightened(0.0).drive, Drive(**given.data)):
        assert one.frame == ("travelling", f"since {reason}")
        assert one.element_kind.name == given.belt.discretization or one.element_kind.name == "ancf"


def test_a_belt_with_ends_has_a_mesh_that_travels() -> None:
    ended = {
        "belt": {key: value for key, value in BELT.items() if key != "installed_tension"} | {"length": 1.0},
        "pulley": [PULLEYS[0]],
        "contact": {"friction": 0.3},
        "end": [
            {"name": "anchor", "kind": "fixed", "point": [0.3, -0.3]},
            {"name": "weight", "kind": "weight", "mass": 10.0},
        ],
        "gravity": [0.0, -9.81],
    }
    assert Drive(**ended, simulation=RUN).frame == ("travelling", "since the belt is open")
    with pytest.raises(ModelError, match='"staying" is incompatible with an open belt'):
        Drive(**ended, simulation=RUN | {"frame": "staying"})


def test_a_mesh_that_stays_tells_what_it_does_not_use() -> None:
    asked = drive(
        belt={"quadrature_points": 3},
        contact={"integration": "fixed"},
        simulation={"frame": "staying"},
    )
    assert asked.frame.words == "staying, as given"
    assert asked.element_kind.name == "quintic"
    assert unused_settings(asked.belt, asked.contact) == [
        "belt.quadrature_points = 3",
        'contact.integration = "fixed"',
    ]
    asked = drive(belt={"discretization": "quintic"})
    assert unused_settings(asked.belt, asked.contact) == []


def test_a_tolerance_of_forces_needs_a_mesh_that_stays() -> None:
    assert drive(simulation={"force_tolerance": 0.01}).frame.stays
    with pytest.raises(ModelError) as caught:
        drive(simulation={"force_tolerance": 0.01, "start": "laid"})
    assert 'refined; the mesh of this drive travels, since simulation.start = "laid"' in str(caught.value)
