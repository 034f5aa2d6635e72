"""The belt at rest: the tension that is asked for, an equilibrium on every pulley, stable balances of tensioners."""

import math
import pickle
from collections.abc import Callable
from importlib.resources import files
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, install, load, loads, prepare, tensioner_balances
from beltdyn.results import open_run
from beltdyn.solvers.run_progress import Progress
from beltdyn.state import installation
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.installation import bring_to_rest, follow
from beltdyn.state.static import Equilibrium, find_equilibrium, tensioner_compliance
from beltdyn.system.arrays import System
from beltdyn.system.state import State
from beltdyn.transient.simulate import simulate
from tests.unit.state.test_search import toothed

Circle = tuple[str, float, float, float, str]
FINE = 200
ASKED = 1e-3
"""Of the tension at rest: what is promised, relative."""

STIFFNESSES = {"width": 0.01, "thickness": 0.01, "axial_stiffness": 1e4, "mass_per_length": 0.1}
SERPENTINE: tuple[Circle, ...] = (
    ("crank", 0.0, 0.0, 0.08, "inside"),
    ("air", 0.22, -0.06, 0.06, "inside"),
    ("alternator", 0.26, 0.16, 0.03, "inside"),
    ("idler", 0.11, 0.16, 0.035, "outside"),
    ("steering", 0.08, 0.33, 0.06, "inside"),
    ("pump", -0.03, 0.17, 0.05, "outside"),
    ("tensioner", -0.17, 0.07, 0.035, "inside"),
)
CROSSED: tuple[Circle, ...] = (("driver", 0.0, 0.0, 0.12, "inside"), ("driven", 0.6, 0.0, 0.08, "outside"))
ARM = {"kind": "rotary", "pulley": "tensioner", "pivot": (-0.17, 0.17), "inertia": 1e-3, "mass": 2.0, "preload": 30.0}
SLIDE = {"kind": "sliding", "pulley": "tensioner", "direction": (-1.0, 0.2), "preload": 500.0, "mass": 1.0}
BACK = {"kind": "sliding", "pulley": "idler", "direction": (-1.0, 0.0), "preload": 400.0, "rate": 1e4, "mass": 1.0}
LAYOUT_BELT = {"width": 0.02, "thickness": 0.005, "density": 1100.0, "youngs_modulus": 5e8, "poissons_ratio": 0.3}


def make(circles: tuple[Circle, ...], belt: dict[str, Any], stiffness: float = 1e7, **groups: Any) -> Drive:
    """A drive whose first pulley is driven, and the others turn freely.

    At rest nothing rubs: the law of friction is the one of which other tests with such a belt have compiled kernels.
    """
    law = {"friction_law": "force_slope", "creep_rate_factor": 1e5} if "youngs_modulus" in belt else {}
    pulleys: list[dict[str, Any]] = [
        {"name": name, "center": (x, y), "radius": radius, "side": side, "inertia": 0.01, "mass": 1.0}
        for name, x, y, radius, side in circles
    ]
    pulleys[0]["speed"] = {"kind": "constant", "value": 10.0}
    return Drive(
        belt=belt,
        pulley=pulleys,
        contact={
            "stiffness": stiffness,
            "damping": 10.0,
            "friction": 0.8,
            "moment_arm": "point",
            **law,
        },
        simulation={"duration": 1e-3, "output_interval": 1e-3},
        **groups,
    )


def two(first: float, second: float, belt: dict[str, Any], stiffness: float = 1e7) -> Drive:
    """Two pulleys at four times the larger radius."""
    far = 4.0 * max(first, second)
    return make((("a", 0.0, 0.0, first, "inside"), ("b", far, 0.0, second, "inside")), belt, stiffness)


def serpentine(tensioner: Any = (), **belt: Any) -> Drive:
    """Seven pulleys, one on a tensioner."""
    given = LAYOUT_BELT | {"bending_factor": 0.002, "elements": 60} | belt
    return make(SERPENTINE, given, 1e8, tensioner=tensioner, gravity=(1.0, -9.81))


