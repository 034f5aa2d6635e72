"""Laws of the normal force (Eq. 17): by cases, energy and derivatives; a damper pulls as published, or never."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.contact.normal import LAWS, NoPull, NormalParameters, Published, normal_force

STIFFNESS, DAMPING = 1e6, 40.0
NO_PULL, PUBLISHED = NoPull(STIFFNESS, DAMPING), Published(STIFFNESS, DAMPING)
RATES = st.floats(-5.0, 5.0)
DEPTHS = st.floats(0.0, 1e-3)


@pytest.fixture(params=LAWS)
def law(request: pytest.FixtureRequest) -> NormalParameters:
    """Every law, with the examples of its own parameters."""
    kind = LAWS[request.param]
    parameters: NormalParameters = kind.record(STIFFNESS, DAMPING, *(own.example for own in kind.parameters))
    return parameters


@pytest.mark.parametrize(
    ("penetration", "rate", "force"),
    [
        (-1e-9, 5.0, 0.0),
        (0.0, 0.0, 0.0),
        (1e-4, 0.0, 100.0),
        (1e-7, 0.0, 0.1),
        (1e-4, 2.0, 180.0),
        (1e-4, -2.0, 20.0),
        (1e-4, -2.6, 0.0),
        (0.0, 1.0, 40.0),
    ],
    ids=["free", "touching", "spring", "light", "approaching", "leaving", "leaving fast", "impact"],
)
def test_cases(penetration: float, rate: float, force: float) -> None:
    assert normal_force(NO_PULL, penetration, rate).force == pytest.approx(force)


@pytest.mark.parametrize("rate", [-2.6, 0.0, 5.0])
def test_a_free_belt_feels_stores_and_resists_nothing(law: NormalParameters, rate: float) -> None:
    assert tuple(normal_force(law, -1e-9, rate)) == (0.0,) * 5


def test_a_belt_that_is_let_go_feels_nothing_of_its_springs() -> None:
    """They stay strained by the penetration."""
    assert tuple(normal_force(NO_PULL, 1e-4, -2.6)) == pytest.approx((0.0, 0.0, 0.0, 100.0, 0.005), abs=0.0)


def test_force_has_no_jump_where_the_damper_lets_go() -> None:
    penetration = 1e-4
    rate = -STIFFNESS * penetration / DAMPING
    assert normal_force(NO_PULL, penetration, rate * (1 - 1e-9)).force == pytest.approx(0.0, abs=1e-6)


def test_the_published_law_pulls_a_belt_that_leaves_fast() -> None:
    assert normal_force(PUBLISHED, 1e-4, -2.6).force == pytest.approx(-4.0)
    assert normal_force(PUBLISHED, 1e-4, -2.0) == normal_force(NO_PULL, 1e-4, -2.0)
    assert normal_force(PUBLISHED, -1e-9, -2.6).force == 0.0


@pytest.mark.parametrize(("penetration", "rate"), list(product((1e-5, 1e-4), (-3.0, -1.0, 0.0, 2.0))))
def test_derivatives(law: NormalParameters, penetration: float, rate: float) -> None:
    force, step = normal_force(law, penetration, rate), 1e-8
    deeper, less = (normal_force(law, penetration + s, rate) for s in (step, -step))
    faster, slower = (normal_force(law, penetration, rate + s) for s in (step, -step))
    rounding = 1e-6  # 1e-14 of 100 N/m over the step
    assert force.by_penetration == pytest.approx((deeper.force - less.force) / (2 * step), rel=rounding, abs=1.0)
    assert force.by_rate == pytest.approx((faster.force - slower.force) / (2 * step), abs=1e-5)
    assert force.elastic == pytest.approx((deeper.energy - less.energy) / (2 * step), rel=rounding)


@given(DEPTHS, RATES)
def test_the_damper_only_takes_energy(penetration: float, rate: float) -> None:
    force = normal_force(NO_PULL, penetration, rate)
    assert (force.force - force.elastic) * rate >= 0.0
