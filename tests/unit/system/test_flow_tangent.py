"""A belt that flows through a mesh at a speed that changes: tangent, inertia, and what is known of its motion."""

from collections.abc import Callable
from math import comb

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyder, polyint, polymul, polyval

from beltdyn.arrays import FloatArray
from beltdyn.elements.quintic import QUINTIC
from beltdyn.kernel import interpreted
from beltdyn.model import Drive, Path, prepare
from beltdyn.model.resolution import Laid
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import NO_TANGENT, Equations, System, TangentFactors
from beltdyn.system.build import belt_system, flowing_system, staying_system
from beltdyn.system.frame import Travelling, staying
from beltdyn.system.missed_action import numerical_loss
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State, at_rest, nodal_coordinates, point_coordinates
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

SPEED, PULL = 3.0, 40.0
FACTORS = TangentFactors(1.0, 7e2, 4e5)


def residual(system: System, state: State, equations: Equations, factors: TangentFactors = NO_TANGENT) -> FloatArray:
    interpreted(assemble)(system, state.at(0.3), no_multipliers(system), factors, equations)
    return np.concatenate([equations.matrix.node_side.ravel(), equations.matrix.border_side])


@pytest.fixture
def ring(drive: Drive) -> System:
    """A belt without pulleys on elements of unequal lengths."""
    return ring_of(drive)


def ring_of(drive: Drive, **losses: float) -> System:
    belt = drive.belt.replace(discretization="quintic", elements=9, quadrature_points=8, **losses)
    lengths = np.linspace(1.0, 2.0, 9)
    given = belt_system(belt, closure="shared_node", lengths=belt.given_length * lengths / lengths.sum())
    mesh = given._replace(frame=staying(given.control, given.length, belt.mass_per_length))
    return flowing_system(mesh, np.array([0.6, 0.8]))


@pytest.mark.parametrize(
    ("tensioner", "law", "losses", "factors"),
    [
        ("sliding", "force_slope", "lossless", FACTORS),
        ("sliding", "force_slope", "lossless", TangentFactors(0.0, 7e2, 0.0)),
        ("rotary", "relative_creep", "damping", FACTORS),
        ("sliding", "force_slope", "hysteresis", FACTORS),
        pytest.param("rotary", "force_slope", "lossless", FACTORS, marks=pytest.mark.slow),
        pytest.param("sliding", "relative_creep", "damping", FACTORS, marks=pytest.mark.slow),
        pytest.param("rotary", "force_slope", "hysteresis", FACTORS, marks=pytest.mark.slow),
    ],
)
def test_tangent(
    with_machines: Callable[..., Drive], tensioner: str, law: str, losses: str, factors: TangentFactors
) -> None:
    """Along any direction of all unknowns, which move position, velocity and acceleration, by central differences."""
    drive = with_machines(tensioner, losses)
    if law == "relative_creep":
        contact = drive.contact.model_dump(exclude_none=True) | {"friction_law": law, "creep_ratio": 0.15}
        contact.pop("creep_rate_factor")
        drive = drive.replace(contact=contact)
    mesh = staying_system(prepare(drive), np.full(16, drive.belt_length / 16))
    system, random = flowing_system(mesh, np.array([0.6, 0.8])), np.random.default_rng(5)
    drawn_in = Path(drive.path.centers, drive.path.radii - 1e-3 * np.sign(drive.path.radii))
    state = laid_state(Laid.on(drawn_in, drive.belt_length, 0), system, np.array([2e-3]))
    nodes, place = system.first_body, system.frame.place
    state.position[:nodes] += 2e-4 * random.normal(size=nodes)
    state.velocity[:nodes] = 1e-2 * random.normal(size=nodes)
    state.acceleration[:] = random.normal(size=state.position.size)
    state.velocity[nodes:place] = SPEED / 0.08 * (1.0 + 0.02 * random.normal(size=place - nodes))
    state.velocity[place], state.velocity[place + 1], state.acceleration[place] = SPEED, 5.0, PULL
    equations = new_equations(system)
    residual(system, state, equations, factors)
    size = nodes + equations.border_part.size
    tangent = np.zeros((size, size))
    np.add.at(tangent, places(equations.matrix), entries(equations.matrix))

    def at(change: FloatArray) -> FloatArray:
        step = np.zeros_like(state.position)
        step[:nodes] = change[:nodes]
        free = system.bodies.unknown >= 0
        step[nodes:][free] = change[nodes + system.bodies.unknown[free]]
        vectors = (state.position, state.velocity, state.acceleration)
        moved = State(*(vector + factor * step for vector, factor in zip(vectors, factors[:3], strict=True)))
        return residual(system, moved, equations)

    scale = np.concatenate([np.tile([1.0, 1.0, 10.0, 10.0, 100.0, 100.0], system.nodes), np.ones(size)])[:size]
    for _ in range(3):
        way = 1e-9 * scale * random.normal(size=size)
        difference = 0.5 * (at(way) - at(-way))
        np.testing.assert_allclose(tangent @ way, difference, rtol=2e-4, atol=2e-6 * np.abs(difference).max())


