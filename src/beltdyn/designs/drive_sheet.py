"""The drive sheet: geometry, tensioner positions, tensions, hub loads, slip safety, peaks, modes and belts to order.

All states are those of the balance of tensions about the equilibrium at rest, which the finite elements find once; see
`beltdyn.points.quasi_steady` and `beltdyn.vibration.peaks`. So a sheet of many operating points takes a second.
"""

from collections.abc import Iterator, Mapping
from functools import reduce
from inspect import signature
from pathlib import Path
from typing import Annotated, Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.designs.line_motions import Launch, braking_forces
from beltdyn.designs.line_sheet import line_sheet
from beltdyn.errors import ModelError
from beltdyn.model import Drive, FixedTensioner, Prepared, alignment, prepare
from beltdyn.model.alignment import judge_alignment
from beltdyn.model.demand import required_tension
from beltdyn.model.installation import DEFLECTION, FITTING, TENSIONING, Installation, tension_checks
from beltdyn.model.parameter_study import PASS
from beltdyn.parts.options import RangeCount, takes_options
from beltdyn.parts.quantity import Flag, Number, Numbers, Ratio, number_in, numbers_in
from beltdyn.points.changed_drive import at_instant, held_at
from beltdyn.points.duty import Column, at_row, durations_of, duty, duty_of
from beltdyn.points.quasi_steady import QuasiSteady, Running, Torques, torques_between, torques_of
from beltdyn.points.tensioner_sheet import lengths_of
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.damage import Damage, Lives, damage_of_tensions, known_variables
from beltdyn.results.means import rate, utilization
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, RECORDED, SLIP_SAFETIES, SPAN_TENSIONS
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.installation import looked_at
from beltdyn.state.staying import bring_to_stand
from beltdyn.theory.span import center_distance
from beltdyn.vibration.excitation import averaged
from beltdyn.vibration.peaks import amplitudes, excitations_of, lumped_at

_INSTANTS = 2001
"""At which the speed of a driver is looked at for its acceleration."""
_MODES = 6
"""Modes on the sheet."""
_MOVES = 0.15
"""Share of the kinetic energy from which on a part is named in a mode."""
_NEIGHBORS = 2
"""Standard lengths on either side of the nominal one."""
_LEAST_SPEED = 0.2
"""First speed of the default range without a duty, over that of the drive."""
_SLACK = 1e-3
"""Tension over that at rest below which a belt hangs slack."""
REST_TENSIONS = {
    "rest_tension": "Tension of the span at rest",
    "least_rest_tension": "Least tension of the span at rest",
    "largest_rest_tension": "Largest tension of the span at rest",
    "rest_tension_at_start": "Tension at the start of the span at rest",
    "rest_tension_at_end": "Tension at the end of the span at rest",
}
"""Tensions of a span at rest, with their labels."""
_ACCELERATIONS = {"": 0.0, ", accelerating": 1.0, ", decelerating": -1.0}

Table = dict[str, tuple[Variable, Any]]
_ROW, _SPEED, _PULLEY, _SPAN, _TENSIONER = "row", "speed", "pulley", "span", "tensioner"
_STATE, _MODE, _STANDARD = ("state",), ("mode",), ("standard",)


