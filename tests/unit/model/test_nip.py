"""Nips: where their rollers are, what they press on, and what is refused."""

from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model.nip import damping_ratios, foundations, on_slides, rim_ratios, side_stiffness
from beltdyn.model.plausibility import judge_plausibility
from beltdyn.points.quasi_steady import QuasiSteady
from beltdyn.theory.nip import equivalent_radius, force, half_width, rolling_loss, series

COVER = {"thickness": "10 mm", "youngs_modulus": "4 MPa", "poissons_ratio": 0.45}
DRUM = {"name": "drum", "center": [0.0, 0.0], "radius": 0.15, "speed": 6.6}
TAIL = {"name": "tail", "center": [1.2, 0.0], "radius": 0.1, "inertia": 0.2, "torque": -30.0}
PRESS = {"name": "press", "center": [-0.3, 0.0], "radius": 0.08, "side": "outside", "inertia": 0.05, "cover": COVER}
NIP = {"roller": "press", "pulley": "drum", "force": "2 kN"}
SLIDE = {"kind": "sliding", "pulley": "press", "direction": [1, 0], "preload": "2 kN", "rate": 1e5, "mass": 3.0}
ARM = {"kind": "rotary", "pulley": "press", "pivot": [-0.3, 0.25], "preload": 500.0, "inertia": 0.1}
OWN = {"roller": "press", "pulley": "drum"}


def pressed(**changes: Any) -> bd.Drive:
    """A belt on a driven drum, on which a covered roller presses it."""
    return bd.Drive(
        **{
            "belt": {
                "width": 0.2,
                "thickness": 3e-3,
                "pitch_offset": 1.5e-3,
                "back_offset": 1.5e-3,
                "axial_stiffness": 4e5,
                "bending_stiffness": 0.02,
                "mass_per_length": 0.7,
                "contact_stiffness": 4e9,
                "installed_tension": 1000.0,
            },
            "pulley": [DRUM, TAIL, PRESS],
            "nip": [NIP],
            "contact": {"friction": 0.4},
            "simulation": {"duration": 1.0},
        }
        | changes
    )


def test_a_roller_presses_with_its_force_by_the_closed_form() -> None:
    prepared = bd.model.prepare(pressed())
    sides = [side_stiffness(one, prepared.belt, prepared.contact_stiffness) for one in prepared.pulleys]
    assert sides[2] == pytest.approx(series(4e6 * 0.55 / (1.45 * 0.1) / 10e-3 * 0.2, 4e9))
    (depth,), radius = prepared.path.indentations.tolist(), equivalent_radius(0.0815, 0.1515)
    assert force(depth, series(sides[0], sides[2]), radius) == pytest.approx(2000.0, rel=1e-9)
    np.testing.assert_allclose(prepared.pulleys[2].center, [-(0.08 + 0.15 + 3e-3 - depth), 0.0], atol=1e-12)


def test_a_gap_is_that_of_the_undeformed_rollers() -> None:
    prepared = bd.model.prepare(pressed(nip=[{"roller": "press", "pulley": "drum", "gap": "2.4 mm"}]))
    np.testing.assert_allclose(prepared.path.indentations, [0.6e-3])
    np.testing.assert_allclose(prepared.pulleys[2].center, [-(0.08 + 0.15 + 2.4e-3), 0.0])


