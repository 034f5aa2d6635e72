"""What a drive leaves open is found, and what is given stays as it is."""

import pickle
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Contact, Drive, Pulley, Simulation, dumps, install, loads, prepare

MakeDrive = Callable[..., Drive]
SLIDING = {"kind": "sliding", "pulley": "idler", "direction": (0, 1), "mass": 0.5, "preload": 300.0, "rate": 2e3}
ROTARY = {
    "kind": "rotary",
    "pulley": "tensioner",
    "pivot": (-0.17, 0.17),
    "inertia": 0.01,
    "preload": 30.0,
    "rate": 20.0,
}


@pytest.mark.parametrize("layout", ["open", "crossed", "flat", "serpentine"])
@pytest.mark.parametrize("contact", [{"stiffness": 1e7}, {"allowed_penetration": 1e-5}])
def test_length_for_a_tension(make_drive: MakeDrive, layout: str, contact: dict[str, float]) -> None:
    drive = make_drive(layout, contact=contact, installed_tension=350.0, pitch_offset=0.001, back_offset=0.002)
    assert (drive.belt.length, drive.belt.installed_tension) == (None, 350.0)
    assert install(drive).tension == pytest.approx(350.0, rel=1e-11)
    assert loads(dumps(drive)) == drive


def test_allowed_penetration_is_that_on_the_smallest_pulley(make_drive: MakeDrive) -> None:
    drive = make_drive("serpentine", contact={"allowed_penetration": 2e-5}, length=1.84)
    assert drive.contact.stiffness is None
    depths = install(drive).penetrations
    assert depths.max() == pytest.approx(2e-5, rel=1e-9)
    np.testing.assert_allclose(depths * drive.radii, 2e-5 * 0.03, rtol=1e-9)
    assert loads(dumps(drive)) == drive


@pytest.mark.parametrize(
    ("layout", "belt", "tensioner", "words"),
    [
        ("open", {"length": 1.8, "installed_tension": 400.0}, (), ("both given, with 0 fixed", 'kind = "fixed"')),
        ("open", {"installed_tension": 1e9}, (), ("installed_tension = 1e+09 N", "50%", "Reduce it")),
        (
            "flat",
            {"length": 3.9, "installed_tension": 400.0},
            [{"kind": "fixed", "pulley": "idler", "direction": (0, 1)}],
            ('no take-up of "idler"', "3.9 m", "Change belt.length"),
        ),
        (
            "serpentine",
            {"length": 3.0},
            [ROTARY],
            ("length = 3 m is longer", "as placed by the tensioners", "Shorten it, or increase the preload"),
        ),
        (
            "flat",
            {"length": 3.9},
            [SLIDING | {"rate": 0.0}],
            ("push the tensioners to where no belt can run", '"fan" to "motor"', "give stops"),
        ),
        ("flat", {"length": 2.5}, [SLIDING | {"preload": 1e-3, "rate": 0.0}], ("pushes the tensioner", "preload")),
        ("flat", {"length": 2.5}, [SLIDING | {"preload": -50.0, "rate": 0.0}], ("pushes the tensioner", "preload")),
        (
            "flat",
            {"length": None},
            [SLIDING | {"preload": 1e9}],
            ('preload = 1e+09 N of the tensioner of "idler" is a tension of', "50%", "Reduce it"),
        ),
        ("flat", {}, [SLIDING | {"pulley": "idle"}], ('pulley = "idle" is not the name', "motor, idler, fan")),
    ],
)
def test_what_cannot_come_to_rest(
    make_drive: MakeDrive, layout: str, belt: dict[str, float], tensioner: Any, words: tuple[str, ...]
) -> None:
    with pytest.raises(ModelError) as caught:
        make_drive(layout, tensioner=tensioner, **belt)
    for part in words:
        assert part in str(caught.value)


def test_penetration_that_takes_all_tension(make_drive: MakeDrive) -> None:
    with pytest.raises(ModelError, match="sinks into the pulleys and loses all tension"):
        make_drive("open", length=1.81, contact={"allowed_penetration": 5e-3})


