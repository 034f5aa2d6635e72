"""From states to results: observe the states of the integrator, record outputs, and report progress."""

import time
from collections.abc import Callable, Mapping
from math import prod
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import SlipError
from beltdyn.model import Prepared
from beltdyn.model.advice import other_creep
from beltdyn.model.end import carriage_rate
from beltdyn.model.simulation import Frame, FrameName
from beltdyn.observation.band_limit import BandLimit
from beltdyn.observation.compilation import compile_kernels
from beltdyn.observation.observer import WORKS, Arrays, Observer
from beltdyn.results import RECORDED, FileRecorder, Layout, MemoryRecorder, Recorder, Run, Status, provenance
from beltdyn.results.mechanics import PASSED
from beltdyn.results.provenance import mesh_used, own_kinds
from beltdyn.results.recorder import status_after
from beltdyn.results.schema import FILTER_REACH, FILTERED, TIMES
from beltdyn.signals import closing, uninterrupted
from beltdyn.solvers.run_progress import Pace, Phase, Progress, Report
from beltdyn.solvers.trajectory import Chunk, Statistics, interpolated
from beltdyn.system.arc_mesh import recorded_lengths
from beltdyn.system.arrays import System
from beltdyn.system.frame import FlowingByArcs, OverTime, Travelling
from beltdyn.system.meshing import tooth_coordinates
from beltdyn.system.state import element_kind, laid

# What makes the steps of a simulation as short as they are

_REJECTED_SHARE = 0.1
"""Share of rejected steps above which they dominate the computing time."""
_GENTLER = 10.0
"""Factor on the slip velocity at saturation in the advice for a faster run."""
_BOUND_SHARE = 0.4
"""Mean step over a bound from which on the bound is felt."""


def step_bound(prepared: Prepared, statistics: Statistics, reached: float) -> str:
    """Say what bounds the time steps, and what would let them be longer."""
    simulation = prepared.simulation
    taken, rejected = statistics.steps, statistics.rejected_steps
    if taken == 0:
        return ""
    mean, share = reached / taken, rejected / (taken + rejected)
    if share > _REJECTED_SHARE:
        return (
            f"{share:.0%} of the time steps are rejected because friction builds up within a small slip "
            f"or contact is stiff. For a faster run, {other_creep(prepared, _GENTLER)}, which adds to the "
            f"slip; or reduce contact.stiffness = {prepared.contact_stiffness:.2g} N/m^2, which reduces "
            "the tension."
        )
    if simulation.max_step is not None and mean > _BOUND_SHARE * simulation.max_step:
        return f"simulation.max_step = {simulation.max_step:g} s limits the steps."
    if mean > _BOUND_SHARE * simulation.output_interval:
        interval = simulation.output_interval
        return f"Steps end on outputs: a simulation.output_interval above {interval:g} s is faster."
    return (
        f"Steps are as short as simulation.rtol = {simulation.rtol:g} requires where the belt vibrates "
        f"on its pulleys. A larger value is faster, as are fewer belt.elements than {prepared.elements}; "
        "`beltdyn check` shows the loss of accuracy."
    )


# Names and reference coordinates of the results of a drive


def result_layout(prepared: Prepared, system: System) -> Layout:
    """Names and reference coordinates of the results."""
    names = tuple(pulley.name for pulley in prepared.pulleys)
    spans = tuple(f"{a}-{b}" for a, b in prepared.spans)
    lengths = recorded_lengths(system)
    ends = np.append(0.0, np.cumsum(lengths))
    starts = ends[:-1]
    return Layout(
        pulleys=names,
        spans=spans,
        node_coordinate=ends[: system.nodes * system.points],
        element_coordinate=starts + 0.5 * lengths,
        belt_coordinate=(starts[:, None] + lengths[:, None] * system.contact.points).ravel(),
        coordinate_names=element_kind(system).coordinates,
        tensioners=tuple(names[pulley] for pulley in system.tensioners.pulley),
        carriages=_carriages(prepared),
        rolls=tuple(one.name for one in prepared.drive.rolls),
        bodies=_bodies(prepared, system),
        nips=tuple(prepared.pulleys[roller].name for roller, _ in prepared.path.nips_by_roller),
        tooth_coordinate=tuple(tooth_coordinates(system).tolist()),
    )