BENDING: dict[str, Callable[[int], Drive]] = {
    "EI 0.01": lambda n: two(
        0.05, 0.05, STIFFNESSES | {"bending_stiffness": 0.01, "installed_tension": 200, "elements": n}
    ),
    "EI 0.03": lambda n: two(
        0.05, 0.05, STIFFNESSES | {"bending_stiffness": 0.03, "installed_tension": 200, "elements": n}
    ),
    "A": lambda n: two(0.04, 0.04, {"profile": "A", "ribs": 1, "installed_tension": 150, "elements": n}),
    "SPZ": lambda n: two(0.0355, 0.0355, {"profile": "SPZ", "ribs": 1, "installed_tension": 300, "elements": n}),
    "PJ": lambda n: two(0.012, 0.012, {"profile": "PJ", "ribs": 4, "installed_tension": 100, "elements": n}),
    "unequal": lambda n: two(
        0.005, 0.06, LAYOUT_BELT | {"installed_tension": 300, "bending_factor": 0.01, "elements": max(n, 80)}, 1e9
    ),
    "crossed": lambda n: make(CROSSED, LAYOUT_BELT | {"installed_tension": 400, "crossed": True, "elements": n}, 1e8),
}


@pytest.mark.parametrize("elements", [24, pytest.param(FINE, marks=pytest.mark.slow)])
@pytest.mark.parametrize("case", BENDING)
def test_the_tension_that_is_asked_for_is_there(case: str, elements: int, measured: Callable[..., None]) -> None:
    """Without the statics it was missed by up to 16 %: the closed form leaves out bending."""
    drive = BENDING[case](elements)
    run = equilibrium(drive)
    found, closed = float(run.dataset.span_tension.mean()), install(run.drive).tension
    measured(asked=drive.belt.installed_tension or 0.0, found=found, closed_form=closed, length=run.drive.belt_length)
    assert found == pytest.approx(drive.belt.installed_tension, rel=ASKED)


@pytest.mark.slow
@pytest.mark.parametrize(
    "tensioner",
    [
        (),
        [ARM],
        [ARM | {"rate": 50.0}],
        [SLIDE],
        [SLIDE | {"rate": 1e4}],
        [ARM | {"preload": 90.0, "stops": (-0.05, 0.05), "stop_stiffness": 1e6}],
        [ARM | {"rate": 20.0}, BACK],
    ],
    ids=["none", "arm", "arm spring", "slide", "slide spring", "stop", "two"],
)
def test_with_every_tensioner_and_weight(tensioner: Any) -> None:
    rest = bring_to_rest(serpentine(tensioner, installed_tension=300.0))
    assert rest.tension == pytest.approx(300.0, rel=ASKED)
    assert rest.unstable == ()


def test_take_up_for_a_tension() -> None:
    """The length is given, too: the pulley moves, and the belt keeps its length.

    It sinks into rims by its load per length over the stiffness of contact, T / R k.
    """
    fixed, told = {"kind": "fixed", "pulley": "tensioner", "direction": (-1.0, 0.0)}, list[Progress]()
    rest = bring_to_rest(serpentine([fixed], installed_tension=300.0, length=1.85), told.append)
    assert {(one.time, one.outputs_written, one.phase) for one in told} == {
        (0.0, 0, "compiling"),
        (0.0, 0, "equilibrium"),
    }
    depths = rest.tension / (rest.prepared.radii * rest.prepared.contact_stiffness)
    np.testing.assert_allclose(rest.installation.penetrations, depths, rtol=0.2)  # bending lifts it off small ones
    assert rest.tension == pytest.approx(300.0, rel=ASKED)
    assert rest.drive.belt_length == 1.85
    assert rest.drive.centers[-1, 1] == 0.07
    assert rest.drive.tensioners[0].model_dump()["take_up"] != 0.0
    again = loads(rest.drive.text)
    assert again == rest.drive
    np.testing.assert_array_equal(again.centers, rest.drive.centers)


def conveyor_under(tension: float) -> Drive:
    conveyor = load(str(files("beltdyn").joinpath("examples", "conveyor.toml")))
    return conveyor.replace(belt=conveyor.belt.replace(length=None, installed_tension=tension, elements=120))


def test_a_take_up_of_constant_force_sets_the_tension() -> None:
    """Far from it there is no balance."""
    said = "its spring gives 1700 N, that tension needs 1200 N"
    with pytest.raises(ModelError, match=said) as error:
        bring_to_rest(conveyor_under(600.0))
    assert "belt.length instead" in str(error.value)