@takes_options
def sheet(
    drive: Drive,
    *,
    table: Path | str | None = None,
    speed: Numbers | None = None,
    points: RangeCount = 20,
    acceleration: Number = "0 rpm/s",
    light_load: Annotated[Ratio, Field(ge=0, le=1)] = 0.1,
    friction: Numbers = "0.7, 1, 1.3",
    tolerance: Number | None = None,
    wear: Number | None = None,
    full: Flag = False,
    at: float | str | None = None,
    progress: Report | None = None,
) -> Result:
    """Compute the sheet of a drive, as suppliers of belt drives give it.

    Geometry, tensioner positions for all belts, and for each operating point of the duty and over speed tensions, hub
    loads and slip safety, at full and light load, while the driver accelerates and decelerates, over a range of
    friction; peaks with the torsional vibration under the harmonics of speeds and loads; first modes, and belts of
    standard length.

    Parameters
    ----------
    drive
        The drive, with a closed belt and one driver; or a web line, a conveyor or a guided belt, whose sheet has
        tensions, resistances, slack tensions by Euler's formula, sag and power at each operating point instead.
    table
        The duty table, a CSV file as for `duty`; by default the groups ``[[duty]]`` of the drive file, and without
        these the drive as it is.
    speed
        Speeds of the driver for the curves, such as "700..6000 rpm", in its sense of rotation, or in rad/s; by default
        over those of the duty, or up to that of the drive.
    points
        Number of speeds of a range.
    acceleration
        Angular acceleration of the driver, such as "3000 rpm/s", or in rad/s^2; by default none, and of a conveyor that
        of its speed over time, or by the largest torque of its motor.
    light_load
        Factor on all loads for light load, such as 0.1.
    friction
        Factors on all coefficients of friction of pulleys: the lowest, and others up to the highest.
    tolerance
        Tolerance of the belt length, as for `tensioner_sheet`.
    wear
        Elongation of the belt over its life, as for `tensioner_sheet`; of a conveyor for the travel of its take-up, in
        place of its permanent elongation and that by heat.
    full
        Also compute the duty with finite elements, as `duty`, and put its tensions and hub loads beside.
    at
        Instant at which the rest of the drive is evaluated, such as "0.5 s", or in s; by default the end of the
        simulation.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Along ``row`` the operating points, along ``speed`` the curves, along ``state`` the positions of the first
        tensioner, along ``standard`` belts of standard length, along ``mode`` the modes.

    Raises
    ------
    ModelError
        If the belt has ends, options are invalid, or the drive has no driver.
    ConvergenceError
        If the drive has no equilibrium at rest.

    Examples
    --------
    >>> found = bd.sheet(bd.example("alternator_drive"), acceleration="2000 rpm/s").dataset
    >>> found.slip_safety.dims, bool(found.mode_frequency[0] > 0.0)
    (('row', 'pulley'), True)
    """
    if drive.ends and not drive.is_web:
        raise ModelError("a drive sheet needs a closed belt. Use `beltdyn simulate` for a belt with ends.")
    options: dict[str, object] = {
        "speed": speed,
        "acceleration": acceleration,
        "light_load": light_load,
        "tolerance": tolerance,
        "wear": wear,
        "full": full,
    }
    if drive.is_web or drive.carries or drive.nips or drive.guides.any():
        return _sheet_of_line(drive, table, friction, at, options)
    columns = duty_of(drive, table)
    tell = progress or (lambda _: None)
    tell(Progress(0.0, 1.0, 0.0, 0, "equilibrium"))
    given = at_instant(drive, at)
    rest = bring_to_stand(prepare(averaged(given)))
    chosen = _Options(
        factors=numbers_in("friction", friction, "", 3),
        light=light_load,
        acceleration=_acceleration(acceleration),
        lengths=lengths_of(rest.prepared, tolerance, wear),
    )
    made = _DriveSheet(given, rest.prepared, looked_at(rest.prepared, rest.system, rest.state).installation, chosen)
    made.add_rows(columns)
    made.add_speeds(columns, speed, points)
    made.add_geometry()
    made.add_tensioning()
    made.add_alignment(drive)
    made.add_tensioner()
    made.add_belts()
    if full:
        made.add_full(drive, table, at, progress)
    result = build_result("sheet", rest.drive, made.variables, made.coordinates, list(made.warnings()))
    result.dataset.attrs |= {"drive_as_given": drive.text, "axes": _ROW, "title": f"Drive sheet of {drive.title}"}
    return result


def _sheet_of_line(
    drive: Drive, table: Path | str | None, friction: Numbers, at: float | str | None, options: Mapping[str, object]
) -> Result:
    """The sheet of a web line, or of a belt that carries or slides over guides."""
    rising = _acceleration(options["acceleration"]) or _steepest(drive)
    for name, value in options.items():
        if (name not in ("acceleration", "wear") or not drive.carries) and value != signature(sheet).parameters[
            name
        ].default:
            raise ModelError(
                f"{name} = {value} is an option for belts between pulleys alone. A sheet of a web line, a conveyor or "
                "a guided belt has operating points: give them as groups [[duty]], or as a CSV file with table."
            )
    columns, factors = duty_of(drive, table), numbers_in("friction", friction, "", 3)
    held = held_at(drive, at)
    wear = None if options["wear"] is None else lengths_of(prepare(drive), None, cast("Number", options["wear"]))[1]
    launch = Launch(rising, braking_forces(drive) - braking_forces(held))
    made = line_sheet(held, columns, factors, launch, wear)
    result = build_result("sheet", drive, made.variables, made.coordinates, made.warnings)
    result.dataset.attrs |= {"drive_as_given": drive.text, "axes": _ROW, "title": f"Drive sheet of {drive.title}"}
    return result


