"""A belt of round numbers, drives of it with machines, and the motions about a state of rest."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive, prepare
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.first_order import FirstOrder, mass_matrix
from beltdyn.system.state import State, laid

Changes = Mapping[str, Any]

BELT = {
    "width": 0.02,
    "thickness": 0.004,
    "density": 1250.0,
    "youngs_modulus": 1.25e9,
    "poissons_ratio": 0.3,
    "bending_factor": 0.01,
    "shear_correction": 13 / 15.3,
    "elements": 60,
}
"""EA = 100 kN, EI = 1.3e-3 N m^2 and 0.1 kg/m."""
CONTACT: dict[str, Any] = {"stiffness": 3e7, "damping": 100.0, "friction": 0.6, "creep_rate_factor": 1e5}
CONTACT |= {"friction_law": "force_slope", "moment_arm": "point"}
SIMULATION = {"duration": 0.05, "output_interval": 1e-3, "rtol": 1e-4, "frame": "travelling"}


@pytest.fixture(scope="session")
def make() -> Callable[..., Drive]:
    """Make a drive from its pulleys, and changes of what it has in common with the others."""

    def drive(
        pulleys: Sequence[Changes],
        *,
        belt: Changes | None = None,
        contact: Changes | None = None,
        simulation: Changes | None = None,
        **others: Any,
    ) -> Drive:
        """Give a group the key None to remove it."""
        groups = [(BELT, belt), (CONTACT, contact), (SIMULATION, simulation)]
        merged = [
            {key: value for key, value in (given | dict(changes or {})).items() if value is not None}
            for given, changes in groups
        ]
        return Drive(belt=merged[0], pulley=list(pulleys), contact=merged[1], simulation=merged[2], **others)

    return drive


class Motion(NamedTuple):
    """Motions exp(s t) about a state of rest."""

    exponents: ComplexArray
    """s, shape (k,), 1/s."""
    shares: FloatArray
    """Part of the kinetic energy that each body has, shape (D, k)."""

    def of(self, bodies: int | Sequence[int]) -> complex:
        """The motion that belongs most of all to a body, or to several."""
        share = self.shares[np.atleast_1d(bodies)].sum(axis=0)
        return complex(self.exponents[np.argmax(share)])


@pytest.fixture(scope="session")
def at_rest() -> Callable[[Drive], tuple[System, State]]:
    """The system of a drive, and its equilibrium."""

    def find(drive: Drive) -> tuple[System, State]:
        system = drive_system(prepare(drive))
        return system, find_equilibrium(system, laid(system, drive.path)).state

    return find


@pytest.fixture(scope="session")
def motions() -> Callable[[System, State], Motion]:
    """All motions about a state of rest, with frequencies above zero, from the Jacobian of the first-order form."""

    def find(system: System, state: State) -> Motion:
        form, half = FirstOrder(system), state.position.size
        jacobian = form.jacobian(0.0, form.pack(state))[: 2 * half, : 2 * half]
        free = np.append(np.arange(system.first_body), system.first_body + np.flatnonzero(system.bodies.unknown >= 0))
        keep = np.append(free, half + free)
        exponents, vectors = np.linalg.eig(jacobian[np.ix_(keep, keep)])
        rising = exponents.imag > 0.0
        velocity = np.zeros((half, int(rising.sum())), dtype=complex)
        velocity[free] = vectors[len(free) :, rising]
        nodes = system.first_body
        belt = np.sum(velocity[:nodes].conj() * (mass_matrix(system) @ velocity[:nodes]), axis=0).real
        bodies = system.bodies.inertia[:, None] * np.abs(velocity[nodes:]) ** 2
        return Motion(exponents[rising], bodies / (belt + bodies.sum(axis=0)))

    return find


@pytest.fixture(scope="session")
def span_lines() -> Callable[[xr.Dataset], FloatArray]:
    """Directions of the spans of an output, shape (n, 2): between the first and the last free contact point."""

    def directions(output: xr.Dataset) -> FloatArray:
        touched, place = output.contact_pulley.values, output.contact_position.values
        count, found = touched.size, np.zeros((output.sizes["pulley"], 2))
        leaves = [k for k in range(count) if touched[k] >= 0 and touched[(k + 1) % count] < 0]
        for leave in leaves:
            end = leave + 1
            while touched[(end + 1) % count] < 0:
                end += 1
            quarter = (end - leave) // 4
            along = place[(end - quarter) % count] - place[(leave + 1 + quarter) % count]
            found[touched[leave]] = along / np.linalg.norm(along)
        return found

    return directions