def test_without_force_and_gap_the_roller_stays_where_it_is() -> None:
    pulleys = [DRUM, TAIL, PRESS | {"center": [-0.1395, 0.186]}]
    prepared = bd.model.prepare(pressed(pulley=pulleys, nip=[{"roller": "press", "pulley": "drum"}]))
    np.testing.assert_allclose(prepared.path.indentations, [0.5e-3], rtol=1e-9)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_the_path_is_that_without_the_roller(place: int) -> None:
    """Wherever the roller stands in the list: it has no spans, and is on none."""
    pulleys, alone = [DRUM, TAIL], pressed(pulley=[DRUM, TAIL], nip=[])
    pulleys.insert(place, PRESS)
    with_roller, on = pressed(pulley=pulleys), [number for number in range(3) if number != place]
    path = with_roller.path
    assert path.length == alone.path.length
    assert with_roller.spans == alone.spans == (("drum", "tail"), ("tail", "drum"))
    assert path.on.tolist() == on
    assert path.span_pulleys.tolist() == [on, on[::-1]]
    assert path.leaving[on].tolist() == [0, 1]
    assert path.reaching[on].tolist() == [1, 0]
    np.testing.assert_array_equal(path.wrap_angles[on], alone.path.wrap_angles)
    np.testing.assert_array_equal(path.span_lengths, alone.path.span_lengths)
    assert path.wrap_angles[place] == 0.0
    np.testing.assert_array_equal(path.gradient(place), [0.0, 0.0])
    along = np.linspace(0.0, alone.path.length, 50)
    np.testing.assert_allclose(path.position(along), alone.path.position(along), atol=1e-12)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_roller_may_stand_anywhere_in_the_list(place: int) -> None:
    pulleys = [DRUM, TAIL]
    pulleys.insert(place, PRESS)
    drive = pressed(pulley=pulleys)
    assert drive.path.length == pytest.approx(pressed().path.length, rel=1e-12)
    np.testing.assert_allclose(drive.path.nip_angles, pressed().path.nip_angles)
    along = np.linspace(0.0, drive.path.length, 50)
    distance = np.linalg.norm(drive.path.position(along)[:, None] - drive.centers[None], axis=-1)
    assert distance.min() > 0.08


def test_a_roller_rolls_on_the_face_of_a_bent_belt() -> None:
    """The outer face of a belt on a drum moves faster than its tension line, by o / r."""
    drive = pressed()
    ratios = rim_ratios(drive.path.nips, drive.pulleys, drive.radii)
    assert ratios.tolist() == [1.0, 1.0, pytest.approx(0.08 / 0.0815 / (1.0 + 1.5e-3 / 0.1515))]
    face = 6.6 * (0.1515 + 1.5e-3)
    assert 6.6 * 0.1515 / (ratios[2] * 0.0815) == pytest.approx(face / 0.08)


def test_dampers_lose_what_hysteresis_does() -> None:
    cover = COVER | {"loss_factor": 0.002}
    prepared = bd.model.prepare(pressed(pulley=[DRUM, TAIL, PRESS | {"cover": cover}]))
    found = damping_ratios(prepared.path, prepared.pulleys, prepared.belt, prepared.contact)
    assert found[:2].tolist() == [0.0, 1.0]
    side = side_stiffness(prepared.pulleys[2], prepared.belt, prepared.contact_stiffness)
    damping = found[2] * prepared.contact.given("damping") / prepared.contact_stiffness * side
    half, radius, speed = half_width(float(prepared.path.indentations[0]), 0.0530), 0.0530, 6.6 * 0.1515
    lost = damping * 2.0 * speed * half**3 / (3.0 * radius**2)
    depth = half**2 / (2.0 * radius)
    share = side / prepared.pulleys[2].cover.stiffness(0.2)  # type: ignore[union-attr]
    assert lost == pytest.approx(rolling_loss(0.002 * share, side, depth), rel=2e-3)