def hoop(ring: System) -> FloatArray:
    """Coordinates of a belt without pulleys that is stretched to a circle, shape (6 N,)."""
    radius = float(ring.length.sum()) / (2.0 * np.pi)
    angle = point_coordinates(ring) / radius
    out, tangent = np.stack([np.cos(angle), np.sin(angle)], 1), np.stack([-np.sin(angle), np.cos(angle)], 1)
    return nodal_coordinates(ring, radius * out, 1.001 * tangent, -1.001 / radius * out).ravel()


@pytest.mark.parametrize("factors", [(1.0, 0.0), (1.0, 50.0)])
def test_damping_of_a_belt_that_travels_with_its_mesh_has_no_flow(drive: Drive, factors: tuple[float, float]) -> None:
    """By central differences along all coordinates."""
    ring, random = ring_of(drive, stretch_damping_time=1e-2, bending_damping_time=1e-1), np.random.default_rng(9)
    system = ring._replace(frame=Travelling(), bodies=ring.bodies[:0].view(np.recarray))
    position, size = hoop(ring), ring.first_body
    velocity, equations = 0.1 * random.normal(size=size), new_equations(system)

    def at(step: FloatArray) -> FloatArray:
        state = State(position + factors[0] * step, velocity + factors[1] * step, np.zeros(size))
        return residual(system, state, equations)

    residual(system, State(position, velocity, np.zeros(size)), equations, TangentFactors(*factors, 0.0))
    tangent = np.zeros((size, size))
    np.add.at(tangent, places(equations.matrix), entries(equations.matrix))
    step = 1e-7 * random.normal(size=size) * np.tile([1.0, 1.0, 10.0, 10.0, 100.0, 100.0], system.nodes)
    difference = 0.5 * (at(step) - at(-step))
    np.testing.assert_allclose(tangent @ step, difference, rtol=1e-5, atol=1e-7 * np.abs(difference).max())


@pytest.mark.parametrize(
    "losses", [{"stretch_loss_factor": 0.2}, {"bending_loss_factor": 0.3}], ids=["stretch", "bend"]
)
def test_losses_of_the_material_change_with_the_flow(drive: Drive, losses: dict[str, float]) -> None:
    """By central differences, without those of a belt that loses nothing: of stretch and of bending each alone."""
    systems, random = [ring_of(drive, **each) for each in (losses, {})], np.random.default_rng(8)
    size = systems[0].first_body + 1
    position = np.append(hoop(systems[0]), 0.0) + 1e-3 * random.normal(size=size)
    velocity = np.append(0.01 * random.normal(size=size - 1), SPEED)
    columns, differences, step = [], [], 1e-3
    for system in systems:
        equations, sides = new_equations(system), []
        residual(system, State(position, velocity, np.zeros(size)), equations, TangentFactors(0.0, 1.0, 0.0))
        columns.append(equations.matrix.column[:, :, -1].ravel().copy())
        for sense in (step, -step):
            moved = velocity + sense * np.eye(size)[-1]
            sides.append(residual(system, State(position, moved, np.zeros(size)), equations)[: size - 1])
        differences.append((sides[0] - sides[1]) / (2.0 * step))
    found, expected = (np.subtract(*each) for each in (columns, differences))
    assert np.abs(expected).max() > 0.0
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())