@pytest.mark.slow
def test_a_take_up_of_constant_force_may_miss_the_tension() -> None:
    """By half a per cent, which bending and contact take."""
    assert bring_to_rest(conveyor_under(850.0)).tension == pytest.approx(850.0, rel=5e-3)


def test_a_run_and_its_file_have_the_length_that_was_found(tmp_path: Any) -> None:
    drive = BENDING["EI 0.03"](24)
    run = simulate(drive, tmp_path / "run.nc")
    kept = open_run(tmp_path / "run.nc")
    assert kept.drive == run.drive
    assert kept.drive.belt_length > 1.001 * drive.belt_length
    assert float(kept.dataset.belt_coordinate[-1]) == pytest.approx(kept.drive.belt_length, rel=0.01)
    assert kept.dataset.attrs["drive_as_given"] == drive.text
    assert float(kept.dataset.span_tension[0].mean()) == pytest.approx(200.0, rel=ASKED)
    again = equilibrium(run.drive)
    assert again.drive.belt_length == run.drive.belt_length


def test_a_changed_drive_asks_for_the_tension_again() -> None:
    """Bending makes 26 N of 226 N with the length of the closed form, which copies of the drive had."""
    drive = BENDING["EI 0.03"](24)
    finer = drive.replace(belt=drive.belt.replace(elements=48))
    for changed in (finer, drive.replace(simulation=drive.simulation.replace(duration=2e-3)), drive.replace()):
        assert changed.belt.installed_tension == 200.0
        assert bring_to_rest(changed).tension == pytest.approx(200.0, rel=ASKED)
    tighter = drive.replace(belt=drive.belt.replace(installed_tension=400.0))
    assert bring_to_rest(tighter).tension == pytest.approx(400.0, rel=ASKED)


def test_a_length_takes_the_place_of_the_tension() -> None:
    """Also where it is that of a run's drive, which keeps what was found for it."""
    drive = BENDING["EI 0.03"](24)
    assert drive.replace(belt=drive.belt.replace(length=0.71)).belt.installed_tension is None
    found = bring_to_rest(drive).drive
    same = found.replace(belt=found.belt.replace(quadrature_points=4))
    assert same.belt.installed_tension is None
    assert same.belt_length == found.belt_length


def test_a_drive_travels_with_the_tension_that_is_asked_for() -> None:
    """To other processes, as in sweeps, and back: with the estimate of its length alone the tension would be missed."""
    drive = BENDING["EI 0.03"](24)
    travelled = pickle.loads(pickle.dumps(drive))
    assert (travelled, travelled.belt.installed_tension) == (drive, 200.0)
    found = bring_to_rest(travelled).drive
    assert pickle.loads(pickle.dumps(found)) == found


def test_a_drive_of_given_length_is_left_alone() -> None:
    drive = serpentine(length=1.85)
    assert bring_to_rest(drive).drive == drive


@pytest.mark.slow
@pytest.mark.parametrize(
    "elements", [12, pytest.param(80, marks=pytest.mark.slow), pytest.param(200, marks=pytest.mark.slow)]
)
def test_an_equilibrium_that_leaves_a_pulley_is_none(elements: int) -> None:
    """On 5 mm the belt would sink in by 6 mm: forces are in balance of a belt that touches nothing, too."""
    belt = LAYOUT_BELT | {"thickness": 0.01, "width": 0.01, "bending_factor": 0.01, "elements": elements}
    with pytest.raises(ConvergenceError, match=r'"a" the belt would sink by .* Increase contact.stiffness'):
        equilibrium(two(0.005, 0.06, belt | {"installed_tension": 300.0}))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bending", "mass", "cause"), [(0.2, 0.1, "bending stiffness"), (1e-4, 8.0, "weight")], ids=["stiff", "heavy"]
)
def test_a_belt_as_long_as_its_path_has_a_tension(bending: float, mass: float, cause: str) -> None:
    """Off the pulleys it is spread or sags; below that tension a longer belt would be refused as slack."""
    own = {"bending_stiffness": bending, "mass_per_length": mass, "axial_stiffness": 1e6, "elements": 60}
    belt = STIFFNESSES | own | {"installed_tension": 50.0}
    drive = two(0.05, 0.05, belt, 1e9).replace(gravity=(0.0, -9.81))
    with pytest.raises(ConvergenceError, match=f"still has .* N, by its {cause}: increase the tension") as caught:
        bring_to_rest(drive)
    least = float(str(caught.value).split("still has ")[1].split(" N")[0])
    assert least > 50.0
    reached = drive.replace(belt=drive.belt.replace(installed_tension=1.01 * least))
    assert bring_to_rest(reached).tension == pytest.approx(1.01 * least, rel=ASKED)


