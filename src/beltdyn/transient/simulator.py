"""Step-by-step simulation with inputs and outputs, for control and co-simulation."""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import go_on, profile_integral, profile_value
from beltdyn.model import Drive, Pulley, prepare
from beltdyn.parts.quantity import number_in
from beltdyn.results.energy_balance import STORED
from beltdyn.results.mechanics import wraps_of_contact
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.integrator_state import IntegratorState, grown
from beltdyn.solvers.run_progress import Report
from beltdyn.solvers.trajectory import Statistics, drive_task
from beltdyn.system.arrays import ENERGY_WORKS
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.build_machines import profile_arrays
from beltdyn.system.moving_center import moving_to, pulley_center, with_movers
from beltdyn.system.observe import observe_motion
from beltdyn.system.state import State
from beltdyn.transient.beginning import begin_on, mesh_of, settled
from beltdyn.transient.simulate import choose_integrator

_OF_PULLEYS = (
    *("pulley_speed", "pulley_angle", "shaft_speed", "shaft_angle", "shaft_torque", "pulley_torque"),
    *("hub_load", "wrap_angle"),
)
"""Outputs of each pulley."""
_CHANGED = ("profiles", "pulleys", "tensioners", "bodies")
"""Arrays of a system that inputs change."""
_PLANE = 2
"""Coordinates of a point."""


@dataclass(frozen=True)
class SimulatorState:
    """Where a simulator was, from `Simulator.save`; it can be pickled, for a simulator of the same drive elsewhere."""

    integrator: IntegratorState
    changed: dict[str, Any]
    """Arrays of the system that inputs change."""
    pulleys: tuple[Pulley, ...]
    anew: bool
    moves: bool

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"pulleys": [pulley.model_dump(mode="json", exclude_none=True) for pulley in self.pulleys]}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, pulleys=tuple(Pulley.model_validate(one) for one in state["pulleys"]))