def _bodies(prepared: Prepared, system: System) -> tuple[str, ...]:
    """Names of rims, of bodies and controllers behind them, of the belt that flows, and of tensioners or carriage."""
    names = [pulley.name for pulley in prepared.pulleys]
    hubs = [f"{one.name} hub[{number}]" for one in prepared.pulleys for number, _ in enumerate(one.hub, 1)]
    lags = [
        f"{one.name} load[{number}]"
        for one in prepared.pulleys
        for number, load in enumerate(one.load, 1)
        if load.state_lag is not None
    ]
    winder = [] if prepared.drive.winder is None else [prepared.drive.winder.name]
    arcs = [f"{PASSED}{names[pulley]}" for pulley in prepared.path.on]
    flow = [*arcs, *(f"{PASSED}{name}" for name in winder)] if isinstance(system.frame, FlowingByArcs) else []
    flow += ["belt"] if isinstance(system.frame, OverTime) else []
    tensioners = (f"{names[pulley]} tensioner" for pulley in system.tensioners.pulley)
    return (*names, *hubs, *lags, *flow, *tensioners, *_carriages(prepared))


def _carriages(prepared: Prepared) -> tuple[str, ...]:
    """Name of the carriage, if there is one."""
    return () if prepared.carriage is None else (prepared.carriage.name,)


_OF_ROLLS = ("roll_length", "roll_radius", "roll_inertia", "roll_speed", "roll_torque")
"""Variables of rolls, in the order in which they are found."""
_WRITE_INTERVAL = 0.25
"""Clock time after which waiting states are observed and written, s, so that readers of the growing file lag little."""
_MOST_WAITING = 512
"""States that wait to be observed."""
_BLOCK_OUTPUTS = 512
"""Outputs that are made at a time."""
_FILTERED_OUTPUTS = 64
"""Outputs of a block that are filtered together."""


_GIVEN = ("_prepared", "_system", "_title", "_about", "_instants", "statistics", "watch", "integrator")
_GROWING = ("_filter", "_filtered", "_observer", "_findings", "_before", "_done", "_written", "_step", "_channels")
_KEPT = _GIVEN + _GROWING
"""The state of a recording for its continuation."""


