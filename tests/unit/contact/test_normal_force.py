"""The penalty force (Eq. 17) by cases, with the departure that a damper never pulls the belt."""

import pytest

from beltdyn.contact.law import ContactLaw
from beltdyn.contact.normal_force import normal_force


@pytest.mark.parametrize(
    ("penetration", "rate", "force"),
    [
        (-1e-9, 5.0, 0.0),
        (0.0, 0.0, 0.0),
        (1e-4, 0.0, 100.0),
        (1e-4, 2.0, 180.0),
        (1e-4, -2.0, 20.0),
        (1e-4, -2.6, 0.0),
        (0.0, 1.0, 40.0),
    ],
    ids=["free", "touching", "spring", "approaching", "leaving", "leaving fast", "impact"],
)
def test_cases(law: ContactLaw, penetration: float, rate: float, force: float) -> None:
    assert normal_force(penetration, rate, law) == pytest.approx((force, float(force > 0.0)))


def test_force_has_no_jump_where_the_damper_lets_go(law: ContactLaw) -> None:
    penetration = 1e-4
    rate = -law.stiffness * penetration / law.damping
    assert normal_force(penetration, rate * (1 - 1e-9), law)[0] == pytest.approx(0.0, abs=1e-6)


def test_the_published_law_pulls_a_belt_that_leaves_fast(law: ContactLaw) -> None:
    published = law._replace(may_pull=True)
    assert normal_force(1e-4, -2.6, published) == pytest.approx((-4.0, 1.0))
    assert normal_force(1e-4, -2.0, published) == normal_force(1e-4, -2.0, law)
    assert normal_force(-1e-9, -2.6, published) == (0.0, 0.0)
