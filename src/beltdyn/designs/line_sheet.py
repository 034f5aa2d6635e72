"""The sheet of a line: web lines, and belts that carry or slide over guides, from steady running at operating points.

Friction of guides, idlers and bearings sets the tensions, so each operating point is computed by finite elements. The
resistances of the strands of a conveyor are those of DIN 22101, by hand, beside the pull that is found.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, row
from beltdyn.designs.line_belt import STRETCHES, safety_values, safety_warnings, take_up, take_up_tensioner
from beltdyn.designs.line_motions import MOTIONS, Launch, Motions
from beltdyn.kernel import interpreted
from beltdyn.machines import Idlers
from beltdyn.machines.carrying.support import Support
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.carrying import stretch_of, upper_side
from beltdyn.model.layout import leverage
from beltdyn.points.duty import Column, at_row, durations_of
from beltdyn.results import Run, Variable
from beltdyn.results.derived import nips
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.schema import COORDINATES, RECORDED, SLIP_SAFETIES
from beltdyn.results.summary import Means, means_of
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_state

LARGEST_SAG = 0.01
"""Sag between idlers over their spacing to which the least tension belongs (DIN 22101)."""

Values = dict[str, tuple[Variable, Any]]
_ROW, _PULLEY, _SPAN, _TENSIONER, _ROLL, _NIP = "row", "pulley", "span", "tensioner", "roll", "nip"
_MOTION, _IDLERS = "motion", "idlers"

RESISTANCES = {
    "main_resistance": "Main resistance of idlers, and friction of guides",
    "secondary_resistance": "Secondary resistance, (C - 1) of the main one",
    "slope_resistance": "Slope resistance of the belt",
    "goods_resistance": "Slope resistance of the goods",
}
"""Resistances of a span against the running belt, N, by hand."""


NIPS = (
    *("force", "width", "peak_pressure", "gap", "thickness_after", "speed_ratio", "tension_before", "tension_after"),
    "compression_loss",
)
"""What a sheet has of `beltdyn.derived.nips`."""


class LineSheet(NamedTuple):
    """Variables and coordinates of a sheet, and what a designer has to look after."""

    variables: Values
    coordinates: Values
    warnings: list[str]


def line_sheet(
    given: Drive, columns: list[Column] | None, factors: FloatArray, launch: Launch, wear: float | None = None
) -> LineSheet:
    """The sheet of a line, whose speeds and loads are those of an instant.

    `given`: a web line, or a belt that carries or slides over guides; `columns`: the duty; none for the drive as it is;
    `factors`: on friction, ascending; `launch`: how it starts and stops; `wear`: elongation of the belt, m.
    """
    durations = durations_of(columns) if columns else np.ones(1)
    drives = [at_row(given, columns, number) for number in range(durations.size)] if columns else [given]
    names = [one.name or f"{number}" for number, one in enumerate(given.duty, 1)]
    rows, run = list[_Row](), None
    for one in drives:
        run = steady_state(one, start=run)
        rows.append(_Row(run, factors, launch))
    first = rows[0]
    coordinates: Values = {
        _ROW: (
            Variable((_ROW,), "1", "Operating point", "str"),
            names if len(names) == durations.size else list(map(str, range(1, durations.size + 1))),
        ),
        _PULLEY: (COORDINATES[_PULLEY], [one.name for one in given.pulleys]),
        _SPAN: (COORDINATES[_SPAN], ["-".join(one) for one in given.spans]),
        "friction": (Variable(("friction",), "1", "Factor on friction"), factors),
    }
    if given.carries:
        coordinates[_MOTION] = (Variable((_MOTION,), "1", "Motion", "str"), list(MOTIONS))
    if first.idlers:
        places = ["-".join(one.span) for one in first.idlers]
        coordinates[_IDLERS] = (Variable((_IDLERS,), "1", "Span of the idlers", "str"), places)
    if given.moving_tensioners:
        coordinates[_TENSIONER] = (COORDINATES[_TENSIONER], [one.pulley for one in given.moving_tensioners])
    if given.rolls:
        coordinates[_ROLL] = (COORDINATES[_ROLL], [one.name for one in given.rolls])
    if given.nips:
        rollers = [given.pulleys[roller].name for roller, _ in first.prepared.path.nips_by_roller]
        coordinates[_NIP] = (COORDINATES[_NIP], rollers)
    found = [dict(one.values()) for one in rows]
    variables = {
        name: (replace(variable, dims=(_ROW, *variable.dims)), np.array([one[name][1] for one in found]))
        for name, (variable, _) in found[0].items()
    }
    variables["duration"] = Variable((_ROW,), "s", "Duration"), durations
    at_rest = bring_to_stand(prepare(given)).tension
    variables |= _geometry(first.prepared, at_rest) | {
        "tension_at_rest": (Variable((), "N", "Tension at rest"), np.array(at_rest))
    }
    meaning = "Running direction: 1 in the order of the pulleys, -1 against it"
    variables["running_sense"] = Variable((), "1", meaning), np.array(first.sense)
    warnings = list(dict.fromkeys(text for one in rows for text in one.run.warnings))
    for name, point, values in zip(coordinates[_ROW][1], rows, found, strict=True):
        warnings += [*_row_warnings(name, point, factors), *safety_warnings(given, values, name)]
    if given.carries:
        travel, short = take_up(first.prepared, variables, wear)
        variables, warnings = variables | travel, warnings + short
    return LineSheet(variables, coordinates, warnings)


def _geometry(prepared: Prepared, at_rest: float) -> Values:
    """What is alike at all operating points, with the tension at rest, N."""
    drive, path, law = prepared.drive, prepared.installation.path, prepared.belt.stretch_parameters
    stretched: Values = {
        "stretch_at_rest": (
            Variable((), "m", "Stretch of the belt at rest"),
            (float(law.stretch(at_rest)) - 1.0) * prepared.belt_length,
        ),
        "take_up_ratio": (
            Variable((), "1", "Length taken up, over the travel of the take-up"),
            take_up_ratio(prepared),
        ),
    }
    return (stretched if drive.carries else {}) | {
        "belt_length": (Variable((), "m", "Belt length, unstretched"), prepared.belt_length),
        "pitch_diameter": (Variable((_PULLEY,), "m", "Diameter of the tension line"), 2.0 * np.abs(path.radii)),
        "friction_coefficient": (Variable((_PULLEY,), "1", "Friction with the wedge effect"), prepared.frictions),
        "span_length": (Variable((_SPAN,), "m", "Span length"), path.span_lengths),
        "largest_idler_spacing": (
            Variable((_SPAN,), "m", "Spacing of idlers"),
            [
                max((one.free_length for one in drive.supports if one.span == span), default=np.nan) or np.nan
                for span in drive.spans
            ],
        ),
    }


class _Row:
    """An operating point."""

    def __init__(self, run: Run, factors: FloatArray, launch: Launch) -> None:
        self.run, self.prepared, self.factors, self.launch = run, run.prepared, factors, launch
        self.drive: Drive = run.drive
        self.at = run.dataset.isel(time=-1, field_time=-1)
        self.means: Means = means_of(run)
        self.tension = SpanTension.of(lambda name: np.asarray(self.at[name].values))
        self.before, self.after = self.tension.at_arcs(self.prepared)
        speeds = self.at["belt_speed"].values
        self.sense = 1.0 if float(speeds.mean()) >= 0.0 else -1.0

    def values(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Its variables, without the dimension of operating points."""
        yield from self._of_pulleys()
        yield from self._of_spans()
        if self.drive.carries:
            yield from self._of_starts()
        if self.idlers:
            yield from self._of_idlers()
        if self.drive.moving_tensioners:
            yield from self._of_tensioners()
        if self.drive.rolls:
            for name in ("roll_radius", "roll_inertia", "roll_speed", "roll_torque"):
                one = self.at[name]
                yield name, (Variable((_ROLL,), one.attrs["units"], one.attrs["long_name"]), one.values)
        if self.drive.nips:
            found = nips(self.run)
            for name in NIPS:
                one = found[name]
                yield f"nip_{name}", (Variable((_NIP,), one.attrs["units"], one.attrs["long_name"]), one.values)
        balance = self.means.balance
        yield "power_in", (Variable((), "W", "Power input"), balance.power_in)
        yield "power_out", (Variable((), "W", "Power output"), balance.power_out)
        yield "loss", (Variable((), "W", "Losses"), balance.lost)
        if self.drive.carries:
            meaning = "Power that lifts goods, part of the output; below zero part of the input, of goods that go down"
            yield "lifting_power", (Variable((), "W", meaning), balance.lifted)

    def _of_pulleys(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        pulleys = self.means.pulleys
        columns = {
            "pulley_speed": ("rad/s", "Pulley speed", "speed"),
            "shaft_torque": ("N m", "Shaft torque", "shaft_torque"),
            "power": ("W", "Power into the drive", "power"),
            "pulley_slip": ("1", "Slip", "slip"),
            **{name: ("1", label, name) for name, label in SLIP_SAFETIES.items()},
            "tension_ratio": ("1", "Tension ratio", "tension_ratio"),
            "allowed_tension_ratio": ("1", "Tension ratio that friction allows", "allowed_tension_ratio"),
            "wrap_angle": ("rad", "Wrap angle", "wrap_angle"),
            "hub_load": ("N", "Hub load", "hub_load"),
        }
        for name, (unit, meaning, field) in columns.items():
            yield name, (Variable((_PULLEY,), unit, meaning), [getattr(one, field) for one in pulleys])
        force = self.at["hub_force"].values
        yield (
            "hub_direction",
            (Variable((_PULLEY,), "rad", "Direction of the hub load"), np.arctan2(force[:, 1], force[:, 0])),
        )
        reached, left = (self.before, self.after)[:: int(self.sense)]
        yield "tension_before", (Variable((_PULLEY,), "N", "Tension where the belt reaches the pulley"), reached)
        yield "tension_after", (Variable((_PULLEY,), "N", "Tension where the belt leaves the pulley"), left)
        meaning = "Least tension on the slack side without gross slip (Euler)"
        yield "least_slack_tension", (Variable((_PULLEY, "friction"), "N", meaning), self.least_slack_tension)

    @cached_property
    def least_slack_tension(self) -> FloatArray:
        """Slack tension that Euler's formula needs for the pull of each pulley, shape (pulleys, factors), N."""
        prepared, speed = self.prepared, self.at["belt_speed"].values
        wrap = self.at["wrap_angle"].values
        pull = np.abs(self.after - self.before)
        grown = np.expm1(self.factors * (prepared.frictions * wrap)[:, None])
        none = np.full_like(grown, np.nan)  # where the belt does not wrap, as on the roller of a nip
        needed = np.divide(pull[:, None], grown, out=none, where=grown > 0.0)
        return np.asarray(needed + prepared.belt.mass_per_length * float(speed.mean()) ** 2)

    def _of_spans(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Tensions at the ends of spans in running direction, stretch and, of what carries, resistances."""
        speed, law = np.abs(self.at["belt_speed"].values), self.prepared.belt.stretch_parameters
        first, last = self.span_ends
        mean = self.tension.mean
        yield "span_tension", (Variable((_SPAN,), "N", "Span tension"), mean)
        yield "tension_at_start", (Variable((_SPAN,), "N", "Tension at the start of the span"), first)
        yield "tension_at_end", (Variable((_SPAN,), "N", "Tension at the end of the span"), last)
        for name in ("largest_span_tension", "least_span_tension"):
            yield name, (Variable((_SPAN,), "N", RECORDED[name].long_name), self.at[name].values)
        yield "belt_speed", (Variable((_SPAN,), "m/s", "Belt speed"), speed)
        yield "span_strain", (Variable((_SPAN,), "1", "Strain"), law.stretch(mean) - 1.0)
        # stretch and speed of gripped belt go together, so draws against the first span are those of strains
        yield "draw", (Variable((_SPAN,), "1", "Belt speed above that where it enters"), speed / speed[self._entry] - 1)
        if not self.drive.carries:
            return
        for name, values in self.resistances().items():
            yield name, (Variable((_SPAN,), "N", RESISTANCES[name]), values)
        yield "span_pull", (Variable((_SPAN,), "N", "Rise of the tension along the span"), last - first)
        yield "goods_mass", (Variable((_SPAN,), "kg/m", "Mass of goods"), self.goods_mass)
        needed, sag = self.sag
        meaning = f"Least tension for a sag of {LARGEST_SAG:.0%} between idlers"
        yield "least_tension_for_sag", (Variable((_SPAN,), "N", meaning), needed)
        yield "sag", (Variable((_SPAN,), "1", "Largest sag between idlers, over their spacing"), sag)

    @property
    def _entry(self) -> int:
        """The span where a web enters; of a closed belt that into which the driver runs."""
        path = self.drive.path
        behind = path.leaving if self.sense > 0.0 else path.reaching
        return -1 if self.drive.ends else int(behind[self.drive.reference])

    @cached_property
    def span_ends(self) -> tuple[FloatArray, FloatArray]:
        """Tensions at start and end of each span in running direction, shape (spans,), N."""
        starts, ends = self.tension.start, self.tension.end
        return (starts, ends) if self.sense > 0.0 else (ends, starts)

    def _of_starts(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Start at constant acceleration of a belt that moves as a whole, holdback, and what a take-up takes."""
        motions = self.motions
        running, starting = float(np.sum(motions.pulls)), float(np.sum(motions.pulls_on_belt[0]))
        yield "moved_mass", (Variable((), "kg", "Mass moved by the belt, with rotating ones"), motions.mass)
        yield "acceleration", (Variable((), "m/s^2", "Acceleration of the belt in starts"), motions.accelerations[0])
        yield "running_pull", (Variable((), "N", "Pull of the drives in steady running"), running)
        yield "start_pull", (Variable((), "N", "Pull of the drives in starts"), starting)
        slack, needed = motions.slack
        yield "start_slack_tension", (Variable((_PULLEY,), "N", "Slack tension of drives in starts"), slack)
        yield "least_start_slack_tension", (Variable((_PULLEY,), "N", "Least of it, by Euler's formula"), needed)
        yield from self._of_motions()
        yield from safety_values(self.drive, self.at["largest_span_tension"].values, motions)
        lift = sum(float(np.sum(self.resistances()[name])) for name in ("slope_resistance", "goods_resistance"))
        holds = abs(lift) * float(np.abs(self.prepared.installation.path.radii)[self.drive.reference])
        meaning = "Torque that holds the belt at the driver, without friction of idlers and guides"
        yield "holdback_torque", (Variable((), "N m", meaning), holds)
        for (name, label), ends in zip(STRETCHES.items(), (motions.ends, motions.tensions[0]), strict=True):
            yield name, (Variable((), "m", label), self._stretch(ends))

    def _of_motions(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Start, coasting and emergency stop at constant acceleration of a belt that moves as a whole."""
        motions, speed = self.motions, self.motions.speed
        rates = motions.accelerations * np.array([1.0, -1.0, -1.0])
        rates = np.where(rates > 0.0, rates, np.nan)
        goods, ends = float(np.max(self.goods_mass, initial=0.0)), motions.tensions
        columns = {
            "motion_rate": ("m/s^2", "Acceleration or deceleration of the belt", rates),
            "motion_time": ("s", "Time", speed / rates),
            "motion_travel": ("m", "Travel of the belt", 0.5 * speed**2 / rates),
            "motion_goods": ("kg", "Goods that leave the belt in it", 0.5 * speed**2 / rates * goods),
            "motion_brakes": ("N", "Force of the brakes on the belt", np.array([0.0, 0.0, self.launch.braking.sum()])),
            "motion_largest_tension": ("N", "Largest tension", ends.max(axis=(1, 2))),
            "motion_least_tension": ("N", "Least tension", ends.min(axis=(1, 2))),
        }
        for name, (unit, meaning, values) in columns.items():
            yield name, (Variable((_MOTION,), unit, meaning), values)
        forces = motions.shaft_forces
        powered = {
            "motion_torque": ("N m", "Torque of drive and brake, positive if it drives", forces * motions.radii),
            "motion_power": ("W", "Largest power of drive and brake into the belt", forces * speed),
            "motion_pull": ("N", "Pull of drive and brake on the belt", motions.pulls_on_belt),
            "motion_tension_ratio": ("1", "Tight over slack effective tension", motions.tension_ratios),
        }
        for name, (unit, meaning, values) in powered.items():
            shown = np.where(motions.powered, values, np.nan)
            yield name, (Variable((_MOTION, _PULLEY), unit, meaning), shown)

    def _of_idlers(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        """Number, load and speed of the idlers of each support that has them."""
        drive, path = self.drive, self.prepared.installation.path
        speed, gravity = float(np.abs(self.at["belt_speed"].values).mean()), np.array(drive.gravity)
        columns: dict[str, list[float]] = {"count": [], "spacing": [], "load": [], "speed": []}
        for one in self.idlers:
            place = stretch_of(one, drive.spans, path)
            down = abs(float(upper_side(place.direction, drive.gravity) @ gravity))
            carried = self.prepared.belt.mass_per_length + self.goods_mass[place.span]
            columns["count"].append(place.length / one.spacing)
            columns["spacing"].append(one.spacing)
            columns["load"].append((carried * one.spacing + one.idler_mass) * down)
            columns["speed"].append(np.nan if one.idler_diameter is None else 2.0 * speed / one.idler_diameter)
        units = {"count": "1", "spacing": "m", "load": "N", "speed": "rad/s"}
        words = {"count": "Number of idlers", "load": "Load of an idler, with its rotating parts"}
        for name, values in columns.items():
            label = words.get(name, f"{name.capitalize()} of idlers")
            yield f"idler_{name}", (Variable((_IDLERS,), units[name], label), values)

    @cached_property
    def idlers(self) -> list[Idlers]:
        """Supports that are idlers."""
        return [one for one in self.drive.supports if isinstance(one, Idlers)]

    def _stretch(self, ends: FloatArray) -> float:
        """Stretch of the belt, m, by tensions at starts and ends of spans, linear between; arcs have their mean."""
        path = self.prepared.installation.path
        thinner = 1.0 - 1.0 / self.prepared.belt.stretch_parameters.stretch(ends)
        around = float(np.sum(np.abs(path.radii) * path.wrap_angles))
        return float(np.sum(thinner.mean(axis=0) * path.span_lengths) + thinner.mean() * around)

    @cached_property
    def motions(self) -> Motions:
        """How it starts and stops."""
        return Motions(self.run, np.array(self.span_ends), self.launch)

    def _of_tensioners(self) -> Iterator[tuple[str, tuple[Variable, Any]]]:
        places, carriers = [one.position for one in self.means.tensioners], self.prepared.carriers
        units = "rad" if all(one.tensioner.turns for one in carriers) else "m or rad"
        yield "tensioner_position", (Variable((_TENSIONER,), units, "Tensioner position"), places)
        forces = [one.force(place) for one, place in zip(carriers, places, strict=True)]
        yield "tensioner_force", (Variable((_TENSIONER,), "N or N m", "Force of the tensioner"), forces)

    @cached_property
    def goods_mass(self) -> FloatArray:
        """Mass of goods on each span, kg/m."""
        spans = self.drive.spans
        return np.array([sum(one.mass_per_length for one in self.drive.goods if one.span == span) for span in spans])

    def resistances(self) -> dict[str, FloatArray]:
        """Resistances of each span against the running belt by the equations of DIN 22101, N."""
        drive, path, belt = self.drive, self.prepared.installation.path, self.prepared.belt
        gravity = np.array(drive.gravity)
        found = {name: np.zeros(len(drive.spans)) for name in RESISTANCES}
        against = -self.sense * path.span_directions @ gravity
        found["slope_resistance"] += belt.mass_per_length * against * path.span_lengths
        for one in drive.goods:
            place = stretch_of(one, drive.spans, path)
            found["goods_resistance"][place.span] += one.mass_per_length * against[place.span] * place.length
        for support in drive.supports:
            place = stretch_of(support, drive.spans, path)
            down = abs(float(upper_side(place.direction, drive.gravity) @ gravity))
            main, secondary = self._friction_of(support, place.start, place.end, down)
            found["main_resistance"][place.span] += main
            found["secondary_resistance"][place.span] += secondary
        return found

    def _friction_of(self, support: Support, start: float, end: float, down: float) -> tuple[float, float]:
        """Main and secondary resistance of a support, N, with the acceleration normal to its span, m/s^2."""
        length, path = end - start, self.prepared.installation.path
        weight = self.prepared.belt.mass_per_length * length
        for one in self.drive.goods:
            if one.span == support.span:
                place = stretch_of(one, self.drive.spans, path)
                weight += one.mass_per_length * max(0.0, min(end, place.end) - max(start, place.start))
        normal, speed = weight * down / length, float(np.abs(self.at["belt_speed"].values).mean())
        values = support.values(float(np.linalg.norm(self.drive.gravity)))
        constants = row(support.constants, **values)
        force = length * interpreted(type(support).resistance_at)(constants, normal, speed).force
        if not isinstance(support, Idlers):
            return force, 0.0
        further = length * (support.resistance + support.linear * speed)
        main = (force - further) / support.secondary_factor
        return main + further, force - further - main

    @cached_property
    def sag(self) -> tuple[FloatArray, FloatArray]:
        """Least tension of each span for the largest sag between idlers, and the sag that is found."""
        drive, path, goods = self.drive, self.prepared.installation.path, self.goods_mass
        least = self.at["least_span_tension"].values
        needed = np.full(len(drive.spans), np.nan)
        for support in drive.supports:
            place = stretch_of(support, drive.spans, path)
            if support.free_length > 0.0:
                down = abs(float(upper_side(place.direction, drive.gravity) @ np.array(drive.gravity)))
                load = down * (self.prepared.belt.mass_per_length + goods[place.span])
                needed[place.span] = np.fmax(needed[place.span], load * support.free_length / (8.0 * LARGEST_SAG))
        return needed, LARGEST_SAG * needed / least


def take_up_ratio(prepared: Prepared) -> float:
    """Change of the path's length over the travel of the first tensioner along a line; not a number without one."""
    tensioner = take_up_tensioner(prepared)
    if tensioner is None:
        return np.nan
    return abs(leverage(prepared.installation.path, prepared.drive.carried(tensioner), tensioner))


def _row_warnings(name: str, point: _Row, factors: FloatArray) -> Iterator[str]:
    """What a designer has to look after at an operating point."""
    slack = np.minimum(point.before, point.after)
    needed = point.least_slack_tension[:, 0]
    for number in np.flatnonzero((slack < needed) & ~point.drive.guides):
        yield (
            f"{point.drive.pulleys[number].name} slips at operating point {name} with {factors[0]:.3g} times the "
            f"friction: its slack tension is {slack[number]:.4g} N, Euler's formula needs {needed[number]:.4g} N. "
            "Raise the tension or the wrap angle, or share the pull with another drive."
        )
    if point.drive.carries:
        yield from point.motions.warnings(name)
        needed, sag = point.sag
        for number in np.flatnonzero(sag > LARGEST_SAG):
            yield (
                f"the belt sags by {sag[number]:.2%} of the idler spacing in the span "
                f"{'-'.join(point.drive.spans[number])} at operating point {name}: {LARGEST_SAG:.0%} needs "
                f"{needed[number]:.4g} N. Raise the tension, or place idlers closer."
            )
