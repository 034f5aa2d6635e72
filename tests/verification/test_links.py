"""Verified: belts of straight links at rest and in rotation.

Against: regular polygons, whose n sides of length L lie on a circle of radius L / 2 sin(pi / n), on the way to
a circle.
"""

from collections.abc import Callable
from math import pi, sin

import numpy as np
import pytest
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive, prepare
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import NO_TANGENT, System
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.observe import observe
from beltdyn.system.state import State, at_rest, laid
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

pytestmark = pytest.mark.slow  # kernels of their own
Order = Callable[..., float]
Measured = Callable[..., None]
LINKS_OF = {"truss": 1, "three-node-beam": 2}


def linked(belt: Belt, kind: str, links: int, **changed: float) -> Belt:
    return belt.replace(discretization=kind, elements=links // LINKS_OF[kind], **changed)


def points(system: System, state: State) -> FloatArray:
    """Places of all points, m, shape (links, 2)."""
    return state.nodes(system).reshape(-1, 2)


@pytest.fixture(scope="module")
def released(belt: Belt, drive: Drive) -> Callable[[int], tuple[Belt, System, State]]:
    def release(links: int) -> tuple[Belt, System, State]:
        """Leftmost point fixed in x and y, rightmost in y."""
        loose = linked(belt, "three-node-beam", links, length=1.276)
        system = belt_system(loose, closure="shared_node")
        start = laid(system, drive.path)
        x = points(system, start)[:, 0]
        (left, a), (right, b) = (divmod(int(k), 3) for k in (np.argmin(x), np.argmax(x)))
        fixed = [(left, 2 * a), (left, 2 * a + 1), (right, 2 * b + 1)]
        held = belt_system(loose, closure="shared_node", fixed=fixed)
        return loose, held, find_equilibrium(held, start).state

    return release


class TestReleasedBelt:
    """The static example of the paper with three-node beams: the belt released from its pulleys becomes a polygon."""

    LINKS = (30, 60, 120)

    def radii(self, system: System, state: State) -> FloatArray:
        place = points(system, state)
        return np.asarray(np.linalg.norm(place - place.mean(axis=0), axis=1))

    @pytest.mark.parametrize("links", LINKS)
    def test_regular_polygon(self, released: Callable[..., tuple[Belt, System, State]], links: int) -> None:
        """Springs of equal angles are in balance without any force in the links, whose lengths stay."""
        belt, system, state = released(links)
        expected = belt.given_length / links / (2.0 * sin(pi / links))
        np.testing.assert_allclose(self.radii(system, state), expected, rtol=1e-7)
        place = points(system, state)
        sides = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1)
        np.testing.assert_allclose(sides, belt.given_length / links, rtol=1e-9)

    @pytest.mark.parametrize("links", LINKS)
    def test_energy_is_that_of_the_circle(
        self, released: Callable[..., tuple[Belt, System, State]], measured: Measured, links: int
    ) -> None:
        """With any number of links: n (EI / 2 l) (2 pi / n)^2 = EI (2 pi / length)^2 length / 2."""
        belt, system, state = released(links)
        seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
        circle = 0.5 * belt.bending_stiffness * (2.0 * pi / belt.given_length) ** 2 * belt.given_length
        measured(error=float(seen.strain_energy[0]) / circle - 1.0)
        assert float(seen.strain_energy[0]) == pytest.approx(circle, rel=1e-9)

    def test_radius_converges_to_that_of_the_circle(
        self, released: Callable[..., tuple[Belt, System, State]], order: Order, measured: Measured
    ) -> None:
        errors = []
        for links in self.LINKS:
            belt, system, state = released(links)
            errors.append(float(np.mean(self.radii(system, state))) * 2.0 * pi / belt.given_length - 1.0)
        fitted = order(self.LINKS, errors)
        measured(**{f"error_{n}": error for n, error in zip(self.LINKS, errors, strict=True)}, order=fitted)
        assert fitted == pytest.approx(2.0, abs=0.01)


@pytest.fixture(scope="module")
def tension(drive: Drive) -> Callable[..., float]:
    def at_rest_on_pulleys(elements: int, kind: str = "ancf", sampling: str = "distributed") -> float:
        belt = drive.belt.replace(discretization=kind, elements=elements)
        resting = drive.replace(belt=belt, contact=drive.contact.replace(sampling=sampling))
        system = drive_system(prepare(resting))
        state = find_equilibrium(system, laid(system, drive.path)).state
        seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
        return float(np.mean(seen.belt_tension))

    return at_rest_on_pulleys


@pytest.fixture(scope="module")
def converged(tension: Callable[..., float]) -> float:
    """240 elements of the paper."""
    return tension(240)