def test_inertia_is_that_of_material_points(ring: System) -> None:
    """Integral of rho A S (d2r/dt2 + 2 c d2r/dt dx + dc/dt dr/dx + c^2 d2r/dx2), of polynomials in each element."""
    random, size = np.random.default_rng(2), ring.first_body + 1
    state = State(random.normal(size=size), random.normal(size=size), random.normal(size=size))
    still = State(state.position, np.zeros(size), np.zeros(size))
    equations = new_equations(ring)
    found = residual(ring, state, equations) - residual(ring, still, equations)
    speed, change = state.velocity[-1], state.acceleration[-1]
    expected = np.zeros((ring.nodes, 6))
    for element, length in enumerate(ring.length):
        both = [element, (element + 1) % ring.nodes]
        control = QUINTIC.control(length)[0]
        x = Polynomial([0.0, 1.0 / length])
        shapes = control.T @ np.array([(comb(5, k) * x**k * (1.0 - x) ** (5 - k)).coef for k in range(6)])
        for axis in range(2):
            r, v, a = (
                vector[:-1].reshape(-1, 6)[both].reshape(6, 2)[:, axis] @ shapes
                for vector in (state.position, state.velocity, state.acceleration)
            )
            total = a.copy()
            total[:5] += 2.0 * speed * polyder(v) + change * polyder(r)
            total[:4] += speed**2 * polyder(r, 2)
            for k, one in enumerate(shapes):
                force = ring.element.section.mass * polyval(length, polyint(polymul(one, total)))
                expected[both[k // 3], 2 * (k % 3) + axis] += force
    np.testing.assert_allclose(found[:-1], expected.ravel(), atol=1e-9 * np.abs(expected).max())
    assert found[-1] == pytest.approx(ring.frame.direction @ state.acceleration[:2])


def test_without_flow_it_is_the_travelling_form(ring: System) -> None:
    random, size = np.random.default_rng(4), ring.first_body + 1
    state = State(random.normal(size=size), random.normal(size=size), random.normal(size=size))
    state.velocity[-1] = state.acceleration[-1] = 0.0
    travelling = ring._replace(frame=Travelling(), bodies=ring.bodies[:0].view(np.recarray))
    nodes = State(state.position[:-1], state.velocity[:-1], state.acceleration[:-1])
    found, known = (residual(one, at, new_equations(one)) for one, at in ((ring, state), (travelling, nodes)))
    np.testing.assert_allclose(found[:-1], known, rtol=1e-12, atol=1e-9 * np.abs(known).max())


def test_a_hoop_that_spins_is_in_balance(drive: Drive) -> None:
    """EA (G - 1) / 2 = m c^2, G the squared stretch; and it takes m dc/dt a meter along the belt to spin it up."""
    belt = drive.belt.replace(discretization="quintic", elements=16, quadrature_points=8, bending_factor=1e-9)
    given = belt_system(belt, closure="shared_node")
    system = flowing_system(
        given._replace(frame=staying(given.control, given.length, belt.mass_per_length)), np.eye(2)[0]
    )
    force = belt.mass_per_length * 20.0**2
    stretch = np.sqrt(1.0 + 2.0 * force / belt.axial_stiffness)
    radius = stretch * belt.given_length / (2.0 * np.pi)
    angle = 2.0 * np.pi * point_coordinates(system) / belt.given_length
    out, along = np.stack([np.cos(angle), np.sin(angle)], 1), np.stack([-np.sin(angle), np.cos(angle)], 1)
    state = at_rest(system, nodal_coordinates(system, radius * out, stretch * along, -(stretch**2) / radius * out))
    equations = new_equations(system)
    state.velocity[-1] = 20.0
    np.testing.assert_allclose(residual(system, state, equations), 0.0, atol=1e-5 * force)
    state.acceleration[-1] = 50.0
    turning = nodal_coordinates(system, along, -stretch / radius * out, -((stretch / radius) ** 2) * along)
    pull = residual(system, state, equations)[:-1] @ turning.ravel()
    assert pull == pytest.approx(belt.mass_per_length * 50.0 * stretch * belt.given_length, rel=1e-5)


def test_inertia_does_the_change_of_the_kinetic_energy(ring: System) -> None:
    """What is left between them falls with the third power of the step: the trapezoidal rule for its power."""
    random, size = np.random.default_rng(7), ring.first_body + 1
    position, velocity, acceleration = (random.normal(size=size) for _ in range(3))
    losses = []
    for step in (1e-3, 5e-4):
        later = State(
            position + step * velocity + 0.5 * step**2 * acceleration, velocity + step * acceleration, acceleration
        )
        before, work = State(position, velocity, acceleration), new_equations(ring).work
        losses.append(interpreted(numerical_loss)(ring, before.at(0.0), later.at(step), np.zeros((2, size)), work))
    assert losses[0] / losses[1] == pytest.approx(8.0, rel=0.05)
