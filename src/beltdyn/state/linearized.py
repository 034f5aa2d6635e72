"""A drive about a state, linearized: (K + s C + s^2 M) x = 0 for small motions x exp(s t), and whether they grow.

The belt flows through a staying mesh, so that steady running is a point at rest of the equations: the forces of
Coriolis and the centrifugal forces of the moving belt are in C and K.  Speeds, torques and schedules are held.
"""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.model import Drive, Prepared
from beltdyn.solvers.eigenvalues import nearest, pencil
from beltdyn.solvers.flutter import Vibrations
from beltdyn.state.settling import with_passage
from beltdyn.system.arrays import System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build import drive_system, flowing_system, open_ended
from beltdyn.system.constant_drive import rim_of_bodies, twists
from beltdyn.system.meshing import turning
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at

if TYPE_CHECKING:
    from scipy.sparse import csc_array

DRY_FRICTION = ("tensioning_friction", "yielding_friction")
_NO_FORCE, _LITTLE_FORCE = 1e-9, 2e-2
"""Force that a free motion meets at most, over the sum of its parts: of a body that turns, and of the belt that turns
all pulleys, which roll on radii a little smaller than those of its centerline."""


_SHIFTS, _AROUND = (0.5 + 0.0j, 30.0j, 150.0j), 24
"""Where eigenvalues that grow are looked for, 1/s, and how many around each: controllers of machines are slow."""
_GROWS = 1e-6
"""Growth rate of what grows, over the magnitude of its eigenvalue."""


class SmallMotions(NamedTuple):
    """A drive about a state, linearized."""

    prepared: Prepared
    system: System
    """Its belt flows through a staying mesh."""
    state: State
    stiffness: "csc_array"
    """K, shape (n, n): nodal coordinates, free bodies, the last of which is the length of belt that has passed."""
    damping: "csc_array"
    mass: "csc_array"

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.prepared.drive

    @property
    def bodies(self) -> IntArray:
        """Places of the bodies among the unknowns, -1 of those that are prescribed; shape (D,)."""
        unknown = np.asarray(self.system.bodies.unknown)
        return np.where(unknown >= 0, self.system.first_body + unknown, -1)

    @property
    def free(self) -> FloatArray:
        """Motions that meet no force, shape (n, k): the belt flows, pulleys turn, or all of them together."""
        found = np.zeros((self.stiffness.shape[0], 0))
        parts = abs(self.stiffness)
        for motion, limit in self._turning():
            met, all_parts = np.abs(self.stiffness @ motion).sum(), (parts @ np.abs(motion)).sum()
            more = np.column_stack([found, motion])
            if met <= limit * all_parts and np.linalg.matrix_rank(more) == more.shape[1]:
                found = more
        return found

    def _turning(self) -> Iterator[tuple[FloatArray, float]]:
        """Motions that may meet no force, and how much of their parts what they meet may be then."""
        bodies, unit = self.bodies, np.eye(self.stiffness.shape[0])
        last = self.system.bodies.size - self.system.tensioners.size
        yield from ((unit[place], _NO_FORCE) for place in bodies[:last] if place >= 0)
        pulley, together = rim_of_bodies(self.system), unit[bodies[last - 1]].copy()
        for number, radius in enumerate(self.prepared.path.radii):
            chain = bodies[:last][pulley == number]
            if np.any(chain < 0):
                return
            yield unit[chain].sum(axis=0), _NO_FORCE
            together += unit[chain].sum(axis=0) * self.prepared.path.length / self.prepared.belt_length / radius
        yield together, _LITTLE_FORCE

    def with_stuck(self, tensioners: Sequence[int] | IntArray) -> "SmallMotions":
        """The same drive with tensioners that dry friction holds."""
        places = self.system.bodies.size - self.system.tensioners.size + np.asarray(tensioners, dtype=int)
        stuck = self.bodies[places]
        order = np.arange(self.stiffness.shape[0])
        kept = np.setdiff1d(order, stuck)
        bodies = self.system.bodies.copy()
        later = np.searchsorted(np.sort(stuck), self.bodies, side="right")
        bodies["unknown"] = np.where(self.bodies < 0, -1, self.bodies - later - self.system.first_body)
        bodies["unknown"][places] = -1
        own = (matrix[kept][:, kept] for matrix in (self.stiffness, self.damping, self.mass))
        return SmallMotions(self.prepared, self.system._replace(bodies=bodies), self.state, *own)


def in_motion(
    prepared: Prepared, system: System, state: State, speed: float, *, all_shafts: bool = False
) -> SmallMotions:
    """A drive whose belt passes at a speed, m/s, with hub chains that transmit the moments of the belt."""
    rims = slice(system.first_body, state.position.size - system.tensioners.size)
    seen = body_forces_at(system, np.zeros(1), state.position[None].copy(), state.velocity[None].copy())
    state.position[rims] = twists(system, seen.moment[0], state)
    if all_shafts:
        bodies = system.bodies.copy()
        bodies["unknown"] = np.arange(bodies.size)
        system = system._replace(bodies=bodies)
    return linearised(prepared, system, state, speed)


def linearised(prepared: Prepared, held: System, state: State, speed: float) -> SmallMotions:
    """Linearize a drive with constant torques, on a staying mesh, with the damping of its tensioners."""
    tensioners = drive_system(prepared).tensioners.copy()
    for kind in tensioners.dtype.names or ():
        for name in DRY_FRICTION if "spring" in (tensioners.dtype[kind].names or ()) else ():
            tensioners[kind]["spring"][name] = 0.0
    held = open_ended(prepared, held)
    turned = turning(held._replace(tensioners=tensioners), state)
    system = flowing_system(turned, anchor_at(state, True).direction)
    flowing = with_passage(held, state, speed)
    vibrations = Vibrations(system)
    tangents = vibrations.tangents(0.0, flowing.position, flowing.velocity)
    return SmallMotions(prepared, system, flowing, *map(vibrations.matrix, tangents))


def growing(motions: SmallMotions) -> ComplexArray:
    """Eigenvalues of slow motions that grow, the fastest growing first, of each conjugate pair one, 1/s."""
    given = pencil(motions.stiffness, motions.damping, motions.mass, motions.free)
    found = np.concatenate([nearest(given, shift, min(_AROUND, given.size))[0] for shift in _SHIFTS])
    grows = found[(found.real > _GROWS * np.abs(found)) & (found.real > _GROWS) & (found.imag >= -_GROWS)]
    grows = grows[np.argsort(-grows.real)]
    kept = list[complex]()
    for one in grows:
        if not any(abs(one - other) < 1e-3 * abs(one) for other in kept):
            kept.append(complex(one.real, one.imag if one.imag > _GROWS * abs(one) else 0.0))  # rounding
    return np.array(kept, complex)
