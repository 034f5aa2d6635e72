"""A drive linearized at rest, in steady running, or at an instant of a run."""

import numpy as np

from beltdyn.arrays import IntArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.nip import refuse_set
from beltdyn.results import Run
from beltdyn.state.linearized import DRY_FRICTION, SmallMotions, in_motion, linearised
from beltdyn.state.settling import DIRECTION
from beltdyn.state.slip_limit import Setting
from beltdyn.state.static import standing
from beltdyn.state.staying import Standing, bring_to_stand
from beltdyn.state.steady import search_from, steady_from
from beltdyn.system.arc_mesh import arc_count, fitted
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system, flowing_system, staying_system, without_hysteresis
from beltdyn.system.build_machines import with_resistance
from beltdyn.system.constant_drive import constant_drive, dry_friction_of, without_actions
from beltdyn.system.frame import StayingByArcs
from beltdyn.system.meshing import stopped
from beltdyn.system.state import State
from beltdyn.transient.beginning import recorded_state, staying_mesh

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
    speed, first_flow = float(moving.velocity[place]), place - arc_count(flowing.frame)
    flows = np.arange(first_flow, place + 1)
    state = State(*(np.delete(vector, flows) for vector in (moving.position, moving.velocity, moving.acceleration)))
    held = constant_drive(given, time)._replace(element=staying_system(run.prepared, given.length).element)
    held.frame.speed[0] = speed
    if isinstance(held.frame, StayingByArcs):
        held.frame.shift[:] = moving.position[first_flow:place]
        fitted(held, state.position)
    angles = state.position[held.first_body :][: held.pulleys.size]
    return stopped(held, angles, float(moving.position[place])), state, speed


_STICKS = 100.0
"""Stiffness along the rim of a belt that sticks, over that of the normal force, on the pulley with least friction."""


def dry_tensioners(prepared: Prepared) -> IntArray:
    """Numbers of the moving tensioners of a drive that have dry friction."""
    tensioners = drive_system(prepared).tensioners
    return np.flatnonzero(sum(dry_friction_of(tensioners, name) for name in DRY_FRICTION))


def about_rest(drive: Drive) -> SmallMotions:
    """A drive at rest without driven or loaded shafts, with a belt that sticks to its pulleys.

    Where it touches them, springs hold it along the rim, a hundred times as stiff as those of the normal force or more.
    The hysteresis of the belt is left out: its stress has no tangent there.
    """
    require_closed(drive)
    return about_standing(bring_to_stand(prepare(drive.with_slides())))


def require_closed(drive: Drive, *, web: bool = False) -> None:
    """Refuse belts with ends, and web lines where they are not told to serve."""
    if drive.is_web and not web:
        raise ModelError('a web line has modes about steady running alone. Set about = "steady", or omit it.')
    refuse_set(drive.belt, drive.nips, "a small motion")
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
    sliding = linearised(rest.prepared, held._replace(pulleys=smooth), rest.state, 0.0)
    creeping = linearised(rest.prepared, held, rest.state, 0.0).damping - sliding.damping
    return sliding._replace(stiffness=sliding.stiffness + sticking_rate(rest.tension, held) * creeping)


def sticking_rate(tension: float, system: System) -> float:
    """Stiffness along the rim over the slope of friction over slip, 1/s."""
    friction = np.asarray(system.pulleys.friction)
    pressure = tension / system.rims.radius
    rough = friction > 0.0
    slope = (friction * pressure / system.law.friction.saturation(pressure, friction, 0.0))[rough]
    return float(_STICKS * system.law.normal.stiffness / slope.min()) if rough.any() else 0.0


def about_steady(run: Run, *, all_shafts: bool = False, smoothing: float = 1.0) -> SmallMotions:
    """A drive in steady running, with the rollers of nips that forces press on slides.

    `smoothing`: factor on the slip velocity at which friction saturates; ConvergenceError without such a state nearby.
    """
    require_closed(run.drive, web=True)
    freed = run.drive.with_slides()
    if freed is not run.drive:
        run = steady_from(freed, run, None, bands=False)
    search = search_from(run.prepared, run, float(run.dataset.attrs["steady_at"]))
    search.resume()
    system = search.constant
    if smoothing != 1.0:
        if search.solve(Setting(smoothing=smoothing), search.unknowns(), 1.0) is None:
            raise ConvergenceError(f"no steady running under friction with {smoothing:g} of its creep.")
        system = system._replace(law=system.law._replace(friction=system.law.friction.smoothed(smoothing)))
    return in_motion(search.prepared, system, search.state, search.belt_parameter, all_shafts=all_shafts)


def about_instant(run: Run, time: float) -> SmallMotions:
    """A drive at an instant of a run over time, as if it stayed in that state."""
    return in_motion(run.prepared, *state_of(run, time))
