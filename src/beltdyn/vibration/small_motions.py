"""A drive about a state, linearized: (K + s C + s^2 M) x = 0 for small motions x exp(s t).

The belt flows through a staying mesh, so that steady running is a point at rest of the equations: the forces of
Coriolis and the centrifugal forces of the moving belt are in C and K.  Speeds, torques and schedules are held.
"""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.results import Run
from beltdyn.solvers.flutter import Vibrations
from beltdyn.state.settling import DIRECTION, with_passage
from beltdyn.state.static import standing
from beltdyn.state.staying import Standing, bring_to_stand
from beltdyn.state.steady import search_from
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.build_carrying import with_resistance
from beltdyn.system.build_staying import flowing_system, open_ended, staying_system, without_hysteresis
from beltdyn.system.constant_drive import constant_drive, dry_friction_of, rim_of_bodies, twists, without_actions
from beltdyn.system.meshing import stopped, turning
from beltdyn.system.state import State
from beltdyn.system.state_forces import body_forces_at
from beltdyn.system.steady_assembly import anchor_at
from beltdyn.transient.earlier_run import recorded_state, staying_mesh

if TYPE_CHECKING:
    from scipy.sparse import csc_array


# The state of a run over time, at an instant at which its belt was recorded, on the staying mesh


def require_mesh_that_stays(run: Run) -> None:
    """Make sure that a run has states that stay."""
    if not run.drive.frame.stays:
        raise ModelError(
            'modes need a run on a staying mesh, but this run has simulation.frame = "travelling", whose nodes '
            'enter and leave the arcs. Run the drive again with frame = "staying", or compute its modes about '
            "steady running."
        )


def state_of(run: Run, time: float) -> tuple[System, State, float]:
    """A drive at an instant of a run, with speeds, torques and schedules as they are then."""
    given = staying_mesh(run.prepared, run)
    flowing = flowing_system(given, np.array(run.dataset.attrs[DIRECTION]))
    moving, place = recorded_state(run, time, flowing), flowing.frame.place
    speed = float(moving.velocity[place])
    state = State(*(np.delete(vector, place) for vector in (moving.position, moving.velocity, moving.acceleration)))
    held = constant_drive(given, time)._replace(element=staying_system(run.prepared, given.length).element)
    held.frame.speed[0] = speed
    angles = state.position[held.first_body :][: held.pulleys.size]
    return stopped(held, angles, float(moving.position[place])), state, speed


_DRY = ("tensioning_friction", "yielding_friction")
_STICKS = 100.0
"""Stiffness along the rim of a belt that sticks, over that of the normal force, on the pulley with least friction."""
_NO_FORCE, _LITTLE_FORCE = 1e-9, 2e-2
"""Force that a free motion meets at most, over the sum of its parts: of a body that turns, and of the belt that turns
all pulleys, which roll on radii a little smaller than those of its centerline."""


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


def dry_tensioners(prepared: Prepared) -> IntArray:
    """Numbers of the moving tensioners of a drive that have dry friction."""
    tensioners = drive_system(prepared).tensioners
    return np.flatnonzero(sum(dry_friction_of(tensioners, name) for name in _DRY))


def about_rest(drive: Drive) -> SmallMotions:
    """A drive at rest without driven or loaded shafts, with a belt that sticks to its pulleys.

    Where it touches them, springs hold it along the rim, a hundred times as stiff as those of the normal force or more.
    The hysteresis of the belt is left out: its stress has no tangent there.
    """
    require_closed(drive)
    return about_standing(bring_to_stand(prepare(drive)))


def require_closed(drive: Drive, *, web: bool = False) -> None:
    """Refuse belts with ends, and web lines where they are not told to serve."""
    if drive.is_web and not web:
        raise ModelError('a web line has modes about steady running alone. Set about = "steady", or omit it.')
    if drive.is_web and drive.nips:
        raise ModelError("a web line with nips has no modes. Use `beltdyn steady-state`, or remove its [[nip]].")
    if drive.ends and not drive.is_web:
        other = "Use `beltdyn stroke`" if drive.carriage else "Simulate the drive with `beltdyn simulate`"
        raise ModelError(f"the belt is open, but modes need a closed belt. {other}.")


def about_standing(rest: Standing) -> SmallMotions:
    """The same as `about_rest` of a drive that is at rest already."""
    held = without_hysteresis(constant_drive(standing(rest.system), 0.0))
    held = held._replace(carrying=with_resistance(held.carrying, 0.0))
    without_actions(held)
    smooth = held.pulleys.copy()
    smooth["friction"] = 0.0
    sliding = _linearised(rest.prepared, held._replace(pulleys=smooth), rest.state, 0.0)
    creeping = _linearised(rest.prepared, held, rest.state, 0.0).damping - sliding.damping
    return sliding._replace(stiffness=sliding.stiffness + sticking_rate(rest.tension, held) * creeping)


def sticking_rate(tension: float, system: System) -> float:
    """Stiffness along the rim over the slope of friction over slip, 1/s."""
    friction = np.asarray(system.pulleys.friction)
    pressure = tension / system.rims.radius
    rough = friction > 0.0
    slope = (friction * pressure / system.law.friction.saturation(pressure, friction, 0.0))[rough]
    return float(_STICKS * system.law.normal.stiffness / slope.min()) if rough.any() else 0.0


def about_steady(run: Run, *, all_shafts: bool = False) -> SmallMotions:
    """A drive in steady running."""
    require_closed(run.drive, web=True)
    search = search_from(run.prepared, run, float(run.dataset.attrs["steady_at"]))
    search.resume()
    return _in_motion(search.prepared, search.constant, search.state, search.belt_parameter, all_shafts=all_shafts)


def about_instant(run: Run, time: float) -> SmallMotions:
    """A drive at an instant of a run over time, as if it stayed in that state."""
    return _in_motion(run.prepared, *state_of(run, time))


def _in_motion(
    prepared: Prepared, system: System, state: State, speed: float, *, all_shafts: bool = False
) -> SmallMotions:
    """A drive whose belt passes at a speed, m/s, with hub chains that transmit the moments of the belt."""
    rims = slice(system.first_body, state.position.size - system.tensioners.size)
    seen = body_forces_at(system, np.zeros(1), state.position[None].copy(), state.velocity[None].copy())
    state.position[rims] = twists(system, seen.moment[0])
    if all_shafts:
        bodies = system.bodies.copy()
        bodies["unknown"] = np.arange(bodies.size)
        system = system._replace(bodies=bodies)
    return _linearised(prepared, system, state, speed)


def _linearised(prepared: Prepared, held: System, state: State, speed: float) -> SmallMotions:
    """Linearize a drive with constant torques, on a staying mesh, with the damping of its tensioners."""
    tensioners = drive_system(prepared).tensioners.copy()
    for kind in tensioners.dtype.names or ():
        for name in _DRY if "spring" in (tensioners.dtype[kind].names or ()) else ():
            tensioners[kind]["spring"][name] = 0.0
    held = open_ended(prepared, held)
    turned = turning(held._replace(tensioners=tensioners), state)
    system = flowing_system(turned, anchor_at(state, True).direction)
    flowing = with_passage(held, state, speed)
    vibrations = Vibrations(system)
    tangents = vibrations.tangents(0.0, flowing.position, flowing.velocity)
    return SmallMotions(prepared, system, flowing, *map(vibrations.matrix, tangents))
