"""Ends of an open belt: what they hold, what pulls them, and which ones a drive refuses."""

from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, FixedEnd, PulledEnd, WeightEnd, dumps, install, loads, prepare
from beltdyn.model.end import ends_on_path, pulling
from beltdyn.stretch import Linear

ANCHOR = {"name": "anchor", "kind": "fixed", "point": [0.1, -0.4]}
PULL = {"name": "pull", "kind": "pulled", "direction": [0.0, -2.0], "tension": "50 N"}
WEIGHT = {"name": "weight", "kind": "weight", "mass": 5.0}


def strap(*ends: dict[str, Any], **groups: Any) -> Drive:
    """A strap over one drum."""
    data: dict[str, Any] = {
        "belt": {
            "width": 0.02,
            "thickness": 1e-3,
            "length": 1.2,
            "axial_stiffness": 2e4,
            "bending_stiffness": 1e-4,
            "mass_per_length": 0.02,
        },
        "pulley": [{"name": "drum", "center": (0.0, 0.0), "radius": 0.1, "speed": {"kind": "constant", "value": 5.0}}],
        "contact": {"stiffness": 1e8, "friction": 0.3, "creep_rate_factor": 1e4, "friction_law": "force_slope"},
        "simulation": {"duration": 0.1, "output_interval": 1e-3},
        "end": ends,
    }
    for name, group in groups.items():
        data[name] = data[name] | group if isinstance(group, dict) else group
    return Drive(**data)


def test_what_ends_hold_and_what_pulls_them() -> None:
    fixed, pulled, hung = FixedEnd(**ANCHOR, clamped=True), PulledEnd(**PULL), WeightEnd(**WEIGHT)
    assert [end.held for end in (fixed, pulled, hung)] == [True, False, False]
    assert [end.turning_held for end in (FixedEnd(**ANCHOR), fixed, pulled, hung)] == [False, True, False, False]
    assert [end.force for end in (fixed, pulled, hung)] == [(0.0, 0.0), (0.0, -50.0), (0.0, 0.0)]
    assert [end.attached_mass for end in (fixed, pulled, hung)] == [0.0, 0.0, 5.0]
    first, second = ends_on_path((fixed, hung), (3.0, -4.0))
    assert first.pull is None
    assert second.point is None
    np.testing.assert_array_equal(first.point, [0.1, -0.4])
    np.testing.assert_array_equal(second.pull, [15.0, -20.0])
    assert pulling((first, second)) == 25.0
    assert pulling((first, first)) is None


@pytest.mark.parametrize(("end", "gravity"), [(PULL, (0.0, 0.0)), (WEIGHT, (0.0, -10.0))])
@pytest.mark.parametrize("first", [False, True])
def test_a_pulled_end_gives_the_tension_and_ends_where_the_belt_does(
    end: dict[str, Any], gravity: tuple[float, float], first: bool
) -> None:
    """50 N either way; the span hangs straight down from the rim, and the path is as long as the stretched belt."""
    ends = (end, ANCHOR | {"point": [-0.1, -0.4]}) if first else (ANCHOR, end)
    drive = strap(*ends, gravity=gravity)
    g = float(Linear(2e4).stretch(50.0))
    assert drive.path.length == pytest.approx(1.2 * g, rel=1e-12)
    hanging = 1.2 * g - 0.4 - 0.1 * np.pi
    assert drive.path.ends is not None
    point = drive.path.ends[0 if first else 1]
    np.testing.assert_allclose(point, [0.1 if first else -0.1, -hanging], rtol=1e-12)
    installed = install(drive)
    np.testing.assert_allclose(installed.span_tensions, [50.0, 50.0], rtol=1e-12)
    np.testing.assert_allclose(installed.hub_loads, [[0.0, -100.0]], atol=1e-10)
    assert drive.belt_length == 1.2


