"""Where supports and goods lie on the spans of a drive, and what is refused."""

from math import sqrt
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model.carrying import (
    HANGING,
    SINKING,
    hanging_lengths,
    normal_load,
    stiffness_of,
    stretch_of,
    swinging_lengths,
    upper_side,
)

GRAVITY = (0.0, -9.81)


def conveyor(**changes: Any) -> bd.Drive:
    """A conveyor of 20 m between two drums."""
    return bd.Drive(
        **{
            "gravity": GRAVITY,
            "belt": {"profile": "flat-polyester-fabric", "width": "400 mm", "installed_tension": "2 kN"},
            "pulley": [
                {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "speed": 5.0},
                {"name": "tail", "center": [20.0, 2.0], "radius": 0.2, "inertia": 0.15},
            ],
            "support": [{"kind": "idlers", "span": ["tail", "head"], "spacing": 1.0}],
            "goods": [{"span": ["tail", "head"], "mass_per_length": 30.0, "start": 2.0, "end": "15 m"}],
            "contact": {"friction": 0.3},
            "simulation": {"duration": 1.0},
        }
        | changes
    )


def test_a_stretch_lies_where_it_was_given_on_its_span() -> None:
    prepared = bd.model.prepare(conveyor())
    stretch = prepared.stretch(prepared.goods[0])
    points = prepared.path.span_points[1]
    assert (stretch.span, stretch.start, stretch.end, stretch.length) == (1, 2.0, 15.0, 13.0)
    np.testing.assert_allclose(stretch.origin, points[0])
    np.testing.assert_allclose(stretch.direction, (points[1] - points[0]) / np.linalg.norm(points[1] - points[0]))
    whole = stretch_of(prepared.supports[0], prepared.spans, prepared.path)
    assert whole.length == pytest.approx(float(prepared.path.span_lengths[1]))


def test_supports_are_on_the_lower_side() -> None:
    for direction in ([1.0, 0.0], [-0.8, 0.6], [-1.0, 0.0]):
        normal = upper_side(np.array(direction), GRAVITY)
        assert normal @ np.array(direction) == pytest.approx(0.0)
        assert normal[1] > 0.0


def test_belt_and_goods_sink_in_by_a_millimeter() -> None:
    drive = conveyor()
    load = normal_load(drive.supports[0], drive.goods, 1.0, np.array([-1.0, 0.0]), GRAVITY)
    assert load == pytest.approx(31.0 * 9.81)
    assert stiffness_of(drive.supports[0], load, 0.0, 0.0, 10.0) == pytest.approx(load / SINKING)
    assert stiffness_of(drive.supports[0].replace(stiffness=5e4), load, 1e3, 0.0, 10.0) == 5e4


def test_a_tight_belt_hangs_over_a_small_part_of_its_support() -> None:
    """Over sqrt(T / k) at either end; clamped with its bending stiffness, sqrt((T + 2 sqrt(EI k)) / k)."""
    drive = conveyor()
    for bending in (0.0, 1.0):
        stiffness = stiffness_of(drive.supports[0], 100.0, 2e3, bending, 2.0)
        assert stiffness > 100.0 / SINKING
        assert sqrt((2e3 + 2.0 * sqrt(bending * stiffness)) / stiffness) == pytest.approx(HANGING * 2.0)