@pytest.mark.parametrize(
    ("elements", "stiffness"),
    [(9, 1e11), *(pytest.param(*one, marks=pytest.mark.slow) for one in ((9, 1e8), (20, 1e8), (20, 1e11)))],
)
def test_spans_of_coarse_meshes_have_a_tension(elements: int, stiffness: float) -> None:
    """Hard pulleys are touched between the points of contact alone, which left spans without a tension (nan)."""
    belt = LAYOUT_BELT | {"thickness": 0.01, "width": 0.01, "bending_factor": 0.01, "elements": elements}
    found = equilibrium(two(0.05, 0.05, belt | {"installed_tension": 300.0}, stiffness)).dataset
    for name, values in found.data_vars.items():
        if values.dtype.kind == "f" and name != "mid_span_displacement":  # of points of the free belt, where there are
            assert np.isfinite(values).all(), name
    assert all(np.isfinite(value) for value in found.attrs.values() if isinstance(value, float))
    assert float(found.span_tension.mean()) == pytest.approx(300.0, rel=ASKED)


def test_a_drive_at_rest_is_balanced() -> None:
    """A shaft of constant speed turns from time zero on; static equilibrium is without friction."""
    found = equilibrium(serpentine(length=1.85)).dataset
    assert np.abs(found.hub_force.sum("pulley")).max() < 0.01 * float(found.span_tension.max())


OVER_CENTRE = {"kind": "rotary", "pulley": "idler", "pivot": (0.15, 0.2), "inertia": 1e-3, "preload": 0.638}


@pytest.mark.parametrize(("length", "degrees", "stable"), [(1.84, -55.4, True), (1.7, 1.5, False)])
def test_which_balances_are_stable(length: float, degrees: float, stable: bool) -> None:
    """An arm near its dead center under a constant moment: one balance near its nominal place is not stable.

    The closed form, the second variation of the model's own statics, and what two equilibria with a little more moment
    tell of the way the arm goes agree.
    """
    drive = serpentine([OVER_CENTRE], length=length, elements=180).replace(gravity=(0.0, 0.0))
    (found,) = tensioner_balances(drive, install(drive))
    assert [balance.stable for balance in found if balance.here] == [stable]
    assert [balance.stable for balance in found if not balance.here] == [False] * (len(found) - 1)
    rest = bring_to_rest(drive)
    assert math.degrees(rest.installation.tensioner_positions[0]) == pytest.approx(degrees, abs=0.5)
    assert rest.unstable == (() if stable else ("idler",))
    (compliance,) = tensioner_compliance(rest.system, rest.state)[0]
    stronger = drive.replace(tensioner=[drive.tensioners[0].model_dump() | {"preload": 0.638 * 1.001}])
    moved = bring_to_rest(stronger).installation.tensioner_positions - rest.installation.tensioner_positions
    assert moved[0] / 0.638e-3 == pytest.approx(compliance, rel=0.02)
    warnings = equilibrium(drive).warnings
    assert any("unstable" in warning for warning in warnings) != stable


def test_no_tension_without_a_stable_balance() -> None:
    """Without the second variation the belt had 17 N and an arm at -32 degrees in place of 300 N at zero."""
    with pytest.raises(ModelError, match=r'300 N the equilibrium of the tensioner of "idler" at .*° is unstable'):
        serpentine([OVER_CENTRE | {"preload": 0.63776}], installed_tension=300.0)


