"""Tensioner sheet: position, tension and hub load of a tensioner for belts of all lengths."""

from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError, TimeLimitError
from beltdyn.machines.tensioners.tensioner import MovingTensioner
from beltdyn.model import Drive, Installation, Prepared, estimate_at_rest, prepare
from beltdyn.model.carrier import moved
from beltdyn.model.static_estimate import held_belt
from beltdyn.parts.messages import Finding, reason
from beltdyn.parts.options import takes_options
from beltdyn.parts.quantity import Number, to_si
from beltdyn.points.changed_drive import require_belt
from beltdyn.points.operating_points import Axes
from beltdyn.results import Result, Variable, build_result
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.solvers.time_limit import time_limit
from beltdyn.state.installation import looked_at
from beltdyn.state.staying import bring_to_stand, first_fineness, stand

_FINENESS = 1.2
"""Of the meshes."""
_POSITION_TOLERANCE = 1e-9
"""Of the place at a stop, over the way on which the path lengthens by itself."""
_MAX_SECANT_STEPS = 20
"""Steps of the secant method for the length of the belt at a stop; a safeguard, after which the last row is taken."""
_LONGEST_SEARCH = 30.0
"""Processor time of all searches for equilibrium, s, after which closed forms take their place; sheets of the examples
take below 5 s."""
_FREE, _NOMINAL = "free arm", "nominal belt"
_OTHERS = ("longest belt", _NOMINAL, "shortest belt")
_WORN, _STRETCHED = ("worn belt", "0.5 %", "1 %"), ("stretched belt", "0.1 %", "0.1 %")
"""Name of the longest belt after its life, length tolerance and elongation of friction and of toothed belts; ISO 5296
allows 0.66 mm of 0.9 m, the elongation of glass cords is an estimate."""
_STATE = ("state",)


class _Column(NamedTuple):
    """A variable of the sheet."""

    line: tuple[str, str]
    """Unit and meaning of a tensioner that slides along a line."""
    arm: tuple[str, str]
    """The same of one on an arm."""

    def variable(self, turns: bool) -> Variable:
        """What it is for a tensioner of either kind."""
        return Variable(_STATE, *(self.arm if turns else self.line))


def _of_both(units: str, meaning: str) -> _Column:
    return _Column((units, meaning), (units, meaning))


COLUMNS = {
    "belt_length": _of_both("m", "Belt length"),
    "position": _Column(("m", "Position, from the given center"), ("rad", "Travel, from the given center")),
    "arm_angle": _of_both("rad", "Arm angle, counter-clockwise from the x axis"),
    "from_free": _Column(("m", "Deflection, from the free spring"), ("rad", "Deflection, from the free arm")),
    "spring_load": _Column(("N", "Spring force"), ("N m", "Spring torque")),
    "leverage": _Column(("1", "Take-up rate, path per travel"), ("m", "Take-up rate, path per rad")),
    "wrap_angle": _of_both("rad", "Wrap angle"),
    "tension": _of_both("N", "Tension"),
    "tension_after_tensioning": _of_both("N", "After tensioning: lower tension limit of dry friction"),
    "tension_after_yielding": _of_both("N", "After yielding: upper tension limit of dry friction"),
    "hub_load": _of_both("N", "Hub load"),
    "hub_direction": _of_both("rad", "Direction, of the hub load"),
    "slack": _of_both("m", "Slack, at the lower stop"),
}
"""Columns of a tensioner sheet for each state."""