class Recording:
    """A run in the making: a context that closes the results whatever happens.

    An interruption (Ctrl-C) ends the recording with the status "interrupted" and goes no further; an error ends it
    with the status "failed" and goes on to the caller.
    """

    def __init__(
        self,
        prepared: Prepared,
        system: System,
        output: Path | str | None,
        title: str,
        progress: Report | None,
        overwrite: bool = False,
        **attributes: Any,
    ) -> None:
        self.statistics = Statistics()
        self.watch: Callable[[Arrays], None] | None = None
        self.integrator: str = prepared.simulation.integrator
        self._prepared, self._system, self._progress = prepared, system, progress
        self._path = Path(output) if output is not None else None
        self._title, self._about = title, attributes
        layout, origin = result_layout(prepared, system), provenance(prepared.drive.text, title)
        origin |= own_kinds(prepared.drive) | self._mesh() | attributes
        self._recorder: Recorder = (
            FileRecorder(self._path, layout, origin, overwrite) if self._path else MemoryRecorder(layout, origin)
        )
        self._instants = prepared.simulation.instants
        self._filter = BandLimit(self._instants.interval)
        self._filtered = FILTER_REACH
        self._observer = Observer(prepared, system, layout.belt_coordinate)
        self._findings: dict[str, Any] = {}
        self._waiting: list[Chunk] = []
        self._before: tuple[Chunk, Arrays] | None = None
        self._done: Arrays = {}
        self._written = 0
        self._step = 0.0
        self._pace = Pace()
        self._begun = self._compiled = self._started = self._last_write = time.perf_counter()
        self._ended: float | None = None
        self._ending = False
        self._cpu_started, self._cpu_ended = time.process_time(), 0.0

    def _mesh(self) -> dict[str, Any]:
        """Attributes of the mesh."""
        name: FrameName = "travelling" if isinstance(self._system.frame, Travelling) else "staying"
        frame = self._prepared.frame if self._prepared.frame.name == name else Frame(name, "as the analysis needs it")
        return mesh_used(self._prepared.drive, frame, len(self._system.length))

    def keep(self) -> dict[str, Any]:
        """Write pending outputs, and return the state for a continuation in another process."""
        self._write()
        now, cpu = time.perf_counter(), time.process_time()
        spent = {
            "compiling": self._compiled - self._begun,
            "starting": self._started - self._compiled,
            "wall": now - self._compiled,
            "cpu": cpu - self._cpu_started,
        }
        counts = {"time": self._written, "filtered_time": self._filtered - FILTER_REACH}
        counts["field_time"] = int(np.count_nonzero(self._instants.has_fields(np.arange(self._written))))
        return {name: getattr(self, name) for name in _KEPT} | {"spent": spent, "counts": counts}

    @classmethod
    def resumed(cls, kept: Mapping[str, Any], output: Path, progress: Report | None) -> Self:
        """Go on with a recording."""
        made = cls.__new__(cls)
        for name in _KEPT:
            setattr(made, name, kept[name])
        made._path, made._progress = output, progress
        layout = result_layout(made._prepared, made._system)
        made._recorder = FileRecorder.resumed(output, layout, {name: kept["counts"][name] for name in TIMES})
        made._waiting, made._pace, made._ended, made._cpu_ended, made._ending = [], Pace(), None, 0.0, False
        spent, made._last_write = kept["spent"], time.perf_counter()
        made._compiled = made._last_write - spent["wall"]
        made._begun, made._started = made._compiled - spent["compiling"], made._compiled + spent["starting"]
        made._cpu_started = time.process_time() - spent["cpu"]
        return made

    def __enter__(self) -> Self:
        """Begin; see the class."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        """Write what waits and close the results with their status."""
        if isinstance(error, SlipError):
            self._findings["slips_through"] = error.fault
        status = status_after(kind)
        self.end(status)
        return status == "interrupted"

    def end(self, status: Status) -> None:
        """Write what waits, and close the results with their status; "failed" if what waits cannot be written."""
        with closing():
            written = False
            try:
                self._write(ending=not self._ending)
                written = True
            finally:
                self._recorder.close(status if written else "failed", self._attributes() | self._findings)

    def prepare(self) -> None:
        """Compile the kernels, so that the time taken is that of the simulation."""
        self.tell(self._instants.begin, "compiling")
        compile_kernels(self._system, laid(self._system, self._prepared.path))
        self._compiled = self._started = time.perf_counter()
        self._cpu_started = time.process_time()

    def start(self, prepared: Prepared, system: System, unstable: tuple[str, ...]) -> None:
        """Note that the state at the beginning is known."""
        layout = result_layout(prepared, system)
        if prepared.drive is not self._prepared.drive:
            drive = prepared.drive
            origin = provenance(drive.text, self._title) | own_kinds(drive) | self._mesh()
            attributes = origin | {"drive_as_given": self._prepared.drive.text, **self._about}
            self._recorder.revise(layout, attributes)
        if unstable:
            self._findings["unstable_tensioners"] = ", ".join(unstable)
        self._prepared, self._system = prepared, system
        self._observer = Observer(prepared, system, layout.belt_coordinate)
        self._started = time.perf_counter()

    def take(self, chunk: Chunk, phase: Phase = "integrating") -> None:
        """Take states; they are recorded a few at a time."""
        if len(chunk.time):
            self._waiting.append(chunk)
            self._step = float(chunk.step[-1])
        self.tell(chunk.reached, phase)
        states = sum(len(chunk.time) for chunk in self._waiting)
        if states > _MOST_WAITING or time.perf_counter() - self._last_write > _WRITE_INTERVAL:
            self._write()

    def tell(self, reached: float, phase: Phase) -> None:
        """Tell of progress."""
        if self._progress is not None:
            duration, passed = self._prepared.simulation.duration, reached - self._instants.begin
            outputs = self._instants.until(float(self._waiting[-1].time[-1])) if self._waiting else self._written
            elapsed = time.perf_counter() - self._started if phase == "integrating" else 0.0
            bound = step_bound(self._prepared, self.statistics, passed)
            pace = self._pace.at(elapsed, passed)
            self._progress(Progress(passed, duration, self._step, outputs, phase, elapsed, bound, pace))

    def note(self, **facts: Any) -> None:
        """Add global attributes to the dataset."""
        self._findings |= facts

    def check(self) -> None:
        """Look, when all is done, whether the belt may have fluttered."""
        self._write(ending=True)
        self._ended, self._cpu_ended = time.perf_counter(), time.process_time()
        flutter = self._observer.find_flutter()
        self._findings |= flutter.attributes if flutter else {}
        self._findings |= self._observer.find_jumps()
        self._findings["check_time"] = time.perf_counter() - self._ended

    def run(self) -> Run:
        """The run that was recorded."""
        return Run(None if self.file else self._recorder.dataset(), self._prepared.drive, self.file)

    @property
    def file(self) -> Path | None:
        """The result file, once it holds outputs; until then an earlier one may be there."""
        return self._recorder.file

    def _write(self, *, ending: bool = False) -> None:
        """Record what waits, as a whole even if a signal comes meanwhile; at the end all that can be filtered."""
        with uninterrupted():
            self._ending |= ending
            if self._waiting:
                self._record()
            if ending and self._before is not None and self._filtered < self._filterable():
                self._recorder.append(self._outputs(*self._before, np.empty(0, dtype=np.int64)))
        self._last_write = time.perf_counter()

    def _record(self) -> None:
        """Record the outputs that lie in the steps to the states that wait."""
        states = Chunk.join(self._waiting)
        self._waiting.clear()
        before = self._before[0].time[0] if self._before else self._instants.begin - self._instants.interval
        shown = states.around(self._instants, before)
        shown[-1] = True  # the next step may hold an output
        seen, for_spectra = self._observer.see(states, shown)
        self._take_for_spectra(states, for_spectra)
        states = states.only(shown)
        if self._before is not None:
            states = Chunk.join([self._before[0], states])
            seen = {name: np.concatenate([self._before[1][name], values]) for name, values in seen.items()}
        self._before = states.only(slice(-1, None)), {name: values[-1:] for name, values in seen.items()}
        end = self._instants.until(float(states.time[-1]))
        for first in range(self._written, end, _BLOCK_OUTPUTS):
            numbers = np.arange(first, min(first + _BLOCK_OUTPUTS, end))
            outputs = self._outputs(states, seen, numbers)
            self._recorder.append(outputs)
            self._written += len(numbers)
            if self.watch is not None:
                self.watch(outputs)

    def _outputs(self, states: Chunk, seen: Arrays, numbers: IntArray) -> Arrays:
        """Every recorded variable at some instants, by their numbers; fields at some of these."""
        instants = self._instants[numbers]
        moments = {"time": instants, "field_time": instants[self._instants.has_fields(numbers)]}
        for_spectra = self._for_spectra()
        places = {name: states.locate(moment) for name, moment in moments.items()}
        dims = {name: RECORDED[name].dims[0] for name in seen}
        result = {name: interpolated(values, *places[dims[name]]) for name, values in seen.items()}
        for name in WORKS:
            done = result[name]
            before = self._done.get(name, done[:1])
            result[name] = np.diff(done, axis=0, prepend=before)
            self._done[name] = done[-1:] if len(done) else before
        bodies, nodes = self._bodies(*states.at(instants)), self._nodes(states, moments["field_time"])
        return {
            **result,
            **bodies,
            **nodes,
            **for_spectra,
            **moments,
            "step_size": states.step[places["time"][0]],
        }

    def _take_for_spectra(self, states: Chunk, seen: Arrays) -> None:
        """Hand what is recorded for spectra to the filter."""
        known = seen | self._bodies(states.position, states.velocity)
        self._channels = {name: known[name].shape[1:] for name in FILTERED if name in known}
        flat = [known[name].reshape(len(states.time), -1) for name in self._channels]
        self._filter.take(states.time, np.hstack(flat))

    def _for_spectra(self) -> Arrays:
        """What is recorded for spectra: the next outputs for which all states that they need have come.

        They are always filtered in the same groups, so that a resumed run is identical.
        """
        end, first = self._filterable(), self._filtered
        if not self._ending:
            end = min(end - (end - first) % _FILTERED_OUTPUTS, first + _BLOCK_OUTPUTS)
        starts = range(first, end, _FILTERED_OUTPUTS)
        values = [
            self._filter.at(self._instants[np.arange(start, min(start + _FILTERED_OUTPUTS, end))]) for start in starts
        ]
        self._filtered = max(end, first)
        filtered = np.concatenate(values) if values else self._filter.at(np.empty(0))
        columns = np.split(filtered, np.cumsum([prod(shape) for shape in self._channels.values()])[:-1], axis=1)
        parts = zip(self._channels.items(), columns, strict=True)
        found = {f"filtered_{name}": part.reshape(-1, *shape) for (name, shape), part in parts}
        return {"filtered_time": self._instants[np.arange(first, self._filtered)], **found}

    def _filterable(self) -> int:
        """Number of the first output for spectra that needs states which have not come."""
        return self._instants.until(self._filter.known_until(last=self._ending))

    def _bodies(self, position: FloatArray, velocity: FloatArray) -> Arrays:
        """Coordinates and speeds of bodies, from states of shape (k, n N + D)."""
        system = self._system
        nodes, pulleys = system.first_body, len(system.pulleys)
        shafts, tensioners = nodes + system.pulleys.shaft, position.shape[1] - len(system.tensioners)
        carried = {"tensioner_position": position[:, tensioners:], "tensioner_speed": velocity[:, tensioners:]}
        return {
            **(carried if len(system.tensioners) else {}),
            **self._carriage(position, velocity),
            **self._rolls(position, velocity),
            "pulley_speed": velocity[:, nodes : nodes + pulleys],
            "pulley_angle": position[:, nodes : nodes + pulleys],
            "shaft_speed": velocity[:, shafts],
            "shaft_angle": position[:, shafts],
        }

    def _carriage(self, position: FloatArray, velocity: FloatArray) -> Arrays:
        """Way and speed of a carriage, and how far it is ahead of the driver with a belt that does not stretch."""
        prepared = self._prepared
        if prepared.carriage is None:
            return {}
        place, speed, driver = position[:, -1:], velocity[:, -1:], prepared.reference
        rate = carriage_rate(prepared.carriage, prepared.path, driver)
        ahead = place - rate * position[:, self._system.first_body + driver, None]
        return {"carriage_position": place, "carriage_speed": speed, "carriage_error": ahead}

    def _rolls(self, position: FloatArray, velocity: FloatArray) -> Arrays:
        """Length, radius, inertia and speed of the rolls of a web line, and the torque of their webs."""
        prepared, belt, found = self._prepared, self._prepared.belt, list[FloatArray]()
        for one in prepared.drive.rolls:
            assert one.roll is not None
            winds = one is prepared.drive.winder
            sense, passed, flow = self._through_end(winds, position, velocity)
            length = one.roll.length_of(belt.thickness) + sense * passed
            radius = one.roll.radius_at(length, belt.thickness)
            inertia = one.roll.inertia_at(length, belt.thickness, belt.mass_per_length)
            at = winds * (self._system.nodes - 1) * len(self._system.scale) + self._system.turned
            stretch = np.hypot(position[:, at], position[:, at + 1])
            tension = belt.stretch_parameters.tension(stretch) if one.tension is None else one.tension
            found.append(np.stack([length, radius, inertia, flow * stretch / radius, tension * radius]))
        return dict(zip(_OF_ROLLS, np.stack(found, axis=-1), strict=True)) if found else {}

    def _through_end(
        self, winds: bool, position: FloatArray, velocity: FloatArray
    ) -> tuple[float, FloatArray, FloatArray]:
        """Sign of what a roll gains, the unstretched length that has passed an end of a web line, and its flow."""
        frame = self._system.frame
        if isinstance(frame, FlowingByArcs):
            ends = slice(frame.place - winds, frame.place + 1)  # the shift at the winder, and what has passed
            return 1.0 if winds else -1.0, position[:, ends].sum(axis=1), velocity[:, ends].sum(axis=1)
        still = np.zeros(len(position))
        return 0.0, still, still + np.ravel(frame.speed)[0]  # a number at rest

    def _nodes(self, states: Chunk, instants: FloatArray) -> Arrays:
        """Coordinates and velocities of nodes, and of bodies at the same instants."""
        system = self._system
        shape = len(instants), system.nodes * system.points, len(system.scale) // system.points
        position, velocity = states.at(instants)
        return {
            "nodal_coordinates": position[:, : system.first_body].reshape(shape),
            "nodal_velocities": velocity[:, : system.first_body].reshape(shape),
            "body_position": position[:, system.first_body :],
            "body_velocity": velocity[:, system.first_body :],
        }

    def _attributes(self) -> dict[str, Any]:
        """Statistics of the solver, known at the end."""
        wall = (self._ended or time.perf_counter()) - self._compiled
        cpu = (self._cpu_ended or time.process_time()) - self._cpu_started
        return {
            "integrator": self.integrator,
            "steps": self.statistics.steps,
            "rejected_steps": self.statistics.rejected_steps,
            "newton_iterations": self.statistics.newton_iterations,
            "evaluations": self.statistics.evaluations,
            "wall_time": wall,
            "cpu_time": cpu,
            "compile_time": self._compiled - self._begun,
            "start_time": self._started - self._compiled,
        }