class _Options(NamedTuple):
    """What a user chose."""

    factors: FloatArray
    """On friction, ascending."""
    light: float
    acceleration: float
    """rad/s^2."""
    lengths: tuple[float, float]
    """Tolerance and wear, m."""


def _acceleration(given: Any) -> float:
    return number_in("acceleration", given if isinstance(given, str) else float(given), "rad/s^2")


def _steepest(drive: Drive) -> float:
    """The largest acceleration in the speed of the driver over time, rad/s^2."""
    speed = None if drive.driver is None else drive.pulleys[drive.driver].speed
    if speed is None:
        return 0.0
    times = np.linspace(drive.simulation.begin, drive.simulation.end, _INSTANTS)
    return float(np.max(np.diff(np.abs(speed.at(times)))) / (times[1] - times[0]))


class _DriveSheet:
    """Collects the sheet."""

    def __init__(self, given: Drive, prepared: Prepared, rest: Installation, options: _Options) -> None:
        self._given, self._prepared, self._rest, self._options = given, prepared, rest, options
        self._drive = prepared.drive
        self._steady = QuasiSteady(prepared, rest)
        self._driver = self._steady.driver
        self._radii = np.asarray(prepared.path.radii)
        self._excitations = excitations_of(given, self._driver)
        self._cases = {
            f"{name}{suffix}": (load, sense * options.acceleration)
            for name, load in (("full load", 1.0), ("light load", options.light))
            for suffix, sense in _ACCELERATIONS.items()
            if sense == 0.0 or options.acceleration > 0.0
        }
        self.variables: Table = {}
        tensioners = [one.pulley for one in self._drive.moving_tensioners]
        self.coordinates: Table = {
            _PULLEY: (COORDINATES[_PULLEY], [one.name for one in self._drive.pulleys]),
            _SPAN: (COORDINATES[_SPAN], ["-".join(one) for one in self._drive.spans]),
            "case": (Variable(("case",), "1", "Load and acceleration", "str"), list(self._cases)),
            "friction": (Variable(("friction",), "1", "Factor on friction"), options.factors),
            "axis": (COORDINATES["axis"], list(AXIS_NAMES)),
        }
        if tensioners:
            self.coordinates[_TENSIONER] = (COORDINATES[_TENSIONER], tensioners)
        self._notes = list[str]()

    # Operating points, and curves over speed

    def add_rows(self, columns: list[Column] | None) -> None:
        """States at the operating points."""
        columns = columns or [Column("duration", "", [PASS])]
        durations = durations_of(columns)
        drives = [at_row(self._drive, columns, row) for row in range(durations.size)]
        torques = [torques_of(one, self._driver) for one in drives]
        speeds = np.array([self._steady.belt_speed(one, by) for one, by in zip(drives, torques, strict=True)])
        loads = np.array([by(speed) for by, speed in zip(torques, speeds.tolist(), strict=True)])
        self._rows = [(speed, load) for speed, load in zip(speeds.tolist(), loads, strict=True)]
        names = [one.name or f"{number}" for number, one in enumerate(self._drive.duty, 1)]
        known = names if len(names) == durations.size else list(map(str, range(1, durations.size + 1)))
        self.coordinates[_ROW] = (Variable((_ROW,), "1", "Operating point", "str"), known)
        self.variables["duration"] = (Variable((_ROW,), "s", "Duration"), durations)
        full = self._add_states(_ROW, speeds, loads)
        self._add_utilization(full)
        self._add_lives(full, durations)
        self._heaviest = full, int(np.argmax(np.abs(full.torque[:, self._driver] * speeds)))
        self._add_modes()

    def add_speeds(self, columns: list[Column] | None, given: Numbers | None, points: int) -> None:
        """States over the speed of the driver."""
        radius, others = float(self._radii[self._driver]), torques_of(self._drive, self._driver)
        own = [abs(speed / radius) for speed, _ in self._rows]
        if given is None:
            if max(own) == 0.0:
                raise ModelError(
                    "the sheet needs speeds of the driver, whose prescribed speed is zero at the instant given. "
                    'Give them by speed, such as "100..3000 rpm".'
                )
            low = min(own) if max(own) > 1.01 * min(own) else _LEAST_SPEED * max(own)
            found = np.linspace(low, max(own), points)
        else:
            found = numbers_in("speed", given, "rad/s", points)
        if not found[0] > 0.0:
            raise ModelError(f"speed = {given!r} must be positive: speeds of the driver in its sense of rotation.")
        named = {one.pulley for one in columns or () if one.what in ("power", "torque")}
        pulleys = [number for number, one in enumerate(self._drive.pulleys) if one.name in named]
        by: Torques = torques_between(self._rows, pulleys, others) if pulleys else others
        speeds = np.sign(self._rows[0][0]) * abs(radius) * found
        name = self._drive.pulleys[self._driver].name
        self.coordinates[_SPEED] = (Variable((_SPEED,), "rad/s", f"Speed of {name}"), found)
        self._add_states(_SPEED, speeds, np.array([by(one) for one in speeds.tolist()]), "_over_speed")

    def _add_states(self, dim: str, speeds: FloatArray, loads: FloatArray, suffix: str = "") -> Running:
        """Tensions, hub loads and slip safety in all cases, and their peaks; gives the states at full load."""
        count, cases = speeds.size, list(self._cases.values())
        light = np.repeat([load for load, _ in cases], count)
        rate_ = np.repeat([one for _, one in cases], count) * abs(float(self._radii[self._driver]))
        states = self._steady.at(np.tile(speeds, len(cases)), np.tile(loads, (len(cases), 1)) * light[:, None], rate_)
        full = Running(*(values[:count] for values in states))
        tension = states.tension.reshape(len(cases), count, -1)
        largest = states.ends.max(axis=2).reshape(len(cases), count, -1)
        hub = np.linalg.norm(states.hub_force, axis=2).reshape(len(cases), count, -1)
        factors = self._options.factors
        by_all, by_own = (
            values.reshape(factors.size, len(cases), count, -1).swapaxes(0, 1)
            for values in self._steady.slip_safety(states, factors)
        )
        safety = np.fmin(by_all, by_own)
        nominal = int(np.argmin(np.abs(factors - 1.0)))
        swing = [self._amplitudes(full, row) for row in range(count)]
        tension_swing, hub_swing, way = (np.array(one) for one in zip(*swing, strict=True))
        every = {
            "belt_speed": (Variable((dim,), "m/s", "Belt speed"), np.abs(speeds)),
            **{
                name: (Variable((dim, _SPAN), "N", RECORDED[name].long_name), values)
                for name, values in zip(
                    SPAN_TENSIONS,
                    (full.tension, full.ends.max(axis=2), full.ends.min(axis=2), *np.moveaxis(full.ends, 2, 0)),
                    strict=True,
                )
            },
            "hub_load": (Variable((dim, _PULLEY), "N", "Hub load"), hub[0]),
            **{
                name: (Variable((dim, _PULLEY), "1", label), values[0, nominal])
                for (name, label), values in zip(SLIP_SAFETIES.items(), (by_all, by_own), strict=True)
            },
            "tension_of_case": (Variable((dim, "case", _SPAN), "N", "Span tension"), tension.transpose(1, 0, 2)),
            "slip_safety_of_case": (
                Variable((dim, "case", "friction", _PULLEY), "1", "Slip safety"),
                safety.transpose(2, 0, 1, 3),
            ),
            "least_slip_safety": (
                Variable((dim, _PULLEY), "1", "Least slip safety, over loads, accelerations and friction"),
                np.fmin.reduce(safety, axis=(0, 1)),
            ),
            "tension_amplitude": (Variable((dim, _SPAN), "N", "Amplitude of tension, all orders"), tension_swing),
            "hub_load_amplitude": (Variable((dim, _PULLEY), "N", "Amplitude of hub load, all orders"), hub_swing),
            "peak_tension": (
                Variable((dim, _SPAN), "N", "Peak tension"),
                np.fmax.reduce(largest, axis=0) + tension_swing,
            ),
            "peak_hub_load": (Variable((dim, _PULLEY), "N", "Peak hub load"), np.fmax.reduce(hub, axis=0) + hub_swing),
        }
        if self._drive.moving_tensioners:
            units = "rad" if all(one.turns for one in self._drive.moving_tensioners) else "m or rad"
            every["tensioner_position"] = (Variable((dim, _TENSIONER), units, "Tensioner position"), full.positions)
            every["tensioner_amplitude"] = (Variable((dim, _TENSIONER), units, "Amplitude of the tensioner"), way)
        if dim == _ROW:
            force, sense = full.hub_force, self._drive.positive_sense
            every |= {
                "hub_force": (Variable((dim, _PULLEY, "axis"), "N", "Force of the belt on the pulley"), force),
                "hub_direction": (
                    Variable((dim, _PULLEY), "rad", "Direction of the hub load"),
                    np.arctan2(force[..., 1], force[..., 0]),
                ),
                "shaft_torque": (Variable((dim, _PULLEY), "N m", "Shaft torque"), sense * full.torque),
                "power": (
                    Variable((dim, _PULLEY), "W", "Power into the drive"),
                    full.torque * speeds[:, None] / self._radii,
                ),
                "pulley_speed": (
                    Variable((dim, _PULLEY), "rad/s", "Pulley speed"),
                    sense * speeds[:, None] / self._radii,
                ),
            }
        self.variables |= {f"{name}{suffix}": one for name, one in every.items()}
        return full

    def _amplitudes(self, states: Running, row: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Amplitudes of tensions, hub loads and tensioners; zero without harmonics."""
        if not self._excitations or not np.isfinite(states.tension[row]).all():
            pulleys = self._radii.size
            return np.zeros(pulleys), np.zeros(pulleys), np.zeros(len(self._prepared.carriers))
        return amplitudes(self._prepared, self._given, self._excitations, states, row)

    def _add_utilization(self, full: Running) -> None:
        """Utilization of a belt that is rated, in each row."""
        if self._drive.rated_belt is None:
            return
        found = []
        for row, speed in enumerate(full.speed.tolist()):
            powers = full.torque[row] * speed / self._radii
            rated = rate(self._prepared, speed / self._radii, powers, full.centers[row])
            assert rated is not None
            found.append(utilization(self._drive, rated.power, powers))
        meaning = "Utilization: design power over rated power"
        self.variables["utilization"] = (Variable((_ROW, _PULLEY), "1", meaning), np.array(found))

    def _add_lives(self, full: Running, durations: FloatArray) -> None:
        """Lives of the belt under the duty, of those for which it has data."""
        known = [name for name in known_variables(self._drive) if name.endswith("_life")]
        held = np.isfinite(full.ends).all(axis=(1, 2))
        if not known or not held.any() or not durations[held].sum() > 0.0:
            return
        shares = durations[held] / durations[held].sum()
        found = [
            damage_of_tensions(self._prepared, ends, speed).times(share)
            for ends, speed, share in zip(full.ends[held], full.speed[held].tolist(), shares.tolist(), strict=True)
        ]
        lives = Lives(self._drive, reduce(Damage.plus, found))
        belt = self._drive.belt
        for name, life, data in (("cord", lives.cord, belt.cord_fatigue), ("rib", lives.rib, belt.rib_fatigue)):
            if f"{name}_life" in known and data is not None:
                bound = ", at least" * (name == "cord" and lives.is_bound)
                label = f"{data.life_name[0].upper()}{data.life_name[1:]} of the {name}s{bound}"
                self.variables[f"{name}_life"] = Variable((), "h", label), life

    def _add_modes(self) -> None:
        """First modes of the lumped drive in the row of the largest power."""
        states, row = self._heaviest
        if not np.isfinite(states.tension[row]).all():
            return
        lumped = lumped_at(self._prepared, states, row)
        found = lumped.modes(_MODES)
        parts = [
            ", ".join(
                dict.fromkeys(lumped.owners[part] for part in np.argsort(-one.shares) if one.shares[part] > _MOVES)
            )
            for one in found
        ]
        self.coordinates["mode"] = (Variable(_MODE, "1", "Mode", "int64"), np.arange(1, len(found) + 1))
        self.variables |= {
            "mode_frequency": (Variable(_MODE, "Hz", "Frequency"), [one.frequency for one in found]),
            "mode_damping": (Variable(_MODE, "1", "Damping ratio"), [one.damping_ratio for one in found]),
            "mode_parts": (Variable(_MODE, "1", "Parts with most of the energy", "str"), parts),
        }

    # At rest

    def add_geometry(self) -> None:
        """Pulleys and spans at rest."""
        prepared, rest, belt = self._prepared, self._rest, self._prepared.belt
        path, driver = rest.path, self._driver
        self.variables |= {
            "belt_length": (Variable((), "m", "Belt length, unstretched"), prepared.belt_length),
            "nominal_length": (Variable((), "m", "Nominal length"), belt.nominal_length_of(prepared.belt_length)),
            "tension_at_rest": (Variable((), "N", "Tension at rest"), rest.tension),
            "pitch_diameter": (Variable((_PULLEY,), "m", "Diameter of the tension line"), 2.0 * np.abs(self._radii)),
            "wrap_angle": (Variable((_PULLEY,), "rad", "Wrap angle"), path.wrap_angles),
            "speed_ratio": (
                Variable((_PULLEY,), "1", "Speed over that of the driver"),
                self._radii[driver] / self._radii,
            ),
            "friction_coefficient": (Variable((_PULLEY,), "1", "Friction with the wedge effect"), prepared.frictions),
            "center": (Variable((_PULLEY, "axis"), "m", "Center"), path.centers),
            "rest_hub_load": (Variable((_PULLEY,), "N", "Hub load at rest"), np.linalg.norm(rest.hub_loads, axis=1)),
            "span_length": (Variable((_SPAN,), "m", "Span length"), path.span_lengths),
        }
        if belt.entry is not None and belt.entry.is_v_belt and path.spans == 2:
            distance = float(np.linalg.norm(path.centers[1] - path.centers[0]))
            nominal = belt.nominal_length_of(prepared.belt_length)
            self.variables |= {
                "center_distance": (Variable((), "m", "Center distance"), distance),
                "fitting_allowance": (Variable((), "m", "Shorter center distance to fit belts"), FITTING * nominal),
                "tensioning_allowance": (
                    Variable((), "m", "Longer center distance to tension belts"),
                    TENSIONING * nominal,
                ),
            }
        tensions = np.column_stack([rest.span_tensions, rest.extreme_tensions, rest.end_tensions]).T
        for (name, label), values in zip(REST_TENSIONS.items(), tensions, strict=True):
            self.variables[name] = Variable((_SPAN,), "N", label), values

    def add_tensioning(self) -> None:
        """Frequency and deflection force of each span, new, run in, and before the belt is tensioned again."""
        needed = required_tension(self._drive, self._rest)
        checks = tension_checks(self._drive, self._rest, least=None if needed is None else needed.tension)
        if not checks:
            return
        if needed is not None:
            formula = Variable(("tension_formula",), "1", "Formula of the least tension", "str")
            self.coordinates["tension_formula"] = (formula, list(needed.by_formula))
            required = Variable(("tension_formula",), "N", "Least tension at rest with the service factor")
            self.variables["required_tension"] = (required, list(needed.by_formula.values()))
        deflection = DEFLECTION * self._rest.path.span_lengths
        self.coordinates["belt_state"] = (
            Variable(("belt_state",), "1", "State of the belt", "str"),
            [one.state for one in checks],
        )
        along = ("belt_state", _SPAN)
        frequency = Variable(along, "Hz", "First frequency of the span, plucked at rest")
        force = Variable(along, "N", "Force across the middle of the span that deflects it")
        self.variables |= {
            "deflection": (Variable((_SPAN,), "m", "Deflection of the middle of the span"), deflection),
            "tension_in_state": (Variable(("belt_state",), "N", "Tension"), [one.tension for one in checks]),
            "span_frequency": (frequency, [one.frequencies for one in checks]),
            "deflection_force": (force, [one.forces for one in checks]),
        }

    def add_alignment(self, drive: Drive) -> None:
        """Fleeting angles of the spans, their worst case over the tolerances of a drive file, and what is allowed."""
        found, ends = alignment(drive, self._rest.path), (_SPAN, "span_end")
        self._notes += map(str, judge_alignment(drive, self._rest.path))
        self.coordinates["span_end"] = (Variable(("span_end",), "1", "End of the span", "str"), ["leaving", "reaching"])
        self.variables |= {
            "fleeting_angle": (Variable(ends, "rad", "Fleeting angle"), found.angles),
            "worst_fleeting_angle": (Variable(ends, "rad", "Largest fleeting angle, over tolerances"), found.worst),
        }
        if np.isfinite(found.limit):
            self.variables |= {
                "allowed_fleeting_angle": (Variable((), "rad", "Fleeting angle that the belt allows"), found.limit),
                "allowed_offset": (Variable((_SPAN,), "m", "Axial offset still allowed"), found.allowed_offset),
            }

    def add_tensioner(self) -> None:
        """Positions of the first tensioner: without a belt, with belts of all lengths, and at its load stop."""
        if not self._prepared.carriers:
            return
        carrier, (spread, worn) = self._prepared.carriers[0], self._options.lengths
        one, balance, length = carrier.tensioner, self._steady.balance, self._prepared.belt_length
        longer = {"replace": spread + worn, "max": spread, "mean": 0.0, "min": -spread}
        states = balance.under(np.zeros((len(longer), self._radii.size)), 0.0, np.array(list(longer.values()))).states()
        lower, upper = one.stops or (-np.inf, np.inf)
        free = carrier.free_position
        rows = {}
        if np.isfinite(free):
            rows["free"] = (np.nan, free, 0.0)
        for place, (name, change) in enumerate(longer.items()):
            rows[name] = (length + change, float(states.positions[place, 0]), float(states.tension.mean[place].mean()))
        if np.isfinite(lower):
            change, tension = balance.held_at(0, lower)
            rows["load"] = (length + change, lower, tension)
        lengths, positions, tensions = np.array(list(rows.values())).T
        tensions = np.maximum(tensions, 0.0)  # a slack belt does not push
        places = [carrier.place(position) for position in positions.tolist()]
        paths = [self._path_at(0, position) for position in positions.tolist()]
        hub = [tension * (after - before) for tension, (before, after) in zip(tensions.tolist(), paths, strict=True)]
        rates = [float((before - after) @ way) for (before, after), (_, way) in zip(paths, places, strict=True)]
        turns, units, force = one.turns, "rad" if one.turns else "m", one.force_unit
        self.coordinates["state"] = (Variable(_STATE, "1", "Position", "str"), list(rows))
        self.variables |= {
            "state_belt_length": (Variable(_STATE, "m", "Belt length"), lengths),
            "state_position": (Variable(_STATE, units, "Position, from the nominal one"), positions),
            "state_spring": (Variable(_STATE, force, "Spring"), [carrier.force(q) for q in positions.tolist()]),
            "state_tension": (Variable(_STATE, "N", "Tension"), tensions),
            "state_hub_load": (
                Variable(_STATE, "N", "Hub load"),
                np.where(tensions > 0.0, np.linalg.norm(hub, axis=1), 0.0),
            ),
            "state_hub_direction": (
                Variable(_STATE, "rad", "Direction of the hub load"),
                np.arctan2(*np.array(hub).T[::-1]),
            ),
            "state_take_up": (Variable(_STATE, "m/rad" if turns else "1", "Take-up, path per travel"), rates),
        }
        if turns:
            angle = Variable(_STATE, "rad", "Arm angle, from the x axis")
            self.variables["state_arm_angle"] = angle, carrier.angle(positions)
        for name, (_, position, tension) in rows.items():
            if np.isnan(position):
                self._notes.append(
                    f"the tensioner of {one.pulley} was not found in equilibrium with the belt of the position {name}. "
                    "Change the belt length, the tolerance or wear, or the stops."
                )
            elif name in longer and not lower < position < upper:
                left = f"with {tension:.4g} N" if tension > _SLACK * self._rest.tension else "where the belt is slack"
                self._notes.append(
                    f"the belt of the position {name} moves the tensioner of {one.pulley} to its stop at "
                    f"{one.written(position)}, {left}. Change the belt length, the tolerance or wear, or the stops."
                )

    def _path_at(self, number: int, position: float) -> tuple[FloatArray, FloatArray]:
        """Directions of the spans before and after the pulley of a tensioner at a position."""
        positions = self._rest.tensioner_positions.copy()
        positions[number] = position
        path, pulley = self._steady.balance.path_at(positions), self._prepared.carriers[number].pulley
        own = self._prepared.path
        return path[own.reaching[pulley]], path[own.leaving[pulley]]

    def add_belts(self) -> None:
        """Belts of standard length beside the one that the drive has."""
        belt, length = self._prepared.belt, self._prepared.belt_length
        nominal = belt.nominal_length_of(length)
        known = sorted(belt.entry.lengths) if belt.entry is not None else []
        place = int(np.argmin(np.abs(np.array(known) - nominal))) if known else 0
        standard = known[max(place - _NEIGHBORS, 0) : place + _NEIGHBORS + 1]
        if not standard:
            return
        longer = (np.array(standard) - nominal) / belt.measured_stretch
        states = self._steady.balance.under(np.zeros((longer.size, self._radii.size)), 0.0, longer).states()
        tension = states.tension.mean.mean(axis=1)
        most = np.inf if belt.largest_tension is None else belt.largest_tension
        held = np.isfinite(tension) & (tension > _SLACK * self._rest.tension) & (tension <= most)
        self.coordinates["standard"] = (Variable(_STANDARD, "m", "Standard nominal length"), standard)
        self.variables |= {
            "standard_longer": (Variable(_STANDARD, "m", "Longer than the belt of the drive"), longer),
            "standard_tension": (Variable(_STANDARD, "N", "Tension at rest"), np.where(held, tension, np.nan)),
        }
        path = self._rest.path
        if path.spans == 2 and not self._prepared.carriers and not self._drive.belt.crossed:
            radii = float(abs(path.radii[0])), float(abs(path.radii[1]))
            lengths = path.length + longer * path.length / length
            distances = [center_distance(one, radii) or np.nan for one in lengths.tolist()]
            label = "Center distance for the same tension"
            self.variables["standard_center_distance"] = Variable(_STANDARD, "m", label), distances
        if self._prepared.carriers:
            places = np.where(held, states.positions[:, 0], np.nan)
            units = "rad" if self._prepared.carriers[0].tensioner.turns else "m"
            self.variables["standard_position"] = (Variable(_STANDARD, units, "Tensioner position"), places)
        fixed = [one for one in self._prepared.tensioners if isinstance(one, FixedTensioner)]
        if fixed:
            lengthens = float(self._rest.path.gradient(self._drive.carried(fixed[0])) @ np.array(fixed[0].direction))
            stretch = self._rest.path.length / length
            take_up = fixed[0].take_up + longer * stretch / lengthens
            self.variables["standard_take_up"] = (Variable(_STANDARD, "m", "Take-up for the same tension"), take_up)
            self.variables["take_up_rate"] = (Variable((), "1", "Path per take-up"), lengthens)

    def add_full(self, drive: Drive, table: Path | str | None, at: float | str | None, progress: Report | None) -> None:
        """The duty by finite elements."""
        if table is None and not drive.duty:
            drive = drive.replace(duty=[{"share": 1.0}])
        found = duty(drive, table=table, at=at, progress=progress).dataset
        for name, dim in (("span_tension", _SPAN), ("hub_load", _PULLEY), ("slip_safety", _PULLEY)):
            one = self.variables[name][0]
            meaning = f"{one.long_name}, by finite elements"
            self.variables[f"full_{name}"] = (Variable((_ROW, dim), one.units, meaning), found[name].values)

    def warnings(self) -> Iterator[str]:
        """What a designer has to look after."""
        yield from self._notes
        names = [one.name for one in self._drive.pulleys]
        rows, cases = self.coordinates[_ROW][1], list(self._cases)
        safety: NDArray[Any] = self.variables["slip_safety_of_case"][1]
        if np.isfinite(safety).any() and np.nanmin(safety) < 1.0:
            row, case, factor, pulley = np.unravel_index(int(np.nanargmin(safety)), safety.shape)
            yield (
                f"{names[pulley]} slips: its slip safety is {float(np.nanmin(safety)):.3g} at operating point "
                f"{rows[row]}, {cases[case]}, with {float(self._options.factors[factor]):.3g} times the friction. "
                f"Raise the tension or the wrap angle, or use {self._drive.belt.wider}."
            )
        lost = [rows[row] for row, one in enumerate(self.variables["span_tension"][1]) if not np.isfinite(one).all()]
        if lost:
            yield f"the belt holds no tension at the operating points {', '.join(lost)}. Raise the tension at rest."
        slack = self.variables["least_span_tension"][1] - self.variables["tension_amplitude"][1]
        if np.isfinite(slack).any() and np.nanmin(slack) < 0.0:
            row, span = np.unravel_index(int(np.nanargmin(slack)), slack.shape)
            yield (
                f"the span {self.coordinates[_SPAN][1][span]} gets slack in vibration at operating point {rows[row]}, "
                "where amplitudes of the linear response are no longer right. Raise the tension, or damp the drive."
            )
        most, peak = self._drive.belt.largest_tension, float(np.nanmax(self.variables["peak_tension"][1]))
        if most is not None and peak > most:
            yield (
                f"the peak tension is {peak:.4g} N, but the belt is rated for {most:.4g} N. Use "
                f"{self._drive.belt.wider}, or reduce tension or load."
            )