@takes_options
def tensioner_sheet(
    drive: Drive,
    *,
    pulley: str | None = None,
    tolerance: Number | None = None,
    wear: Number | None = None,
    progress: Report | None = None,
) -> Result:
    """Compute a tensioner sheet: position, tension and hub load of a tensioner for belts of different lengths.

    The belt is at rest, in equilibrium. The nominal belt is that of the drive file; the longest and the shortest belt
    differ from it by the tolerance, and the worn belt, of a toothed one the stretched belt, is the longest one after
    its life. For a stop the sheet gives the belt length at which the tensioner just reaches it. Dry friction gives a
    range of tensions.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The pulley of the tensioner; by default that of the only moving tensioner.
    tolerance
        Length tolerance of a new belt, such as "6 mm" or "0.5 %", or in m; by default 0.5 %, of a toothed one 0.1 %.
    wear
        Elongation of the belt over its life, such as "10 mm" or "1 %", or in m; by default 1 %, of a toothed one 0.1 %.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Variables along ``state``, from the free arm to the lower stop; the attribute ``pulley`` names the pulley.

    Raises
    ------
    ModelError
        If the drive has no moving tensioner, or several without a choice by pulley, or if tolerance or wear is not a
        length.
    ConvergenceError
        If no static equilibrium of the nominal belt is found. After 30 s of processor time closed forms take the
        place of searches, with a warning.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> sheet = bd.tensioner_sheet(drive.replace(tensioner=[slide]), tolerance="1 mm", wear="2 mm")
    >>> sheet.dataset.tension.sel(state="worn belt").round().item()  # N
    30.0
    """
    require_belt(drive, "a tensioner sheet", "`beltdyn operating-map`, which has the positions of dancers")
    number = _number_of(drive, pulley)
    tell = progress or (lambda _: None)
    tell(Progress(0.0, drive.simulation.duration, 0.0, 0, "equilibrium"))
    with time_limit(_LONGEST_SEARCH):
        return _sheet(drive, number, tolerance, wear)


def _sheet(drive: Drive, number: int, tolerance: Number | None, wear: Number | None) -> Result:
    """The states of a tensioner, from the free arm to the lower stop."""
    try:
        rest = bring_to_stand(prepare(drive)).prepared
    except TimeLimitError:
        rest = estimate_at_rest(prepare(drive))[0]
    held = rest.replace(contact=rest.contact)
    sheet = _Sheet(held, number)
    nominal = held.belt_length
    spread, worn = lengths_of(held, tolerance, wear)
    longer = (spread + worn, spread, 0.0, -spread)
    lengths = {name: nominal + more for name, more in zip((_aged(held)[0], *_OTHERS), longer, strict=True)}
    sheet.add_free()
    sheet.add_stop("upper stop")
    for state, length in lengths.items():
        sheet.add_belt(state, length)
    sheet.add_stop("lower stop")
    return sheet.result(drive.text)


