"""Verified: slip on small pulleys, light loads and lossy belts, against the equations of a rod without any element.

A belt of length L runs along a fixed curve with the transport speed c.  Of the angle theta of its tangent t, stretch g,
rate of turning k = theta', moment M and the force F in it, less its momentum, P = F - m c^2 r',

    r' = g t,    P' = -f,    M' = -g n . P,    N(g) + 3/2 EI g k^2 + H k = t . P + m c^2 g,
    M = EI (3 g^2 - 1) / 2 k + E I4 / 2 k^3 + g H,

with the moment H of hysteresis and the force f of contact, friction and rolling resistance.  They are solved by
staggered differences on cells of 0.05 mm at the ends of the arcs: forces and angles in cells, places and moments at
nodes.  Derivatives are by complex steps.  Nothing of the package takes part but the numbers of the drive.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

import beltdyn as bd
from beltdyn.model import Constant, Drive, prepare
from beltdyn.model.hysteresis import bending_at_points, rolling_resistances
from beltdyn.results import Run, summarize

Array = np.ndarray[Any, np.dtype[Any]]

DRIVE = """
[belt]
profile = "PJ-elastic"
ribs = 5
installed_tension = "160 N"

[[pulley]]
name = "motor"
center = [0.1, 0.0]
radius = "8.5 mm"
speed = { kind = "constant", value = 800.0 }

[[pulley]]
name = "drum"
center = [0.0, 0.0]
radius = "40 mm"
inertia = 5e-4
torque = { kind = "constant", value = -0.36 }

[contact]
friction = 0.4