class Simulator:
    """Step-by-step simulation of a drive, with the same integrator and initial state as `simulate`.

    Speeds and torques follow the drive file until they are set. The constructor computes the initial state, including
    the belt length for the installed tension.

    Parameters
    ----------
    drive : Drive
        The drive; its `simulation.duration` is no limit here.
    progress : callable, optional
        Called with a `Progress` while the initial state is computed.

    Raises
    ------
    ModelError
        If the drive has another integrator than "generalized_alpha".
    ConvergenceError
        If no initial state is found.

    Examples
    --------
    >>> simulator = bd.Simulator(drive)
    >>> simulator.step(0.01)
    >>> simulator.set_torque("driven", -0.5)
    >>> simulator.step(0.02)
    >>> round(simulator.time, 3)
    0.02
    """

    def __init__(self, drive: Drive, progress: Report | None = None) -> None:
        integrator = choose_integrator(drive)
        if not isinstance(integrator, GeneralizedAlpha):
            raise ModelError(
                f'a simulator supports only generalized_alpha, not "{integrator.name}". Omit simulation.integrator.'
            )
        begin = begin_on(mesh_of(prepare(settled(drive, integrator)[0]), integrator, progress), integrator, progress)
        self.drive, self._prepared = begin.prepared.drive, begin.prepared
        """With the length, or the take-up, that gives the installed tension."""
        self._integration = integrator.begin(drive_task(begin.prepared, begin.system, begin.state, Statistics()))
        self._pulleys: tuple[Pulley, ...] = begin.prepared.pulleys
        self._wanted: dict[int, float] = {}
        self._centers: dict[int, tuple[float, float]] = {}
        self._anew, self._moves = True, False

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return float(self._integration.state.clock.time)

    def set_speed(self, pulley: str, speed: float | str) -> None:
        """Prescribe the speed of a pulley: linear over the next step, then constant.

        Parameters
        ----------
        pulley : str
            Name of a pulley whose speed is prescribed.
        speed : float or str
            At the end of the next step, rad/s, or text with a unit.

        Raises
        ------
        ModelError
            If there is no such pulley, or its speed is not prescribed.
        """
        number = self.drive.number_of(pulley)
        if not self._pulleys[number].prescribed:
            raise ModelError(f"pulley = {pulley!r} turns freely, so its speed cannot be set. Set its torque.")
        self._wanted[number] = number_in("speed", speed, "rad/s")

    def set_torque(self, pulley: str, torque: float | str) -> None:
        """Apply a torque to a pulley from now on, in place of the one of the drive file and in addition to its loads.

        Parameters
        ----------
        pulley : str
            Name of a pulley that turns freely.
        torque : float or str
            Counter-clockwise positive, N m, or text with a unit.

        Raises
        ------
        ModelError
            If there is no such pulley, or its speed is prescribed.
        """
        number = self.drive.number_of(pulley)
        if self._pulleys[number].prescribed:
            raise ModelError(f"pulley = {pulley!r} has a prescribed speed, so its torque cannot be set. Set its speed.")
        self._wanted[number] = number_in("torque", torque, "N*m")

    def set_center(self, pulley: str, center: Sequence[float | str]) -> None:
        """Move the center of a pulley along a straight line over the next step, then hold it.

        The work done against the hub load is part of ``driver_work`` in the outputs. A staying mesh does not follow:
        its refined parts remain at the initial ends of the arcs.

        Parameters
        ----------
        pulley : str
            Name of a pulley not carried by a spring-loaded tensioner.
        center : sequence of 2 float or str
            At the end of the next step, m, or texts with units.

        Raises
        ------
        ModelError
            If there is no such pulley, a spring-loaded tensioner carries it, or the position is invalid.
        """
        number = self.drive.number_of(pulley)
        if any(one.pulley == pulley for one in self.drive.moving_tensioners):
            raise ModelError(
                f"pulley = {pulley!r} is carried by a tensioner with a spring, which moves its center. Set the centers "
                "of other pulleys, or give it a fixed tensioner in the drive file."
            )
        if isinstance(center, str) or len(center) != _PLANE:
            raise ModelError(f"center = {center!r} must be two lengths, [x, y].")
        x, y = (number_in("center", one, "m") for one in center)
        self._centers[number] = x, y

    def center(self, pulley: str) -> tuple[float, float]:
        """Current center of a pulley, m.

        Parameters
        ----------
        pulley : str
            Its name.

        Raises
        ------
        ModelError
            If there is no such pulley.
        """
        number = self.drive.number_of(pulley)
        return pulley_center(self._integration.system, number, self._integration.state.position)

    def step(self, until: float) -> None:
        """Simulate to an instant.

        Parameters
        ----------
        until : float
            s, after the current time.

        Raises
        ------
        ModelError
            If it is not later.
        ConvergenceError
            If the simulation fails.
        """
        if not (isfinite(until) and until > self.time):
            raise ModelError(f"until = {until:g} s is not after the current time, {self.time:g} s. Give a later one.")
        if self._wanted:
            self._take_inputs(until)
        if self._centers or self._moves:
            self._move_centers(until)
        kinks = sorted({kink for kink in self._kinks() if self.time < kink < until})
        for stop in (*kinks, until):
            if self._anew:
                self._integration.restart()
            for _ in self._integration.until(stop):
                pass
            self._anew = stop in self._kinks()

    def _kinks(self) -> set[float]:
        """Instants of kinks and jumps of what is prescribed, s."""
        profiles = [profile for pulley in self._pulleys for profile in pulley.profiles]
        return {float(kink) for profile in profiles for kink in profile.breakpoints()}

    def _take_inputs(self, until: float) -> None:
        """Prescribe what was set: speeds that rise linearly until an instant (s), and torques that jump."""
        now, before = self.time, self._integration.system.profiles
        pulleys = list(self._pulleys)
        for number, value in self._wanted.items():
            if pulleys[number].prescribed:
                start = interpreted(profile_value)(before, number, now)[0]
                ramp = {"kind": "table", "times": [now, until], "values": [start, value]}
                pulleys[number] = pulleys[number].replace(speed=ramp)
            else:
                pulleys[number] = pulleys[number].replace(torque={"kind": "constant", "value": value})
        self._pulleys = tuple(pulleys)
        self._wanted.clear()
        after = profile_arrays(pulleys, self.drive.goods)
        prescribed = [number for number, pulley in enumerate(pulleys) if pulley.prescribed]
        angles = [interpreted(profile_integral)(before, number, now) for number in prescribed]
        go_on(after, prescribed, now, angles)
        self._integration.system = self._integration.system._replace(profiles=after)
        self._anew = True

    def _move_centers(self, until: float) -> None:
        """Set centers in motion that are to be elsewhere at an instant (s), and stop the others."""
        now, state, own = self._integration.system, self._integration.state, len(self.drive.moving_tensioners)
        new = [number for number in self._centers if now.pulleys.carrier[number] < 0]
        system = with_movers(now, new)
        places = State(*(np.pad(one, (0, len(new))) for one in (state.position, state.velocity, state.acceleration)))
        system, places = moving_to(system, places, own, self._centers, until - self.time)
        self._integration.exchange(system, grown(state, places.position, places.velocity))
        self._moves, self._anew = bool(self._centers), True
        self._centers.clear()

    def outputs(self) -> dict[str, float]:
        """Outputs at the current time by name, in SI units.

        Returns
        -------
        dict
            ``pulley_speed[NAME]``, ``pulley_angle[NAME]``, ``shaft_speed[NAME]``, ``shaft_angle[NAME]`` (behind a hub
            chain), ``shaft_torque[NAME]`` (from outside), ``pulley_torque[NAME]`` (of the belt), ``hub_load[NAME]``,
            ``wrap_angle[NAME]``, ``span_tension[NAME-NAME]``, of tensioners ``tensioner_position[NAME]``, and the
            stored energies, works and losses since the start, under their names in results.
        """
        system, state = self._integration.system, self._integration.state
        position, velocity = state.position[None].copy(), state.velocity[None].copy()
        forces = body_forces_at(system, np.array([self.time]), position, velocity)
        seen = observe_motion(system, position, velocity, forces, np.ones(1, dtype=bool))
        pulleys = system.first_body + np.arange(len(system.pulleys))
        shafts = system.first_body + system.pulleys.shaft
        of_pulleys = {
            "pulley_speed": velocity[0, pulleys],
            "pulley_angle": position[0, pulleys],
            "shaft_speed": velocity[0, shafts],
            "shaft_angle": position[0, shafts],
            "shaft_torque": seen.shaft_torque[0],
            "pulley_torque": seen.pulley_torque[0],
            "hub_load": np.hypot(*seen.hub_force[0].T),
            "wrap_angle": wraps_of_contact(self._prepared, seen.pulley_center[0], seen.wrap_angle[0]),
        }
        first = position.shape[1] - len(system.tensioners)
        tensioners = position[0, first : first + len(self.drive.moving_tensioners)]
        stored = np.concatenate([getattr(seen, name) for name in STORED])
        rows = [*(of_pulleys[name] for name in _OF_PULLEYS), seen.span_tension[0], tensioners, stored, state.work]
        return dict(zip(output_names(self.drive), map(float, np.concatenate(rows)), strict=True))

    def save(self) -> SimulatorState:
        """Save the state for `restore`; inputs set for the next step are not saved."""
        system = self._integration.system
        changed = deepcopy({name: getattr(system, name) for name in _CHANGED})
        return SimulatorState(deepcopy(self._integration.state), changed, self._pulleys, self._anew, self._moves)

    def restore(self, saved: SimulatorState) -> None:
        """Restore a saved state; the continuation is bitwise identical.

        Parameters
        ----------
        saved : SimulatorState
            From `save` of this simulator, or of another one of the same drive.

        Raises
        ------
        ModelError
            If it belongs to another drive.
        """
        now = self._integration
        system = now.system._replace(**deepcopy(saved.changed))
        size = system.first_body + system.bodies.size
        changed = {name: getattr(now.system, name) for name in _CHANGED}
        fits = _kinds(saved.integrator) == _kinds(now.state) and _kinds(saved.changed) == _kinds(changed)
        fits = fits and _same_sizes(saved.changed, changed)
        if not fits or any(vector.shape[-1] != size for vector in _vectors(saved.integrator)):
            raise ModelError("the state belongs to another drive. Give a state of this drive.")
        self._integration.exchange(system, deepcopy(saved.integrator))
        self._pulleys, self._anew, self._moves = saved.pulleys, saved.anew, saved.moves
        self._wanted.clear()
        self._centers.clear()