class _Sheet:
    """The states of a tensioner, one after the other."""

    def __init__(self, prepared: Prepared, number: int) -> None:
        self._prepared, self._number = prepared, number
        self._carrier = prepared.carriers[number]
        self._tensioner = self._carrier.tensioner
        self._rows = dict[str, dict[str, float]]()
        self._belts = (_aged(prepared)[0], *_OTHERS)
        self._failures = dict[str, str]()
        self._by_closed_forms = False
        lower, upper = self._tensioner.stops or (-np.inf, np.inf)
        spring = self._tensioner.spring
        pushes = {name: sense * spring[f"{name}_friction"] for name, sense in (("tensioning", -1.0), ("yielding", 1.0))}
        self._frictions = pushes if any(pushes.values()) else {}
        self._stops = {"upper stop": upper, "lower stop": lower}
        self._free = self._carrier.free_position
        at_lower = self._placed(lower)
        self._shortest = moved(prepared.path, prepared.carriers, at_lower).length if np.isfinite(lower) else np.nan

    def add_free(self) -> None:
        """The tensioner without a belt, where its spring has no force or its stop holds it."""
        if np.isfinite(self._free):
            self._rows[_FREE] = {
                "position": self._free,
                "from_free": 0.0,
                "spring_load": self._carrier.force(self._free),
                "tension": 0.0,
                "hub_load": 0.0,
            }

    def add_belt(self, state: str, length: float) -> None:
        """A belt of a length, m."""
        try:
            self._rows[state] = self._row(self._prepared, length)
        except (ConvergenceError, ModelError) as error:
            if state == _NOMINAL:
                raise
            self._failures[state] = str(error)
            self._rows[state] = {"belt_length": length}

    def add_stop(self, state: str) -> None:
        """The belt with which the tensioner just reaches a stop; None without a stop."""
        stop = self._stops[state]
        if np.isfinite(stop):
            free = self._tensioner.replace(stops=None, stop_stiffness=None, stop_damping=0.0)
            try:
                self._rows[state] = self._at(self._with(free), stop)
            except (ConvergenceError, ModelError, ValueError) as error:
                self._failures[state] = str(error)
                self._rows[state] = {"position": stop}

    def _at(self, prepared: Prepared, stop: float) -> dict[str, float]:
        """The row of the belt that brings a tensioner without stops to a place, m or rad, by the secant method."""
        length = held_belt(
            prepared.path, prepared.belt, prepared.contact, prepared.carriers, self._placed(stop), self._number
        ).length
        slope, before = None, None
        for _ in range(_MAX_SECANT_STEPS):
            row = self._row(prepared, length)
            missing = stop - row["position"]
            if abs(missing) <= _POSITION_TOLERANCE * max(1.0, abs(stop)):
                break
            if before is not None and before[1] != missing:
                slope = (length - before[0]) / (before[1] - missing)
            before = length, missing
            length += missing * (slope or row["leverage"])
        return row

    def _row(self, prepared: Prepared, length: float) -> dict[str, float]:
        """The row of a belt of a length, m."""
        prepared = prepared.replace(belt=prepared.drive.belt.replace(length=length))
        there, tensioner = self._balanced(prepared), prepared.carriers[self._number].tensioner
        carrier, position = prepared.carriers[self._number], float(there.tensioner_positions[self._number])
        force = there.hub_loads[carrier.pulley]
        row = {
            "belt_length": length,
            "position": position,
            "from_free": self._free - position,
            "spring_load": carrier.force(position),
            "leverage": float(there.path.gradient(carrier.pulley) @ carrier.place(position)[1]),
            "wrap_angle": float(there.path.wrap_angles[carrier.pulley]),
            "tension": there.tension,
            "hub_load": float(np.hypot(*force)),
            "hub_direction": float(np.arctan2(force[1], force[0])),
            "slack": length - self._shortest,
        }
        for name, push in self._frictions.items():
            with suppress(ConvergenceError, ModelError):
                pushed = self._with(tensioner.pushed(push), prepared)
                row[f"tension_after_{name}"] = self._balanced(pushed).tension
        return row

    def _balanced(self, prepared: Prepared) -> Installation:
        """The belt at rest, by closed forms once the search has taken too long."""
        try:
            rest = stand(prepared, fineness=max(_FINENESS, first_fineness(prepared)))
            return looked_at(prepared, rest.system, rest.state).installation
        except TimeLimitError:
            self._by_closed_forms = True
            return estimate_at_rest(prepared)[1]

    def _placed(self, position: float) -> FloatArray:
        """Places of all tensioners, with this one elsewhere and the others where the nominal belt has them."""
        positions = self._prepared.installation.tensioner_positions.copy()
        positions[self._number] = position
        return positions

    def _with(self, tensioner: MovingTensioner, prepared: Prepared | None = None) -> Prepared:
        """A drive with another tensioner in the place of this one."""
        prepared = prepared or self._prepared
        own = prepared.carriers[self._number].tensioner
        return prepared.replace(tensioner=[tensioner if one is own else one for one in prepared.drive.tensioners])

    def result(self, given: str) -> Result:
        """The sheet; the text is that of the drive as it is given."""
        states = list(self._rows)
        if self._tensioner.anchor is not None:
            for row in self._rows.values():
                row["arm_angle"] = float(self._carrier.angle(row.get("position", np.nan)))
        known = {name for row in self._rows.values() for name in row if np.isfinite(row[name])}
        variables: Axes = {
            name: (column.variable(self._tensioner.turns), [row.get(name, np.nan) for row in self._rows.values()])
            for name, column in COLUMNS.items()
            if name in known
        }
        tensions = [row["tension"] for state, row in self._rows.items() if state in self._belts and "tension" in row]
        spread = (max(tensions) - min(tensions)) / self._rows[_NOMINAL]["tension"]
        more: Axes = {
            "failure": (Variable(_STATE, "1", "Why this state does not exist", "str"), self._reasons(states)),
            "tension_spread": (Variable((), "1", "Tension range over all belts"), spread),
        }
        names = {"state": (Variable(_STATE, "1", "State", "str"), states)}
        result = build_result(
            "tensioner_sheet", self._prepared.drive, {**variables, **more}, names, list(self._warnings())
        )
        result.dataset.attrs |= {"drive_as_given": given, "pulley": self._tensioner.pulley}
        return result

    def _reasons(self, states: list[str]) -> NDArray[np.object_]:
        return np.array([self._failures.get(state, "") for state in states], dtype=object)

    def _warnings(self) -> Iterator[str]:
        """What a designer has to look after."""
        lower, upper, written = self._stops["lower stop"], self._stops["upper stop"], self._tensioner.written
        if self._by_closed_forms:
            finding = Finding(
                f"the search for static equilibrium was ended after {_LONGEST_SEARCH:g} s of processor time.",
                "States after that are closed forms, within 1 % where arcs are long.",
                "Omit contact.stiffness and belt.elements so that they are chosen.",
            )
            yield str(finding)
        for state, cause in self._failures.items():
            yield f"{state}: {cause}"
        for state in self._belts:
            row = self._rows[state]
            if not lower <= row.get("position", lower) <= upper:
                yield (
                    f"the {state} moves the tensioner of {self._tensioner.pulley} to its stop at "
                    f"{written(row['position'])}, where the spring no longer sets the tension "
                    f"({row['tension']:.4g} N). Change the belt length, the tolerance, or the stops."
                )
            if row.get("slack", 0.0) < 0.0:
                yield (
                    f"the {state} is {-1e3 * row['slack']:.3g} mm too short to be fitted with the tensioner of "
                    f"{self._tensioner.pulley} at its lower stop. Lower that stop, or use a longer belt."
                )


