"""Tensioners: what is refused, and which way they tension the belt."""

from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, FixedTensioner, Path, RotaryTensioner, SlidingTensioner, loads, prepare

SLIDING = {"kind": "sliding", "pulley": "driven", "direction": (1.0, 0.0), "preload": 50.0, "mass": 0.2}
ROTARY = {"kind": "rotary", "pulley": "driven", "pivot": (0.191441, 0.2), "preload": 5.0, "inertia": 1e-3}


@pytest.mark.parametrize(
    ("tensioner", "sentence"),
    [
        (
            SLIDING | {"pulley": "none"},
            'tensioner[1].pulley = "none" is not the name of a pulley. Choose one of driver,',
        ),
        (SLIDING | {"direction": (0, 0)}, "has zero length: at least one component must differ from zero"),
        (
            SLIDING | {"direction": (-1, 0)},
            'the tensioner of "driven" cannot tension the belt: a meter along its direction lengthens the path by -2 m',
        ),
        (SLIDING | {"direction": (0, 1)}, 'the tensioner of "driven" cannot tension the belt'),
        (ROTARY | {"pivot": (0.191441, 0.0)}, "is the center of the pulley. Move one of them"),
        (ROTARY | {"pivot": (0.4, 0.0)}, 'the arm of the tensioner of "driven" cannot tension the belt'),
        (SLIDING | {"mass": 0.0}, 'the tensioner of "driven" has no moving mass'),
        (ROTARY | {"inertia": 0.0}, 'the tensioner of "driven" has no moving mass'),
        (SLIDING | {"stops": (0.1, 0.2)}, "stops = [0.1, 0.2] must be a lower and an upper stop on both sides of zero"),
        (SLIDING | {"stops": (0.0, 0.0)}, "stops = [0, 0] must be"),
        (SLIDING | {"stops": (-0.1, 0.1)}, "stop_stiffness is missing, but stops are springs"),
        (SLIDING | {"rate": -1.0}, "must be at least 0"),
        (SLIDING | {"preload": "5 N*m"}, 'must be in units of N, not "N*m"'),
        (ROTARY | {"preload": "5 N"}, 'must be in units of N*m, not "N"'),
        ({"kind": "spring"}, 'tensioner[1].kind = "spring" is not a valid choice'),
        ({"pulley": "driven"}, "has no kind"),
    ],
)
def test_errors(drive: Drive, tensioner: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        drive.replace(tensioner=[tensioner])
    assert sentence in str(caught.value)


def test_a_pulley_has_one_tensioner(drive: Drive) -> None:
    with pytest.raises(ModelError, match='pulley "driven" is carried by 2 tensioners'):
        drive.replace(tensioner=[SLIDING, ROTARY])


def test_drive_knows_what_is_carried(drive: Drive) -> None:
    stops = {"stops": (-0.01, 0.01), "stop_stiffness": 1e6}
    changed = drive.replace(
        tensioner=[ROTARY | stops, SLIDING | stops | {"pulley": "driver", "direction": (-3.0, 0.0)}]
    )
    assert [changed.carried(item) for item in changed.tensioners] == [1, 0]


def test_a_drive_with_tensioners_survives_its_text(drive: Drive) -> None:
    fixed = {"kind": "fixed", "pulley": "driver", "direction": (-1.0, 0.3), "take_up": "-1 mm"}
    arm = ROTARY | {"stops": ("-5 deg", "10 deg"), "stop_stiffness": "100 N*m/deg", "mass": 0.3}
    changed = drive.replace(tensioner=[fixed, arm])
    assert loads(changed.text) == changed
    one, other = changed.tensioners
    assert isinstance(one, FixedTensioner)
    assert isinstance(other, RotaryTensioner)
    assert one.take_up == -1e-3
    moved = changed.centers[0] - drive.centers[0]
    np.testing.assert_allclose(moved, -1e-3 * np.array(one.direction), atol=1e-15)
    assert np.hypot(*one.direction) == pytest.approx(1, rel=1e-15)
    assert other.stops == pytest.approx((-np.deg2rad(5), np.deg2rad(10)))


@pytest.mark.parametrize(("pivot", "leverage"), [((0.191441, 0.2), 2.0), ((0.191441, -0.2), -2.0)])
def test_leverage_of_an_arm(drive: Drive, pivot: tuple[float, float], leverage: float) -> None:
    """The driven pulley at (0.19, 0) with spans to the left: moved to the right by a meter, two meters of path."""
    arm = RotaryTensioner(**ROTARY | {"pivot": pivot})
    assert arm.leverage(drive.path.centers[1], drive.path.gradient(1)) == pytest.approx(leverage, rel=1e-12)


def test_leverage_of_a_slide(drive: Drive) -> None:
    slide = SlidingTensioner(**SLIDING | {"direction": (3.0, 4.0)})
    assert slide.leverage(drive.path.centers[1], drive.path.gradient(1)) == pytest.approx(1.2, rel=1e-12)


@pytest.mark.parametrize("pulley", range(3))
@pytest.mark.parametrize("axis", [0, 1])
def test_gradient_of_the_path_is_the_difference_of_its_directions(pulley: int, axis: int) -> None:
    """By central differences, around a third pulley that the back of the belt touches too."""
    centers, radii = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.14]]), np.array([0.2, 0.15, -0.08])
    step = np.zeros((3, 2))
    step[pulley, axis] = 1e-5
    numeric = (Path(centers + step, radii).length - Path(centers - step, radii).length) / 2e-5
    assert Path(centers, radii).gradient(pulley)[axis] == pytest.approx(numeric, abs=1e-9)


@pytest.mark.parametrize("tensioner", [SLIDING | {"rate": 3e3}, ROTARY | {"rate": 8.0}], ids=["slide", "arm"])
def test_forces_of_many_positions_are_those_of_each_with_stops(drive: Drive, tensioner: dict[str, Any]) -> None:
    held = tensioner | {"stops": (-0.01, 0.02), "stop_stiffness": 5e3}
    (carrier,) = prepare(drive.replace(tensioner=[held])).carriers
    positions = np.linspace(-0.02, 0.03, 12).reshape(3, 4)
    each = [carrier.force(position) for position in positions.ravel().tolist()]
    np.testing.assert_allclose(carrier.forces(positions).ravel(), each, rtol=1e-14)
    assert carrier.forces(0.015) == pytest.approx(carrier.force(0.015), rel=1e-14)
