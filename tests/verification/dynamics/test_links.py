"""Belts of links in motion: energy account, agreement of integrators, and the same drive with the paper's element."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.model import Drive

pytestmark = pytest.mark.slow  # kernels of their own
Change = Callable[..., Drive]
Measured = Callable[..., None]
CHAINS = {"truss": 480, "three-node-beam": 240}
"""Elements; both have 480 links."""


@pytest.fixture(scope="module")
def made_of(small: Drive, change: Change) -> Callable[..., Drive]:
    """The small drive with another belt, for 20 ms."""

    def make(kind: str, elements: int, sampling: str = "nodal", **settings: object) -> Drive:
        return change(
            small,
            belt={"discretization": kind, "elements": elements},
            contact={"sampling": sampling},
            simulation={"duration": 0.02} | settings,
        )

    return make


@pytest.mark.parametrize("kind", CHAINS)
@pytest.mark.parametrize("sampling", ["nodal", "distributed"])
def test_energy_account_closes(made_of: Callable[..., Drive], measured: Measured, kind: str, sampling: str) -> None:
    errors = []
    for rtol in (1e-4, 1e-5):
        run = simulate(made_of(kind, CHAINS[kind] // 4, sampling, rtol=rtol)).dataset
        errors.append(float(np.max(np.abs(run.energy_closure))))
    measured(rtol_1e4=errors[0], rtol_1e5=errors[1])
    assert errors[0] < 1e-3
    assert errors[1] < 0.3 * errors[0]


@pytest.mark.parametrize("kind", CHAINS)
@pytest.mark.parametrize("integrator", ["bdf", "radau"])
def test_integrators_agree(made_of: Callable[..., Drive], measured: Measured, kind: str, integrator: str) -> None:
    """As far as a local tolerance per unit of time demands, over a fraction of a second, with 96 links.

    With less than forty, nodes on the pulleys would make the belt so much shorter that it hangs slack.
    """
    rtol, elements = 1e-4, CHAINS[kind] // 5
    first, second = (
        simulate(made_of(kind, elements, rtol=rtol, duration=5e-3, integrator=name)).dataset
        for name in ("generalized_alpha", integrator)
    )
    speed = float(np.max(np.abs(second.pulley_speed - first.pulley_speed))) / 12.0
    place = float(np.max(np.abs(second.node_position - first.node_position))) / 1.2727
    moved = float(np.max(np.abs(first.node_position.values[-1] - first.node_position.values[0]))) / 1.2727
    measured(speed=speed, place=place, moved=moved)
    assert speed < rtol
    assert place < 0.01 * moved


@pytest.mark.parametrize("kind", CHAINS)
@pytest.mark.parametrize("sampling", ["nodal", "distributed"])
def test_agrees_with_the_papers_element(
    made_of: Callable[..., Drive], measured: Measured, kind: str, sampling: str
) -> None:
    """60 elements of the paper err by far less than the links, whose tension is off by half a per cent."""
    element = simulate(made_of("ancf", 60, "distributed")).dataset
    links = simulate(made_of(kind, CHAINS[kind], sampling)).dataset
    speed = float(np.max(np.abs(links.pulley_speed - element.pulley_speed)))
    tension = float(np.max(np.abs(links.span_tension - element.span_tension)) / element.span_tension.max())
    moved = float(np.ptp(element.pulley_speed.sel(pulley="driven").values))
    measured(speed=speed, tension=tension, driven_speed=moved)
    assert speed < 0.02 * moved
    assert tension < 0.02
