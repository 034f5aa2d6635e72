"""Idlers and guides: resistances with their derivatives, and what drive files tell of them."""

import numpy as np
import pytest

from beltdyn.arrays import blank, fill
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines import Goods, Guide, Idlers, Support
from beltdyn.machines.carrying.support import SUPPORTS

SPAN = ("tail", "head")
IDLERS = Idlers(
    kind="idlers",
    span=SPAN,
    spacing=1.2,
    idler_mass=18.0,
    friction=0.02,
    secondary_factor=1.1,
    resistance=3.0,
    linear=0.5,
)
GUIDE = Guide(kind="guide", span=SPAN, friction=0.2, pressing=15.0)


def resistance(support: Support, normal: float, speed: float) -> tuple[float, float, float]:
    constants = blank(type(support).constants)
    fill(constants, support.values(9.81))
    found = interpreted(type(support).resistance_at)(constants, normal, speed)
    return found.force, found.by_normal, found.by_speed


def test_idlers_resist_by_the_main_resistance_of_din_22101() -> None:
    force, _, _ = resistance(IDLERS, 1200.0, 4.0)
    assert IDLERS.rotating_mass == pytest.approx(15.0)
    assert force == pytest.approx(1.1 * 0.02 * (1200.0 + 15.0 * 9.81) + 3.0 + 0.5 * 4.0, rel=1e-12)


def test_a_guide_resists_by_normal_force_and_clamping() -> None:
    assert resistance(GUIDE, 40.0, -0.5)[0] == pytest.approx(-0.2 * (40.0 + 15.0), rel=1e-12)


@pytest.mark.parametrize("support", [IDLERS, GUIDE])
@pytest.mark.parametrize("speed", [-0.004, 0.0, 0.013])
def test_derivatives_are_those_of_the_force(support: Support, speed: float) -> None:
    step = 1e-6
    _, by_normal, by_speed = resistance(support, 500.0, speed)
    more, less = resistance(support, 500.0 + step, speed)[0], resistance(support, 500.0 - step, speed)[0]
    assert by_normal == pytest.approx((more - less) / (2.0 * step), rel=1e-6, abs=1e-9)
    more, less = resistance(support, 500.0, speed + step)[0], resistance(support, 500.0, speed - step)[0]
    assert by_speed == pytest.approx((more - less) / (2.0 * step), rel=1e-5)


def test_resistance_is_against_motion_and_zero_at_rest() -> None:
    for support in (IDLERS, GUIDE):
        assert resistance(support, 100.0, 0.0)[0] == 0.0
        assert resistance(support, 100.0, 0.1)[0] == -resistance(support, 100.0, -0.1)[0] > 0.0


def test_kinds_are_registered() -> None:
    assert list(SUPPORTS) == ["idlers", "guide"]


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: Goods(span=SPAN, mass_per_length=-1.0), "mass_per_length"),
        (lambda: Goods(span=SPAN, mass_per_length=0.0), "mass_per_length"),
        (lambda: Idlers(kind="idlers", span=SPAN, spacing=1.0, idler_mass=-2.0), "idler_mass"),
        (lambda: Idlers(kind="idlers", span=SPAN, spacing=0.0), "spacing"),
        (lambda: Guide(kind="guide", span=SPAN, friction=-0.1), "friction"),
        (lambda: Goods(span=SPAN, mass_per_length=1.0, start=5.0, end=4.0), "must lie behind start"),
    ],
)
def test_impossible_numbers_are_refused(made: object, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        made()  # type: ignore[operator]


def test_constants_are_all_filled() -> None:
    for support in (IDLERS, GUIDE):
        assert set(support.values(9.81)) == set(np.dtype(type(support).constants).names or ())


def test_a_flow_of_goods_is_their_mass_per_length_times_speed() -> None:
    """1500 t/h at 4 m/s are 104.17 kg/m."""
    flow = {"mass_flow": "1500 t/h", "speed": "4 m/s"}
    goods = Goods(span=["tail", "head"], **flow)
    assert goods.mass_per_length == pytest.approx(1.5e6 / 3600.0 / 4.0)
    assert goods == Goods(span=["tail", "head"], mass_per_length=goods.mass_per_length)
    for keys, words in (
        ({"mass_flow": "1500 t/h"}, "speed is missing"),
        ({"speed": 4.0}, "mass_flow is missing"),
        ({"mass_flow": 1.0, "speed": 4.0, "mass_per_length": 1.0}, "exclude each other"),
        ({"mass_flow": "1500 t", "speed": 4.0}, "must be in units of kg/s"),
        ({"mass_flow": 1.0, "speed": 0.0}, "speed"),
    ):
        with pytest.raises(ModelError, match=words):
            Goods(span=["tail", "head"], **keys)