TAKE_UP = {"kind": "fixed", "pulley": "idler", "direction": (3, 4)}
LENGTHS = st.sampled_from(
    [{"length": 2.58}, {"length": 2.57}, {"installed_tension": 300.0}, {"installed_tension": 200.0}]
)
TENSIONERS = st.sampled_from([(), (SLIDING,), (TAKE_UP | {"take_up": -2e-3},)])
BOTH = st.just(({"length": 2.57, "installed_tension": 500.0}, (TAKE_UP,)))
CONTACTS = st.sampled_from([{"stiffness": 1e8}, {"allowed_penetration": 1e-5}, {}])
SECTIONS = st.fixed_dictionaries(
    {},
    optional={
        "elements": st.integers(3, 200),
        "width": st.sampled_from([0.01, 0.03]),
        "youngs_modulus": st.sampled_from([2e8, 1e9]),
        "pitch_offset": st.sampled_from([0.0, 1e-3]),
    },
)


@st.composite
def arguments(draw: st.DrawFn) -> dict[str, Any]:
    """What a user may write of a drive with an idler."""
    length, tensioner = draw(st.tuples(LENGTHS, TENSIONERS) | BOTH)
    section = {"width": 0.02, "thickness": 0.005, "density": 1100.0, "youngs_modulus": 5e8, "poissons_ratio": 0.3}
    places = (((0.0, 0.0), 0.1, "inside"), ((0.25, -0.05), 0.04, "outside"), ((0.8, 0.0), 0.2, "inside"))
    return {
        "belt": section | {"bending_factor": 0.01} | length | draw(SECTIONS),
        "pulley": [
            {"name": name, "center": center, "radius": radius, "side": side, "inertia": 0.01}
            for name, (center, radius, side) in zip(("motor", "idler", "fan"), places, strict=True)
        ],
        "contact": {
            "friction": draw(st.sampled_from([0.2, 0.5])),
            "creep_rate_factor": 1e4,
            "friction_law": "force_slope",
        }
        | draw(CONTACTS),
        "tensioner": list(tensioner),
        "simulation": {"duration": 0.1, "output_interval": 1e-3},
    }


def what_follows(drive: Drive) -> list[Any]:
    """Everything that a drive finds from what is given."""
    return [drive.belt_length, drive.contact_stiffness, drive.centers.tolist(), drive.path.length]


@given(arguments(), arguments())
@settings(max_examples=25)
def test_a_copy_is_the_drive_that_is_written_so(one: dict[str, Any], other: dict[str, Any]) -> None:
    """Whatever was found for the drive that is copied does not stay with the copy."""
    drive, wanted = Drive(**one), Drive(**other)
    copy = drive.replace(**other)
    assert copy == wanted
    assert what_follows(copy) == what_follows(wanted)
    part_by_part = drive
    if ("length" in one["belt"], "installed_tension" in one["belt"]) != (True, True):
        part_by_part = drive.replace(
            belt=drive.belt.replace(**other["belt"]),
            contact=drive.contact.replace(**other["contact"]),
            tensioner=other["tensioner"],
        )
        same = {"bending_factor", "elements", "width", "youngs_modulus", "pitch_offset"} - other["belt"].keys()
        hard = {} if {"stiffness", "allowed_penetration"} & other["contact"].keys() else one["contact"]
        expected = Drive(
            **other
            | {"belt": other["belt"] | {key: getattr(drive.belt, key) for key in same}}
            | {"contact": hard | other["contact"]}
        )
        assert part_by_part == expected
        assert what_follows(part_by_part) == what_follows(expected)


@pytest.mark.slow
@given(arguments())
@settings(max_examples=25)
def test_what_follows_depends_on_what_is_given_alone(written: dict[str, Any]) -> None:
    drive = Drive(**written)
    for same in (loads(dumps(drive)), loads(drive.text), pickle.loads(pickle.dumps(drive)), drive.replace()):
        assert same == drive
        assert what_follows(same) == what_follows(drive)
    assert tomllib.loads(dumps(drive))["belt"].keys() >= written["belt"].keys()
    left_open = {"length", "installed_tension"} - written["belt"].keys()
    assert left_open.isdisjoint(tomllib.loads(dumps(drive))["belt"])
    assert {"stiffness", "allowed_penetration"} & tomllib.loads(dumps(drive))["contact"].keys() == {
        *({"stiffness", "allowed_penetration"} & written["contact"].keys())
    }