def test_only_covered_rollers_are_softer() -> None:
    drive = pressed()
    found = foundations(drive.pulleys, drive.belt, 4e9)
    assert found[:2].tolist() == [1.0, 1.0]
    assert found[2] == pytest.approx(1.0 / (1.0 + 4e9 * 10e-3 / (4e6 * 0.55 / (1.45 * 0.1) * 0.2)))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"nip": [NIP | {"gap": "2 mm"}]}, "force and gap exclude each other"),
        ({"nip": [NIP | {"pulley": "press"}]}, 'roller and pulley are both "press"'),
        ({"nip": [NIP | {"roller": "pres"}]}, r'nip\[1\].roller = "pres" is not the name of a pulley. Choose one of'),
        ({"nip": [NIP, NIP]}, "presses in 2 nips"),
        ({"pulley": [DRUM, TAIL, PRESS | {"side": "inside"}]}, 'both on the inside of the belt.*Set side = "outside"'),
        ({"nip": [{"roller": "press", "pulley": "drum", "gap": "3.5 mm"}]}, "does not press the belt of 0.003 m"),
        ({"nip": [{"roller": "press", "pulley": "drum", "gap": "-8 mm"}]}, "is too tight.*open the gap"),
        ({"nip": [NIP | {"force": "200 kN"}]}, "is too tight.*by a force of 2e.05 N"),
        ({"pulley": [DRUM, TAIL, PRESS | {"center": [0.3, 0.0]}]}, 'does not lie on "drum" where "press" presses'),
        ({"nip": [{"roller": "press", "pulley": "drum"}]}, 'does not reach the belt on "drum": it is 0.067 m away'),
        ({"pulley": [DRUM, TAIL, PRESS | {"center": [0.0, 0.0]}]}, 'has the center of "drum"'),
        ({"simulation": {"duration": 1.0, "frame": "travelling"}}, "needs a mesh that stays"),
        (
            {"pulley": [DRUM, TAIL, PRESS | {"cover": COVER | {"poissons_ratio": 0.5}}]},
            r"cover.poissons_ratio = 0.5 must be less than 0.5",
        ),
        ({"tensioner": [{"kind": "fixed", "pulley": "drum", "direction": [-1, 0]}]}, 'a tensioner carries "drum"'),
        ({"tensioner": [SLIDE]}, 'carries "press", whose preload presses it. Omit force'),
        ({"nip": [OWN], "tensioner": [SLIDE | {"direction": [-1, 0]}]}, 'does not press it against "drum"'),
        ({"nip": [OWN], "tensioner": [SLIDE | {"preload": -5.0}]}, "preload = -5, but it is to press"),
    ],
)
def test_it_says_what_is_wrong(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        pressed(**changes)


def test_a_run_over_time_needs_the_mass_of_a_roller_that_a_force_moves() -> None:
    with pytest.raises(ModelError, match=r"nip\[1\].force = 2000 N moves the roller.*no mass. Give mass"):
        bd.simulate(pressed())


@pytest.mark.parametrize("carrier", [SLIDE, ARM])
def test_what_carries_a_roller_presses_it_with_its_preload(carrier: dict[str, Any]) -> None:
    """A slide with 2 kN, and an arm of 0.25 m with 500 N m, put it where a force of 2 kN does."""
    carried = bd.model.prepare(pressed(nip=[OWN], tensioner=[carrier]))
    by_force = bd.model.prepare(pressed())
    np.testing.assert_allclose(carried.pulleys[2].center, by_force.pulleys[2].center, atol=1e-12)
    assert carried.installation.tensioner_positions.tolist() == [0.0]
    assert carried.installation.tension == pytest.approx(by_force.installation.tension)
    assert bd.model.tensioner_balances(carried.drive, carried.installation) == ((),)


def test_rollers_slide_under_their_forces_in_a_run() -> None:
    heavy = pressed(pulley=[DRUM, TAIL, PRESS | {"mass": 5.0}])
    nips, (slide,) = on_slides(heavy.nips, heavy.pulleys)
    assert nips[0].force is None
    assert (slide.pulley, slide.direction, slide.preload) == ("press", (1.0, 0.0), 2000.0)


def test_a_lasting_compression_is_that_of_steady_running() -> None:
    held = pressed(nip=[{"roller": "press", "pulley": "drum", "gap": "2.4 mm"}])
    lasting = held.replace(belt=held.belt.replace(compression_set=0.1))
    for analysis in (bd.simulate, bd.modes):
        with pytest.raises(ModelError, match=r"compression_set = 0.1 is that of a belt that runs steadily.*history"):
            analysis(lasting)


def test_speeds_that_differ_by_more_than_creep_are_told() -> None:
    """The face of the belt on the drum runs at 6.6 rad/s * 0.153 m; 12.62 rad/s of the roller match it."""
    driven = {key: value for key, value in PRESS.items() if key != "inertia"}

    def told(speed: float) -> list[str]:
        drive = pressed(pulley=[DRUM, TAIL, driven | {"speed": speed}])
        findings = map(str, judge_plausibility(drive, bd.model.install(drive)))
        return [one for one in findings if "slips as a whole" in one]

    assert told(-6.6 * 0.153 / 0.08) == []
    (finding,) = told(-12.5)
    assert "press is to run at 0.99021 m/s and that of drum at 0.9999 m/s" in finding
    assert "differ by 0.97%" in finding
    right = f"a speed of {-6.6 * 0.153 / 0.08 * 30.0 / np.pi:.5g} rpm"
    assert right in finding
    (backwards,) = told(6.6 * 0.153 / 0.08)
    assert "differ by 200.00%" in backwards
    assert right in backwards
    (held,) = told(0.0)
    assert right in held


def test_lumped_models_know_no_nips() -> None:
    with pytest.raises(ModelError, match="knows no nip"):
        QuasiSteady(bd.model.prepare(pressed()), bd.model.install(pressed()))