class TestInstalledBelt:
    """Tension of the belt on its pulleys at rest.

    A link covers the angle phi of a pulley.  With contact at nodes the nodes lie as deep as the belt should, and an arc
    is shorter by the part phi^2 / 24; with contact all along the links these lie as deep in their mean, and the arc is
    longer by the same part.  The belt's strain is off by that times the part of the belt that lies on pulleys, and its
    tension by E A times that, less what the penalty contact yields.  The limits are those of other models of bending,
    by which a tension differs by the size of E I / R^2.
    """

    LINKS = (480, 960, 1920)

    @pytest.mark.parametrize("kind", LINKS_OF)
    @pytest.mark.parametrize(("sampling", "side"), [("nodal", -1.0), ("distributed", 1.0)])
    def test_converges_to_the_papers_element(
        self,
        drive: Drive,
        tension: Callable[..., float],
        converged: float,
        measured: Measured,
        kind: str,
        sampling: str,
        side: float,
    ) -> None:
        found = np.array([tension(links // LINKS_OF[kind], kind, sampling) for links in self.LINKS])
        coarse, fine = np.diff(found)
        limit = found[-1] + fine / 3.0
        radius, wrap = drive.pulleys[0].radius, sum(drive.path.wrap_angles)
        angles = drive.belt_length / (radius * np.array(self.LINKS))
        predicted = side * drive.belt.axial_stiffness * wrap * radius / drive.path.length * angles**2 / 24.0
        fitted = float(np.log2(coarse / fine))
        measured(order=fitted, limit=limit / converged - 1.0, over_prediction=float((found - limit)[0] / predicted[0]))
        assert fitted == pytest.approx(2.0, abs=0.15)  # nodes come and go at the ends of the arcs
        np.testing.assert_allclose(found - limit, predicted, rtol=0.15)
        assert limit == pytest.approx(converged, abs=2.0 * drive.belt.bending_stiffness / radius**2)


class TestSpinningRing:
    """A free ring that turns at one speed: 2 T sin(pi / n) = m omega^2 r at every point, of mass m at radius r."""

    SPEED, LINKS = 60.0, (30, 60, 120)

    def spin(self, belt: Belt) -> tuple[System, State, float]:
        """Ring in steady rotation, by its stretch, and its tension."""
        links = belt.element_kind.curves * belt.given_elements
        length = belt.given_length / links
        half = sin(pi / links)

        def tension(stretch: float) -> float:
            return belt.axial_stiffness * (stretch**2 - 1.0) * stretch / 2.0

        def excess(stretch: float) -> float:
            radius = stretch * length / (2.0 * half)
            return 2.0 * tension(stretch) * half - belt.mass_per_length * length * self.SPEED**2 * radius

        stretch = float(brentq(excess, 1.0, 1.5, xtol=1e-15))
        angle = 2.0 * pi / links * np.arange(links)
        place = stretch * length / (2.0 * half) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        system = belt_system(belt, closure="shared_node")
        rest = at_rest(system, place.reshape(-1, len(system.scale)))
        around = self.SPEED * np.stack([-place[:, 1], place[:, 0]], axis=1)
        return system, State(rest.position, around.ravel(), -(self.SPEED**2) * rest.position), tension(stretch)

    @pytest.mark.parametrize("kind", LINKS_OF)
    @pytest.mark.parametrize("links", LINKS)
    def test_forces_balance(self, belt: Belt, kind: str, links: int) -> None:
        system, state, tension = self.spin(linked(belt, kind, links))
        equations = new_equations(system)
        assemble(system, state.at(0.0), no_multipliers(system), NO_TANGENT, equations)
        np.testing.assert_allclose(equations.matrix.node_side, 0.0, atol=1e-9 * tension)
        seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
        np.testing.assert_allclose(seen.belt_tension[0], tension, rtol=1e-9)

    def test_tension_converges_to_that_of_the_hoop(self, belt: Belt, order: Order, measured: Measured) -> None:
        """T = rho A (omega length / 2 pi)^2 s at stretch s, where E A (s^2 - 1) s / 2 = T."""
        hoop = belt.mass_per_length * (self.SPEED * belt.given_length / (2.0 * pi)) ** 2
        exact = hoop * (1.0 + 2.0 * hoop / belt.axial_stiffness) ** 0.5
        errors = [self.spin(linked(belt, "truss", links))[2] / exact - 1.0 for links in self.LINKS]
        fitted = order(self.LINKS, errors)
        measured(**{f"error_{n}": error for n, error in zip(self.LINKS, errors, strict=True)}, order=fitted)
        assert fitted == pytest.approx(2.0, abs=0.02)
        assert errors[-1] == pytest.approx((pi / self.LINKS[-1]) ** 2 / 3.0, rel=0.1)  # of 1 / sin(pi / n)^2