@given(arguments())
@settings(max_examples=15)
def test_parts_stay_as_they_are_given(written: dict[str, Any]) -> None:
    belt, contact = Belt(**written["belt"]), Contact(**written["contact"])
    pulleys = [Pulley(**pulley) for pulley in written["pulley"]]
    before = [part.arguments for part in (belt, contact, *pulleys)]
    drive = Drive(
        belt=belt, pulley=pulleys, contact=contact, tensioner=written["tensioner"],
        simulation=Simulation(**written["simulation"]),
    )  # fmt: skip
    install(drive)
    assert [part.arguments for part in (drive.belt, drive.contact, *drive.pulleys)] == before


def test_another_tension_asks_for_another_stiffness(make_drive: MakeDrive) -> None:
    """The largest T g / (R d) of all pulleys: it belongs to the penetration, and not to the drive that was copied."""
    drive = make_drive("flat", contact={"allowed_penetration": 1e-5}, installed_tension=200.0)
    tighter = drive.replace(belt=drive.belt.replace(installed_tension=400.0))
    for tension, one in ((200.0, drive), (400.0, tighter)):
        expected = tension * float(one.belt.stretch_parameters.stretch(tension)) / (0.04 * 1e-5)
        assert one.contact_stiffness == pytest.approx(expected, rel=1e-12)
        assert install(one).penetrations.max() == pytest.approx(1e-5, rel=1e-9)


@pytest.mark.parametrize("tensioner", [(), (TAKE_UP | {"take_up": 1e-3},)])
def test_a_tightened_drive_has_nothing_open(make_drive: MakeDrive, tensioner: tuple[dict[str, Any], ...]) -> None:
    """A belt that is shortened keeps the stiffness that belongs to its tension."""
    contact = {"allowed_penetration": 1e-5}
    drive = make_drive("flat", contact=contact, tensioner=tensioner, installed_tension=200.0)
    tightened = prepare(drive).tightened(1e-4).drive
    assert (tightened.belt.length, tightened.belt.installed_tension) == (drive.belt_length - 1e-4, None)
    assert (tightened.contact.stiffness, tightened.contact.allowed_penetration) == (drive.contact_stiffness, None)
    assert tightened.tensioners == drive.tensioners


def test_a_tightened_belt_of_given_length_takes_up_more(make_drive: MakeDrive) -> None:
    drive = make_drive("flat", tensioner=[TAKE_UP], length=2.57, installed_tension=500.0)
    tightened = prepare(drive).tightened(1e-5).drive
    assert (tightened.belt.length, tightened.belt.installed_tension) == (2.57, None)
    assert tightened.path.length - drive.path.length == pytest.approx(1e-5, rel=1e-3)  # small against the curvature
    assert tightened.pulleys == drive.pulleys
    assert loads(dumps(tightened)) == tightened


def test_what_is_open_has_no_value_before_the_drive(make_drive: MakeDrive) -> None:
    drive = make_drive("flat", contact={"allowed_penetration": 1e-5}, installed_tension=200.0)
    with pytest.raises(ModelError, match=r"belt\.length is open; .* Use drive\.belt_length"):
        _ = drive.belt.given_length
    with pytest.raises(ModelError, match=r"contact\.stiffness is open; .* Use prepare\(drive\)\.contact"):
        _ = drive.contact.given("stiffness")


def test_a_penetration_that_no_stiffness_keeps_to(make_drive: MakeDrive) -> None:
    with pytest.raises(
        ModelError, match=r"allowed_penetration = 1e-13 m needs an invalid contact stiffness.* too large.* Increase it"
    ):
        make_drive("open", contact={"allowed_penetration": 1e-13})