[simulation]
duration = 0.11
output_interval = 2e-4
start = "steady"
frame = "staying"
"""
LIGHT = {"pulley[drum].torque.value": -0.07}
LOSSLESS = {"belt.bending_loss_factor": 0.0}
LOSSY = {"belt.bending_loss_factor": 0.3}
LARGER = {"pulley[motor].radius": "20 mm"}
HARD_FRICTION = {"contact.creep_ratio": 0.0015, "contact.standstill_creep": 0.0006}

_FIELDS, _REACH = 6, 2
_X, _Y, _ANGLE, _STRETCH, _PX, _PY = range(_FIELDS)


@dataclass(frozen=True)
class Rod:
    """A belt on two pulleys: the first, the driver, at the origin, the other at (distance, 0); counter-clockwise."""

    distance: float
    radii: tuple[float, float]
    length: float
    axial: float
    bending: float
    quartic: float
    mass: float
    friction: float
    creep_ratio: float
    standstill_creep: float
    stiffness: float
    damping: float
    rolling: tuple[float, float]
    modulus: float
    smoothed: float
    speed: float
    torque: float


def rod_of(drive: Drive) -> Rod:
    contact, belt, hysteresis = drive.completed.contact, drive.belt, bending_at_points(prepare(drive))
    speed, torque = drive.pulleys[0].speed, drive.pulleys[1].torque
    assert isinstance(speed, Constant)
    assert isinstance(torque, Constant)
    assert contact.stiffness is not None
    assert contact.damping is not None
    assert contact.creep_ratio is not None
    assert contact.standstill_creep is not None
    assert belt.stretch_law == "linear"
    rolling = rolling_resistances(prepare(drive))
    return Rod(
        distance=float(np.hypot(*(drive.centers[1] - drive.centers[0]))),
        radii=(float(drive.radii[0]), float(drive.radii[1])),
        length=drive.belt_length,
        axial=belt.axial_stiffness,
        bending=belt.bending_stiffness,
        quartic=belt.youngs_modulus * belt.fourth_moment * belt.bending_factor,
        mass=belt.mass_per_length,
        friction=float(drive.frictions[0]),
        creep_ratio=contact.creep_ratio,
        standstill_creep=contact.standstill_creep,
        stiffness=contact.stiffness,
        damping=contact.damping,
        rolling=(float(rolling[0]), float(rolling[1])),
        modulus=hysteresis.modulus,
        smoothed=hysteresis.length,
        speed=speed.value,
        torque=-torque.value,
    )


class SteadyRod:
    """Steady running of a rod, from a belt laid on pulleys that give way."""

    def __init__(self, rod: Rod, shortest: float) -> None:
        self.rod = rod
        softness = 0.03
        tilt = np.arcsin((rod.radii[0] - rod.radii[1]) / rod.distance)
        span, wraps = rod.distance * np.cos(tilt), (np.pi + 2 * tilt, np.pi - 2 * tilt)
        pull = rod.axial * ((2 * span + np.dot(wraps, rod.radii)) / rod.length - 1.0)
        first, second = (radius - pull / (radius * rod.stiffness * softness) for radius in rod.radii)
        tilt = np.arcsin((first - second) / rod.distance)
        span, wraps = rod.distance * np.cos(tilt), (np.pi + 2 * tilt, np.pi - 2 * tilt)
        marks = np.cumsum([0.0, span / 2, second * wraps[1], span, first * wraps[0], span / 2])
        turned = tilt + np.cumsum([0.0, 0.0, wraps[1], 0.0, wraps[0], 0.0])
        fine = np.linspace(0.0, marks[-1], 200_001)
        off = np.min(np.abs(fine[:, None] - marks[1:-1]), axis=1)
        density = 1.0 / np.minimum(shortest + 0.06 * np.maximum(off - 0.0015, 0.0), 0.02)
        count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
        self.n = int(count[-1]) + 1
        nodes = np.interp(np.linspace(0.0, count[-1], self.n + 1), count, fine)
        stretch = marks[-1] / rod.length
        self.cell = np.diff(nodes) / stretch
        self.before = np.roll(self.cell, 1)
        self.width = 0.5 * (self.cell + self.before)
        self.share = self.cell / (self.cell + self.before)
        angle = np.interp(0.5 * (nodes[1:] + nodes[:-1]), marks, turned)
        along = np.array([np.cos(tilt), np.sin(tilt)])
        inward = np.array([-along[1], along[0]])
        self.along, self.start = along, 0.5 * (np.array([rod.distance, 0.0]) - (first + second) * inward)
        direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        places = self.start + np.cumsum(np.diff(nodes)[:, None] * direction, axis=0)
        transport = rod.speed * first / stretch
        force = rod.axial * (stretch - 1.0) - rod.mass * transport**2 * stretch
        self.fields = np.hstack(
            [
                np.vstack([self.start, places[:-1]]),
                angle[:, None],
                np.full((self.n, 1), stretch),
                force * direction,
            ]
        )
        self.speeds = np.array([transport, rod.speed * first / second])  # c, and of the driven pulley
        self._solve(softness)

    def _solve(self, softness: float) -> None:
        """Harder contact, then steeper friction, then load, then hysteresis."""
        rod = self.rod
        smooth = replace(rod, creep_ratio=1.0, modulus=0.0, torque=0.05 * rod.torque)
        for soft in (softness, 0.1, 0.3, 1.0):
            self._newton(replace(smooth, stiffness=soft * rod.stiffness, damping=np.sqrt(soft) * rod.damping), 1e-5)
        for creep in (0.3, 0.1, 0.03, 0.01, 0.005, 0.0025):
            if creep > rod.creep_ratio:
                self._newton(replace(smooth, creep_ratio=creep), 1e-5)
        for part in (0.1, 0.4, 0.7, 1.0):
            self._newton(replace(rod, modulus=0.0, torque=part * rod.torque), 1e-5)
        for part in (0.1, 0.5, 1.0) if rod.modulus else (1.0,):
            self._newton(replace(rod, modulus=part * rod.modulus), 1e-9 if part == 1.0 else 1e-5)

    def tension(self, stretch: Array) -> Array:
        return np.asarray(self.rod.axial * (stretch - 1.0))

    def contact(self, rod: Rod, fields: Array, speeds: Array) -> tuple[Array, list[Array]]:
        """Force on the belt at the nodes, N/m, and the moment of each node on each pulley, N m."""
        flow = fields[:, _STRETCH, None] * np.stack([np.cos(fields[:, _ANGLE]), np.sin(fields[:, _ANGLE])], axis=1)
        share = self.share[:, None]
        velocity = speeds[0] * (np.roll(flow, 1, axis=0) * share + flow * (1.0 - share))
        force, moments = np.zeros_like(fields[:, :2]), []
        for radius, x, turning, rolling in zip(
            rod.radii, (0.0, rod.distance), (rod.speed, speeds[1]), rod.rolling, strict=True
        ):
            out = fields[:, :2] - np.array([x, 0.0])
            normal = out / np.sqrt(out[:, 0] ** 2 + out[:, 1] ** 2)[:, None]
            depth, rate = radius - np.sum(normal * out, axis=1), -np.sum(normal * velocity, axis=1)
            reach = rate / speeds[0] * self.width  # by how much the depth changes within the width of a node
            reach = np.where(reach.real >= 0.0, reach, -reach) + 1e-12
            part = 0.5 + depth / reach  # of that width, the part that touches
            part = np.where(part.real > 1.0, 1.0, np.where(part.real < 0.0, 0.0, part))
            pressed = rod.stiffness * np.where(part.real < 1.0, 0.5 * part * reach, depth) + rod.damping * rate
            pressed = np.where(pressed.real > 0.0, part * pressed, 0.0)
            passing = normal[:, 0] * velocity[:, 1] - normal[:, 1] * velocity[:, 0]
            used = (passing - radius * turning) / np.sqrt(
                (rod.creep_ratio * radius * turning) ** 2 + rod.standstill_creep**2
            )
            used = np.where(used.real > 1.0, 1.0, np.where(used.real < -1.0, -1.0, used))
            friction = -rod.friction * pressed * used
            moments.append(-radius * friction * self.width)
            friction = friction - rolling * pressed * passing / np.sqrt(passing * passing + 1e-4)
            force[:, 0] += pressed * normal[:, 0] - friction * normal[:, 1]
            force[:, 1] += pressed * normal[:, 1] + friction * normal[:, 0]
        return force, moments

    def section(self, rod: Rod, fields: Array, speeds: Array) -> tuple[Array, Array]:
        """Moment at the nodes, N m, and force along the tangent in the cells, N."""
        angle, stretch = fields[:, _ANGLE], fields[:, _STRETCH]
        past = np.roll(angle, 1)
        past[0] -= 2.0 * np.pi
        g, turning = np.roll(stretch, 1) * self.share + stretch * (1.0 - self.share), (angle - past) / self.width
        held: Array = np.zeros_like(turning)
        if rod.modulus:
            curvature = g * turning
            rate = speeds[0] * (np.roll(curvature, -1) - np.roll(curvature, 1)) / (self.cell + self.before)
            slow = ((speeds[0] * g) ** 2 + 0.01) / rod.smoothed**2
            size = np.where(curvature.real >= 0.0, curvature, -curvature)
            held = rod.modulus * size * rate / np.sqrt(rate * rate + slow * curvature * curvature + 1e-12)
        moment = rod.bending * (1.5 * g * g - 0.5) * turning + 0.5 * rod.quartic * turning**3 + g * held

        def mean(values: Array) -> Array:
            return np.asarray(0.5 * (values + np.roll(values, -1)))

        along = self.tension(stretch) + 1.5 * rod.bending * stretch * mean(turning * turning) + mean(held * turning)
        return moment, along

    def residual(self, rod: Rod, fields: Array, speeds: Array) -> tuple[Array, Array]:
        """The equations, and place of node 0 and torque."""
        force, moments = self.contact(rod, fields, speeds)
        moment, along = self.section(rod, fields, speeds)
        place, g, pull = fields[:, :2], fields[:, _STRETCH], fields[:, _PX:]
        tangent = np.stack([np.cos(fields[:, _ANGLE]), np.sin(fields[:, _ANGLE])], axis=1)
        across = -pull[:, 0] * tangent[:, 1] + pull[:, 1] * tangent[:, 0]
        result = np.empty_like(fields)
        result[:, :2] = 1e3 * (np.roll(place, -1, axis=0) - place - (self.cell * g)[:, None] * tangent)
        result[:, 2:4] = pull - np.roll(pull, 1, axis=0) + self.width[:, None] * force
        result[:, 4] = 1e3 * (np.roll(moment, -1) - moment + self.cell * g * across)
        result[:, 5] = along - np.sum(pull * tangent, axis=1) - rod.mass * speeds[0] ** 2 * g
        torque = (np.sum(moments[1]) - rod.torque) / rod.radii[1]
        return result.ravel(), np.array([1e3 * self.along @ (place[0] - self.start), torque])

    def _tangent(self, rod: Rod, fields: Array, speeds: Array) -> csc_matrix:
        n, size, step = self.n, self.n * _FIELDS, 1e-30
        stride, number = 2 * _REACH + 1, np.arange(self.n)
        even = n - n % stride
        groups = [number[:even][number[:even] % stride == k] for k in range(stride)] + [
            number[[k]] for k in range(even, n)
        ]
        rows: list[Array] = []
        columns: list[Array] = []
        values: list[Array] = []

        def put(row: Array, column: Array, value: Array) -> None:
            row, column, value = np.broadcast_arrays(row, column, value)
            some = value.ravel() != 0.0
            for places, kept in ((rows, row), (columns, column), (values, value)):
                places.append(kept.ravel()[some])

        for field in range(_FIELDS):
            for group in groups:
                moved = fields.astype(complex)
                moved[group, field] += 1j * step
                change = self.residual(rod, moved, speeds.astype(complex))[0].imag.reshape(n, _FIELDS) / step
                torque = self.contact(rod, moved, speeds.astype(complex))[1][1].imag / step / rod.radii[1]
                column = group * _FIELDS + field
                for shift in range(-_REACH, _REACH + 1):
                    near = (group + shift) % n
                    put(near[:, None] * _FIELDS + np.arange(_FIELDS), column[:, None], change[near])
                    put(np.full(group.size, size + 1), column, torque[near])
        put(np.full(2, size), np.array([_X, _Y]), 1e3 * self.along)
        for k in range(2):
            moved = speeds.astype(complex)
            moved[k] += 1j * step
            change, ends = self.residual(rod, fields.astype(complex), moved)
            put(np.arange(size), np.array(size + k), change.imag / step)
            put(size + np.arange(2), np.array(size + k), ends.imag / step)
        shape = (size + 2, size + 2)
        return csc_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape)

    def _newton(self, rod: Rod, tolerance: float) -> None:
        each = np.array([rod.radii[0], rod.radii[0], 1.0, 0.01, 0.01 * rod.axial, 0.01 * rod.axial])
        scale = np.concatenate([np.tile(each, self.n) * np.sqrt(self.n), np.abs(self.speeds)])
        cycles = 12
        for _ in range(60):
            solver = splu(self._tangent(rod, self.fields, self.speeds))
            step = solver.solve(np.concatenate(self.residual(rod, self.fields, self.speeds)))
            size, damped = np.linalg.norm(step / scale), 1.0
            while True:
                fields = self.fields - damped * step[:-2].reshape(self.n, _FIELDS)
                speeds = self.speeds - damped * step[-2:]
                rest = np.linalg.norm(solver.solve(np.concatenate(self.residual(rod, fields, speeds))) / scale)
                if rest <= (1.0 - 0.25 * damped) * size or rest < tolerance:
                    break
                damped *= 0.5
                if damped < 0.1 and size < 1e-3 and cycles:  # a node enters or leaves the arc
                    cycles -= 1
                    break
                assert damped > 1e-4, f"no step of Newton's method with {rod}"
            self.fields, self.speeds = fields, speeds
            if rest < tolerance:
                return
        raise AssertionError(f"no steady running of {rod}")

    def slip(self, rolling: Array) -> float:
        """Loss of speed of the driven pulley against the driver, at the radii on which a belt without tension rolls."""
        return float(1.0 - self.speeds[1] * rolling[1] / (self.rod.speed * rolling[0]))

    def driver_torque(self) -> float:
        return float(-np.sum(self.contact(self.rod, self.fields, self.speeds)[1][0]))


@pytest.fixture(scope="module")
def drive() -> Drive:
    return bd.loads(DRIVE)


@pytest.fixture(scope="module")
def solved() -> Callable[[Drive], tuple[float, float]]:
    """Slip and torque of the driver with cells of 0.05 and 0.025 mm, extrapolated: the error goes by the square."""

    def solve(drive: Drive) -> tuple[float, float]:
        coarse, fine = (SteadyRod(rod_of(drive), shortest) for shortest in (5e-5, 2.5e-5))
        slips = [rod.slip(drive.rolling_radii) for rod in (coarse, fine)]
        assert slips[1] == pytest.approx(slips[0], rel=0.01, abs=5e-6)
        return slips[1] + (slips[1] - slips[0]) / 3.0, fine.driver_torque()

    return solve


def slip_and_torque(run: Run) -> tuple[float, float, float]:
    driver, driven = summarize(run).pulleys
    return driven.slip, driven.elastic_creep, driver.shaft_torque


DRIVES: dict[str, dict[str, Any]] = {
    "small pulley": {},
    "without hysteresis": LOSSLESS,
    "lossy": LOSSY,
    "light load": LIGHT,
    "larger pulley": LARGER,
    "steep friction": HARD_FRICTION,
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["small pulley", *(pytest.param(name, marks=pytest.mark.slow) for name in list(DRIVES)[1:])]
)
def test_steady_running(
    drive: Drive, solved: Callable[[Drive], tuple[float, float]], measured: Callable[..., None], name: str
) -> None:
    """Within 1 % of the slip, or 1e-5 of the speed where that is more."""
    run = bd.steady_state(drive.with_(DRIVES[name]))
    slip, elastic, torque = slip_and_torque(run)
    expected, needed = solved(run.drive)
    measured(slip=slip, independent=expected, elastic=elastic, torque=torque / needed - 1.0)
    assert slip == pytest.approx(expected, rel=0.01, abs=1e-5)
    assert torque == pytest.approx(needed, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["small pulley", "light load"])
def test_runs_on_the_mesh_that_stays(
    drive: Drive, solved: Callable[[Drive], tuple[float, float]], measured: Callable[..., None], name: str
) -> None:
    run = bd.simulate(drive.with_(DRIVES[name]))
    slip, _, torque = slip_and_torque(run)
    expected, needed = solved(run.drive)
    measured(slip=slip, independent=expected, torque=torque / needed - 1.0)
    assert slip == pytest.approx(expected, rel=0.02, abs=2e-5)
    assert torque == pytest.approx(needed, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("elements", "error"), [(97, 0.06), (140, 0.03)])
def test_runs_on_the_mesh_that_travels(
    drive: Drive,
    solved: Callable[[Drive], tuple[float, float]],
    measured: Callable[..., None],
    elements: int,
    error: float,
) -> None:
    """Without hysteresis, elements of 3.7 and 2.6 mm, 4.2 and 2.9 times the length of the layer."""
    settings = {"simulation.frame": "travelling", "simulation.rtol": 1e-5, "belt.elements": elements}
    run = bd.simulate(drive.with_(LOSSLESS | settings))
    slip, _, torque = slip_and_torque(run)
    expected, needed = solved(run.drive)
    measured(slip=slip, independent=expected, torque=torque / needed - 1.0, estimate=run.resolution.errors["slip"])
    assert slip == pytest.approx(expected, rel=error)
    assert torque == pytest.approx(needed, rel=5e-3)