def test_the_stable_balance_is_found_on_either_side() -> None:
    """Where springs press is no matter: the place with the tension that is asked for is the nominal one."""
    for factor in (0.999, 1.0, 1.001):
        base = install(serpentine([ARM], installed_tension=300.0))
        lever = base.tension
        assert lever == pytest.approx(300.0, rel=1e-9)
        drive = serpentine([ARM | {"preload": 30.0 * factor}], installed_tension=300.0)
        (found,) = tensioner_balances(drive, install(drive))
        here = next(balance for balance in found if balance.here)
        assert here.stable
        assert abs(here.position) == min(abs(balance.position) for balance in found if balance.stable)


@pytest.mark.parametrize("start", [1.0, 4.0, 64.0, 1 / 64])
@pytest.mark.parametrize("reach", [5.0, 2.5, 1.3])
def test_equilibria_are_followed_in_steps_that_succeed(start: float, reach: float) -> None:
    """A solver that gets no further than a ratio of stiffnesses; each is found from the one before."""
    found = [start]

    def balance(factor: float) -> bool:
        near = 1 / reach <= factor / found[-1] <= reach
        found.extend([factor] * near)
        return near

    assert follow(start, balance)
    assert found[-1] == 1.0


@pytest.mark.parametrize("start", [64.0, 1 / 64, 10.0])
def test_stiffness_changes_by_a_factor_of_four_where_that_succeeds(start: float) -> None:
    """And never passes that of the drive."""
    tried = list[float]()

    def balance(factor: float) -> bool:
        tried.append(factor)
        return True

    assert follow(start, balance)
    assert tried == {64.0: [64.0, 16.0, 4.0, 1.0], 1 / 64: [1 / 64, 1 / 16, 1 / 4, 1.0], 10.0: [10.0, 2.5, 1.0]}[start]