def test_fixed_ends_take_a_length_or_a_tension() -> None:
    left = {"name": "left", "kind": "fixed", "point": [-0.1, -0.5]}
    given = strap(ANCHOR, left)
    path = 0.9 + 0.1 * np.pi
    assert given.path.length == pytest.approx(path)
    asked = strap(ANCHOR, left, belt={"length": None, "installed_tension": 40.0})
    assert install(asked).tension == pytest.approx(40.0)
    assert asked.belt_length < path
    assert asked.spans == (("drum", "left"), ("anchor", "drum"))


def test_a_slack_belt_swings_at_no_frequency_on_any_span() -> None:
    drive = strap(ANCHOR, PULL)
    slack = prepare(drive).installed(np.array([50.0, 0.0]), np.zeros(1), np.zeros((1, 2)), np.zeros(0))
    np.testing.assert_array_equal(slack.span_frequencies, [0.0, 0.0])


@pytest.mark.parametrize("ends", [(ANCHOR, PULL), (ANCHOR | {"clamped": True}, WEIGHT)])
def test_a_written_drive_is_the_same(ends: tuple[dict[str, Any], ...]) -> None:
    drive = strap(*ends, gravity=(0.0, -9.81))
    assert loads(dumps(drive)) == drive
    np.testing.assert_array_equal(loads(dumps(drive)).path.ends, drive.path.ends)


FREE = {"length": None, "installed_tension": 40.0}


@pytest.mark.parametrize(
    ("ends", "groups", "message"),
    [
        ([ANCHOR], {}, "the number of .* is 1; .*has two.*Give both"),
        ([PULL, WEIGHT], {"gravity": (0.0, -10.0)}, '"pull" and "weight" are both pulled.*kind = "fixed"'),
        ([ANCHOR, WEIGHT], {}, 'no force pulls end "weight".*Give gravity'),
        ([ANCHOR, PULL], {"belt": FREE}, "installed_tension = 40 N contradicts the pulled end.*belt.length"),
        ([ANCHOR, PULL], {"belt": {"length": 0.6}}, 'length = 0.6 m is too short: end "pull".*more than 0.71'),
        ([ANCHOR | {"point": [0.05, 0.0]}, PULL], {}, 'end "anchor" lies inside pulley "drum": it is 0.05 m'),
        ([ANCHOR | {"name": "drum"}, PULL], {}, '^name = "drum" is used 2 times'),
        ([ANCHOR, PULL], {"pulley": []}, "no pulley; an open belt needs"),
        ([ANCHOR, PULL | {"direction": [1.0, 0.0]}], {}, 'cross itself: the span from "drum" to "pull" meets'),
        ([ANCHOR, PULL | {"direction": [0.0, 1.0]}], {}, 'does not touch pulley "drum"'),
        ([ANCHOR, PULL], {"simulation": {"joint": "multipliers"}}, "joint = .multipliers. closes the belt"),
        (
            [ANCHOR, PULL],
            {"belt": {"discretization": "three-node-beam"}},
            "end.. is incompatible with .*three-node-beam",
        ),
        (
            [ANCHOR | {"clamped": True}, PULL],
            {"belt": {"discretization": "truss"}},
            "end.clamped is incompatible with .*truss",
        ),
        ([ANCHOR, PULL | {"point": [0.0, 0.0]}], {}, "point"),
    ],
)
def test_what_does_not_fit_is_refused(ends: list[dict[str, Any]], groups: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        strap(*ends, **groups)


def test_the_path_may_run_either_way_around_a_pulley() -> None:
    """Mirrored, with the drum at the belt's back."""
    one = strap(ANCHOR, PULL).path
    drum = {"name": "drum", "center": (0.0, 0.0), "radius": 0.1, "side": "outside", "inertia": 1.0}
    other = strap(ANCHOR | {"point": [-0.1, -0.4]}, PULL, pulley=[drum]).path
    assert one.ends is not None
    assert other.ends is not None
    np.testing.assert_allclose(other.ends, one.ends * [-1.0, 1.0])
    np.testing.assert_allclose(other.span_lengths, one.span_lengths)
