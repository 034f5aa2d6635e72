"""Small drives in every combination of laws, random states of them in real contact, and dense matrices."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, prepare
from beltdyn.system.arrays import RingMatrix, System
from beltdyn.system.build import drive_system
from beltdyn.system.state import State, laid

FRICTION: dict[str, dict[str, Any]] = {
    "force_slope": {"friction_law": "force_slope", "creep_rate_factor": 300.0},
    "coefficient_slope": {"friction_law": "coefficient_slope", "creep_velocity": 0.05},
    "relative_creep": {"friction_law": "relative_creep", "creep_ratio": 0.05, "standstill_creep": 0.01},
}
CONTACT = {"stiffness": 1e7, "damping": 10.0, "friction": 1.2, "moment_arm": "point"}
PLACES: dict[str, dict[str, Any]] = {
    "zone": {"integration": "zone"},
    "fixed": {"integration": "fixed"},
    "nodal": {"sampling": "nodal"},
}
ELEMENTS = {"ancf": 10, "truss": 30, "three-node-beam": 15}
VARIANTS = [
    *product(FRICTION, ["zone", "fixed"], ["shared_node", "multipliers"], ["ancf"]),
    ("force_slope", "nodal", "shared_node", "ancf"),
    *product(["force_slope"], ["zone", "nodal"], ["shared_node"], ["truss", "three-node-beam"]),
]
COMPILED_ALONE = {"truss", "three-node-beam", "coefficient_slope"}
"""Kinds that no other quick test compiles."""

COMMON: dict[str, Any] = {
    "pulley": "idler",
    "tensioning_friction": 3.0,
    "yielding_friction": 5.0,
    "stops": (-1e-4, 0.3),
    "stop_stiffness": 1e4,
    "stop_damping": 10.0,
}
ROTARY = COMMON | {
    "kind": "rotary",
    "pivot": (0.35, 0.05),
    "inertia": 0.01,
    "mass": 0.4,
    "preload": 4.0,
    "rate": 20.0,
    "damping": 0.5,
}
SLIDING = COMMON | {
    "kind": "sliding",
    "direction": (0.2, -1.0),
    "mass": 1.5,
    "preload": 30.0,
    "rate": 500.0,
    "damping": 5.0,
}


LOSSES: dict[str, dict[str, float]] = {
    "lossless": {},
    "damping": {"stretch_damping_time": 1e-5, "bending_damping_time": 1e-2},
    "hysteresis": {"stretch_loss_factor": 0.1, "bending_loss_factor": 0.3},
}
"""Of the belt's material."""


@pytest.fixture(scope="session")
def with_machines(drive: Drive) -> Callable[..., Drive]:
    """The paper's drive with an idler on a tensioner, a hub chain behind the driven pulley, and loads on its end."""

    def make(tensioner: str, losses: str = "lossless") -> Drive:
        data = drive.model_dump(by_alias=True, exclude_none=True)
        data["belt"] |= {"length": 1.2965, "elements": 12} | LOSSES[losses]
        data["contact"] = CONTACT | FRICTION["force_slope"]
        driver, driven = data["pulley"]
        driven |= {
            "torque": {"kind": "constant", "value": -1.0},
            "load": [
                {
                    "kind": "resistance",
                    "constant": 1.0,
                    "creep_speed": 0.5,
                    "quadratic": 0.03,
                    "harmonics": [{"order": 2, "amplitude": 0.3, "phase": 0.4}],
                },
            ],
            "hub": [
                {"kind": "one_way_clutch", "locking_damping": 20.0, "drag_torque": 1.0, "inertia": 0.05},
                {"kind": "isolator", "stiffness": 50.0, "damping": 0.3, "inertia": 0.1},
            ],
        }
        middle = 0.5 * (driver["center"][0] + driven["center"][0])
        idler = {"name": "idler", "center": (middle, -0.2), "radius": 0.04, "inertia": 1e-3, "mass": 0.3}
        data["pulley"] = [driver, idler, driven] if driver["center"][0] < middle else [driver, driven, idler]
        data["tensioner"] = [{"rotary": ROTARY, "sliding": SLIDING}[tensioner]]
        data["gravity"] = (0.0, -9.81)
        return Drive(**data)

    return make


@pytest.fixture(scope="session")
def make_drive(drive: Drive) -> Callable[..., Drive]:
    """The paper's drive with ten elements, or as many groups of links, and chosen laws and places of contact."""

    def make(friction: str, places: str, joint: str = "shared_node", discretization: str = "ancf") -> Drive:
        data = drive.model_dump(by_alias=True, exclude_none=True)
        data["belt"] |= {"discretization": discretization, "elements": ELEMENTS[discretization]}
        data["contact"] = CONTACT | FRICTION[friction] | PLACES[places]
        data["simulation"]["joint"] = joint
        return Drive(**data)

    return make


@pytest.fixture(
    scope="session",
    params=[pytest.param(one, marks=[pytest.mark.slow] * bool(COMPILED_ALONE & {*one})) for one in VARIANTS],
    ids="-".join,
)
def small(request: pytest.FixtureRequest, make_drive: Callable[..., Drive]) -> Drive:
    return make_drive(*request.param)


@pytest.fixture(scope="session")
def system(small: Drive) -> System:
    return drive_system(prepare(small))


@pytest.fixture(scope="session")
def scale(system: System) -> FloatArray:
    """Coordinates that make a meter, shape (6 N + D,)."""
    return np.concatenate([np.tile(1.0 / np.array(system.scale), system.nodes), 1.0 / system.bodies.reach])


@pytest.fixture(scope="session")
def moving(system: System, scale: FloatArray) -> State:
    """A deformed belt in contact: laid 0.1 mm deep in its pulleys, disturbed by 0.3 mm, 0.1 m/s and 10 m/s^2."""
    rest = laid(system, Path(system.pulleys.center, system.pulleys.radius - 1e-4)).position
    noise = np.random.default_rng(1).normal(size=(3, rest.size)) * scale
    return State(rest + 3e-4 * noise[0], 0.1 * noise[1], 10.0 * noise[2])


@pytest.fixture(scope="session")
def dense() -> Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]]:
    """Matrix and right-hand side of a ring matrix, the nodes first."""

    def unfold(ring: RingMatrix, closed: bool) -> tuple[FloatArray, FloatArray]:
        (nodes, dof), size = ring.node_side.shape, ring.node_side.size
        matrix = np.zeros((size + ring.border_side.size,) * 2)
        for k in range(nodes):
            own = slice(dof * k, dof * (k + 1))
            matrix[own, own] += ring.diagonal[k]
            matrix[own, size:], matrix[size:, own] = ring.column[k], ring.row[k]
            if closed or k < nodes - 1:
                after = slice(dof * ((k + 1) % nodes), dof * ((k + 1) % nodes) + dof)
                matrix[own, after] += ring.upper[k]
                matrix[after, own] += ring.lower[k]
        matrix[size:, size:] = ring.corner
        return matrix, np.concatenate([ring.node_side.ravel(), ring.border_side])

    return unfold