def _kinds(value: Any) -> Any:
    """What an array, or all arrays of a record, are made of."""
    if isinstance(value, dict):
        return {name: _kinds(one) for name, one in value.items()}
    return tuple(map(_kinds, value)) if isinstance(value, tuple) else (getattr(value, "dtype", None), np.ndim(value))


def _same_sizes(saved: dict[str, Any], now: dict[str, Any]) -> bool:
    """Whether arrays that inputs change have as many rows as those of now, and profiles the rows that they refer to.

    A moved center adds a body and a tensioner that carries its pulley.
    """
    profiles, table = saved["profiles"], saved["profiles"].table
    rows = ((table.segment, profiles.segment), (table.harmonic, profiles.harmonic))
    return (
        saved["pulleys"].shape == now["pulleys"].shape
        and saved["bodies"].size - saved["tensioners"].size == now["bodies"].size - now["tensioners"].size
        and saved["tensioners"].size <= saved["pulleys"].size
        and table.shape == now["profiles"].table.shape
        and all(first[-1] == len(those) and not np.any(np.diff(first, prepend=0) < 0) for first, those in rows)
    )


def _vectors(state: IntegratorState) -> list[FloatArray]:
    """What has an entry for each coordinate."""
    parts = (state.position, state.velocity, state.acceleration, state.auxiliary, state.trend, state.impulse)
    return [*parts, *state.trial]


def output_names(drive: Drive) -> list[str]:
    """Names of the outputs of a simulator, before there is one."""
    of_pulleys = [f"{name}[{pulley.name}]" for name in _OF_PULLEYS for pulley in drive.pulleys]
    of_spans = [f"span_tension[{before}-{after}]" for before, after in drive.spans]
    of_tensioners = [f"tensioner_position[{one.pulley}]" for one in drive.moving_tensioners]
    return [*of_pulleys, *of_spans, *of_tensioners, *STORED, *ENERGY_WORKS]