def _number_of(drive: Drive, pulley: str | None) -> int:
    """Number of a tensioner among those that move."""
    names = [one.pulley for one in drive.moving_tensioners]
    if not names:
        raise ModelError(
            "the drive has no moving tensioner. Add a [[tensioner]] with a spring, or use `beltdyn check` for tensions."
        )
    if pulley is None and names[1:]:
        raise ModelError(
            f"a tensioner sheet describes one tensioner; those of {', '.join(names)} move. Choose one with pulley."
        )
    if pulley is not None and pulley not in names:
        raise ModelError(f"pulley = {pulley!r} has no moving tensioner. Choose from: {', '.join(names)}.")
    return names.index(pulley) if pulley is not None else 0


def _aged(prepared: Prepared) -> tuple[str, str, str]:
    """The longest belt after its life: its name, and the tolerance and elongation that belts of its kind have."""
    return _WORN if prepared.belt.teeth is None else _STRETCHED


def lengths_of(prepared: Prepared, tolerance: Number | None, wear: Number | None) -> tuple[float, float]:
    """Tolerance of the length and elongation over life, m, given or those of the kind of belt."""
    _, usual_tolerance, usual_wear = _aged(prepared)
    nominal = prepared.belt_length
    return (
        _length_of("tolerance", usual_tolerance if tolerance is None else tolerance, nominal),
        _length_of("wear", usual_wear if wear is None else wear, nominal),
    )


def _length_of(name: str, text: Number, nominal: float) -> float:
    """Read a length, m, given as one or as a part of the nominal length."""
    whole = str(text).strip()
    try:
        if isinstance(text, str):
            found = nominal * float(whole[:-1]) / 100.0 if whole.endswith("%") else to_si(whole, "m")
        else:
            found = float(text)
    except ValueError as error:
        raise ModelError(
            f'{name} = {text!r} {reason(error)}. Give a length or a share, such as "6 mm" or "0.5 %".'
        ) from error
    if not 0.0 <= found < nominal:
        raise ModelError(f"{name} = {text!r} must be non-negative and less than the belt length of {nominal:.4g} m.")
    return found