@pytest.mark.parametrize(
    ("compliance", "reaches", "unstable"),
    [
        ([[2.0, 1.0], [1.0, 2.0]], [1.0, 1.0], ()),
        ([[-2.0, 1.0], [1.0, 2.0]], [1.0, 1.0], ("left",)),
        ([[2.0, 1.0], [1.0, -2.0]], [1.0, 1.0], ("slide",)),
        ([[-2.0, 0.5], [0.5, -3.0]], [1.0, 1.0], ("left", "slide")),
        ([[1.0, 3.0], [3.0, 1.0]], [1.0, 0.1], ("slide",)),
        ([[1.0, 3.0], [3.0, 1.0]], [0.1, 1.0], ("left",)),
        ([[np.nan, 1.0], [1.0, -2.0]], [1.0, 1.0], ()),
        ([[0.0, 0.0], [0.0, 2.0]], [1.0, 1.0], ()),
    ],
    ids=["both", "first", "second", "none", "together", "together, other arm", "unknown", "without force"],
)
def test_tensioners_that_move_against_a_force_are_unstable(
    compliance: Any, reaches: list[float], unstable: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ways are compared in meters: of two that lose their balance together the one that moves farther is named."""
    monkeypatch.setattr(installation, "tensioner_compliance", lambda system, state: np.array(compliance))
    pulleys = [SimpleNamespace(name=name) for name in ("right", "left", "slide")]
    system = SimpleNamespace(
        bodies=np.array([(reach,) for reach in (7.0, 7.0, 7.0, *reaches)], [("reach", "f8")]).view(np.recarray),
        tensioners=SimpleNamespace(pulley=np.array([1, 2])),
    )
    rest: Any = SimpleNamespace(system=system, state=None, prepared=SimpleNamespace(pulleys=pulleys))
    assert installation._unstable(rest) == unstable


@pytest.mark.parametrize("depth", [0.0, 0.02])
def test_depths_are_those_below_the_rim(depth: float) -> None:
    """Of pulleys anywhere; of one that is touched between points alone none is known."""
    angles = np.linspace(0.0, 3.0, 5)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    centers = np.array([[0.3, -0.4], [5.0, 1.0]])
    prepared: Any = SimpleNamespace(radii=np.array([0.1, 0.2]))
    seen: Any = SimpleNamespace(
        contact_position=(centers[0] + (0.1 - depth) * circle)[None],
        contact_pulley=np.zeros((1, 5), int),
        pulley_center=centers[None],
    )
    touched, between = installation._depths(prepared, seen)
    np.testing.assert_allclose(touched, depth, atol=1e-15)
    np.testing.assert_array_equal(between, [0.0])


@pytest.mark.parametrize("lost", [64.0, 4.0, 1.0])
def test_equilibria_that_end_are_given_up(lost: float) -> None:
    tried = list[float]()

    def balance(factor: float) -> bool:
        tried.append(factor)
        return factor > lost

    assert not follow(64.0, balance)
    assert len(tried) < 20


def test_equilibrium_is_found_on_equal_elements() -> None:
    """Also of a drive whose runs have a mesh that stays in place, with the number that is chosen for equal ones."""
    drive = load(str(files("beltdyn").joinpath("examples", "crossed_belt.toml")))
    travelling = drive.replace(simulation=drive.simulation.replace(frame="travelling"))
    rest, still = bring_to_rest(drive), equilibrium(drive)
    assert rest.drive.simulation == drive.simulation
    assert rest.drive.elements == drive.elements
    assert still.dataset.sizes["node"] == still.drive.elements == travelling.elements > drive.elements
    assert rest.tension == pytest.approx(bring_to_rest(travelling).tension, rel=1e-9)


@pytest.mark.parametrize("settings", [{"force_tolerance": 0.02}, {"mesh": "uniform"}, {"start": "steady"}])
def test_settings_of_a_run_on_a_mesh_that_stays_do_not_matter_at_rest(settings: dict[str, Any]) -> None:
    drive = load(str(files("beltdyn").joinpath("examples", "crossed_belt.toml")))
    given = drive.replace(simulation=drive.simulation.replace(**settings))
    rest = bring_to_rest(given)
    assert rest.drive.simulation == given.simulation
    assert rest.tension == pytest.approx(prepare(drive).tension_at_rest, rel=0.05)


@pytest.mark.parametrize(("chosen", "elements"), [(False, 30), (True, None)])
def test_equal_elements_are_as_many_as_those_of_the_drive_or_chosen(chosen: bool, elements: int | None) -> None:
    """On a mesh that travels; a drive whose mesh travels already stays as it is."""
    drive = load(str(files("beltdyn").joinpath("examples", "crossed_belt.toml"))).with_({"belt.elements": 30})
    equal = installation.on_equal_elements(drive, chosen=chosen)
    assert not equal.frame.stays
    assert equal.belt.elements == elements
    assert installation.on_equal_elements(equal, chosen=True) is equal


@pytest.mark.parametrize(("teeth", "lost"), [(False, 0), (False, 1), (True, 0)])
def test_rest_is_found_beside_that_of_another_drive(teeth: bool, lost: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """As from the laid belt; a belt with teeth is laid anew, and another one where the neighbor leads nowhere."""
    drive = toothed() if teeth else BENDING["EI 0.03"](24)
    rest = installation.rest_of(prepare(installation.on_equal_elements(drive)))
    change = {"pulley[driven].center": [0.28005, 0.0]} if teeth else {"belt.length": 0.9999 * rest.drive.belt_length}
    tighter, nodes, search = rest.drive.with_(change), list[int](), find_equilibrium
    expected = bring_to_rest(tighter).tension

    def counted(system: System, start: State) -> Equilibrium:
        nodes.append(system.nodes)
        if len(nodes) == lost:
            raise ConvergenceError("lost")
        return search(system, start)

    monkeypatch.setattr(installation, "find_equilibrium", counted)
    tension = installation.rest_like(tighter, rest).tension
    assert tension == pytest.approx(expected, rel=1e-4 if teeth else 1e-7)
    assert tension > 1.001 * rest.tension
    assert nodes == [rest.system.nodes] * (2 if teeth else 1 + lost)  # on smooth pulleys first, and then in grooves


@pytest.mark.parametrize(("factor", "part"), [(1.0, 0.1), (10.0, 0.05)])
def test_a_belt_lies_a_tenth_of_the_smallest_radius_deep_at_most(factor: float, part: float) -> None:
    """In contact in which it would sink by half of it, and ten times less in contact ten times as stiff."""
    prepared = prepare(BENDING["EI 0.03"](24).with_({"contact.stiffness": 200.0 / (0.5 * 0.05**2)}))
    path, depth = installation.drawn_in(prepared, factor), float(prepared.installation.penetrations.min())
    assert depth == pytest.approx(0.5 * 0.05, rel=0.1)
    np.testing.assert_allclose(prepared.path.radii - path.radii, part * 0.05, rtol=0.1)