GUIDE = {"kind": "guide", "span": ["tail", "head"], "friction": 0.2}
IDLERS = {"kind": "idlers", "span": ["tail", "head"], "spacing": 1.0}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"support": [IDLERS | {"span": ["head", "nowhere"]}]}, r"is no span of the belt. Choose one of"),
        ({"support": [IDLERS | {"span": ["head", "head"]}]}, "is the arc on a pulley"),
        ({"support": [IDLERS | {"end": 25.0}]}, r"support\[1\].end = 25 m lies beyond the span"),
        ({"goods": [{"span": ["tail", "head"], "mass_per_length": 5.0, "start": 30.0}]}, r"goods\[1\].start = 30 m"),
        (
            {"goods": [{"span": ["tail", "head"], "mass_per_length": 5.0, "batch": [3.0, -4.0]}]},
            r"batch = \[3, -4\] m must be the rear and the front",
        ),
        ({"support": [GUIDE | {"span": ["head", "head"]}]}, "is the arc on a pulley"),
        ({"support": [GUIDE | {"friction": -0.1}]}, r"support\[1\].friction = -0.1 must be at least 0"),
        ({"support": [GUIDE | {"pressing": "-5 N/m"}]}, "pressing = .*-5.* must be at least 0"),
        ({"support": [GUIDE | {"curve_radius": 0.0}]}, "curve_radius = 0.0 must be greater than 0"),
        ({"support": [GUIDE | {"start": 9.0, "end": 4.0}]}, "end = 4 m must lie behind start = 9 m"),
        ({"gravity": (0.0, 0.0)}, "carries by weight, but gravity"),
        ({"gravity": (9.81, 0.98)}, "is vertical"),
        ({"support": [IDLERS | {"curve_radius": 10.0}]}, "lifts the empty belt"),
        ({"simulation": {"duration": 1.0, "frame": "travelling"}}, "need a mesh that stays"),
        ({"belt": {"profile": "flat-polyester-fabric", "width": "400 mm"}, "end": None}, "belt.length is missing"),
    ],
)
def test_what_the_belt_cannot_lie_on_is_refused(changes: dict[str, Any], words: str) -> None:
    given = {key: value for key, value in changes.items() if value is not None}
    with pytest.raises(ModelError, match=words):
        conveyor(**given)


def test_a_guide_needs_no_weight() -> None:
    guide = {"kind": "guide", "span": ["tail", "head"], "friction": 0.2}
    assert conveyor(gravity=(0.0, 0.0), support=[guide]).carries


def test_schedules_of_goods_are_breakpoints() -> None:
    goods = {"span": ["tail", "head"], "mass_per_length": 5.0}
    drive = conveyor(goods=[goods | {"schedule": {"kind": "step", "time": 0.3, "value": 1.0}}])
    assert 0.3 in drive.breakpoints


def test_a_drive_that_carries_is_written_and_read() -> None:
    drive = conveyor()
    assert bd.loads(bd.dumps(drive)) == drive


def test_what_no_support_carries_hangs_and_swings() -> None:
    """20 m less 2 m at the start, 4 m at the end and a gap of 1 m; from idler to idler where all is carried."""
    drive = conveyor(support=[IDLERS | {"start": 2.0, "end": 10.0}, IDLERS | {"start": 11.0, "end": 16.0}])
    length = float(drive.path.span_lengths[1])
    free, held = hanging_lengths(drive.supports, drive.spans, drive.path)
    np.testing.assert_allclose(free, [drive.path.span_lengths[0]])
    np.testing.assert_allclose(held, [2.0, 1.0, length - 16.0])
    np.testing.assert_allclose(swinging_lengths(drive.supports, drive.spans, drive.path), [free[0], length - 16.0])
    whole = conveyor(support=[IDLERS | {"spacing": 1.5}])
    assert swinging_lengths(whole.supports, whole.spans, whole.path)[1] == 1.5


def test_a_carried_span_does_not_sag_and_swings_between_its_idlers() -> None:
    """Its frequency is that of a string of the spacing."""
    both = [IDLERS, IDLERS | {"span": ["head", "tail"], "spacing": 2.0}]
    drive = conveyor(support=both, goods=[])
    _, found = bd.model.estimate_at_rest(bd.model.prepare(drive))
    mass = drive.belt.mass_per_length
    for span, spacing in enumerate((2.0, 1.0)):
        string = np.sqrt(found.span_tensions[span] / mass) / (2.0 * spacing)
        assert found.span_frequencies[span] == pytest.approx(string, rel=0.01)
    free, _ = bd.model.estimate_at_rest(bd.model.prepare(conveyor(support=[], goods=[])))
    carried, _ = bd.model.estimate_at_rest(bd.model.prepare(drive))
    assert carried.belt_length < free.belt_length
