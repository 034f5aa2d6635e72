"""Sensitivity of results in steady running or at rest to each parameter of the drive file.

Each number is changed a little up and down, and the state follows on the same mesh by the tangent of the state at hand,
which is factorized once: the first step is that of the implicit function theorem, du = -(dF/du)^-1 dF, with dF the
residual of the changed drive, and those after it, with the same tangent, take the rest.  An adjoint solution for each
result would save the substitution, which is a small part of making the changed drive, whose residual it needs too.
Where a tension at rest is asked for, the length of the belt, or the take-up, follows in each changed drive: on its own,
it would change the tension by so much more that other points of the mesh come into contact.  Modes are followed by
their shapes, with right and left eigenvectors (`state_modes`).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import OperatingPoint, named
from beltdyn.designs.designs import Designs, Free, SmallChanges
from beltdyn.designs.found_state import FoundState, Resting, Running, bring_at_rest
from beltdyn.designs.named_results import listed, names_in, names_of, need_bands, unit_of
from beltdyn.errors import ModelError, cause_of
from beltdyn.model import Drive, prepare
from beltdyn.model.parameter_study import Points
from beltdyn.parts.change import number_path, require_distinct, tolerances_of, unit_at, value_at
from beltdyn.parts.messages import suggest
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Count
from beltdyn.parts.text_file import entry_name
from beltdyn.points.changed_drive import at_instant
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.schema import AXIS_NAMES, VARIOUS
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_state
from beltdyn.vibration.modes import REST, STEADY

# The numbers of a drive file that can be changed a little

PART = 0.01
"""Relative change of a parameter to which effects refer."""
_MOVE = 1e-3
"""Change of a coordinate, whose zero is arbitrary, to which effects refer, m."""
_COORDINATES = ("center", "pivot", "point")
_KEPT = (
    *("simulation", "steady", "limits", "contact.stiffness", "contact.damping"),
    *("belt.cord_fatigue", "belt.rib_fatigue", "belt.largest_fleeting_angle", "belt.strength"),
    *("belt.permanent_elongation", "belt.thermal_expansion", "belt.temperature_range"),
)
"""Where numbers stand that have no effect on a state that stays, or are those of the method."""
_SWITCHES = ("schedule",)
"""Keys of what lies between 0 and 1."""
_OUT_OF_PLANE = ("axial_offset", "tilt")
"""Keys of what has no effect on planar drives."""


class Number(NamedTuple):
    """A number of a drive file."""

    path: str
    """As `Drive.with_` takes it."""
    value: float
    step: float
    """Change to which effects refer."""


def numbers_of(part: Part, path: str = "") -> Iterator[Number]:
    """The numbers of a drive that can be changed a little, with their paths; zeros only where they are coordinates."""
    for key, value in part.arguments.items():
        if key not in part.following:
            yield from _numbers_in(value, f"{path}.{key}" if path else key)


def _numbers_in(value: object, path: str) -> Iterator[Number]:
    """The numbers in a value of a drive."""
    key = path.rpartition(".")[2]
    if path in _KEPT or key in (*_SWITCHES, *_OUT_OF_PLANE) or isinstance(value, bool | int | str):
        return
    if isinstance(value, Part):
        yield from numbers_of(value, path)
    elif isinstance(value, float):
        if key.partition("[")[0] in _COORDINATES:
            yield Number(path, value, _MOVE)
        elif value != 0.0:
            yield Number(path, value, PART * value)
    elif isinstance(value, Sequence) and (len(value) == len(AXIS_NAMES) or any(isinstance(one, Part) for one in value)):
        for number, one in enumerate(value, 1):
            yield from _numbers_in(one, f"{path}[{entry_name(one) or number}]")


def chosen_numbers(drive: Drive, numbers: str | Sequence[str] | None, tolerances: Mapping[str, float]) -> list[Number]:
    """The requested parameters; those with tolerances always count as parameters of the drive.

    Beside numbers that are given there are those that follow from them and may be given in their place, such as the
    axial stiffness of a belt.
    """
    known = {one.path: one for one in numbers_of(drive)}
    for path, size in tolerances.items():
        if path.rpartition(".")[2].partition("[")[0] in _OUT_OF_PLANE:
            continue
        value = float(value_at(drive, path))
        known.setdefault(path, Number(path, value, PART * value or size))
    if numbers is None:
        return list(known.values())
    paths = [path if path in known else _path_of_number(drive, path) for path in listed(numbers)]
    chosen = [known.get(path) or _number_in_place(drive, path, list(known)) for path in paths]
    require_distinct(drive, [one.path for one in chosen], "numbers:")
    return chosen


def _path_of_number(drive: Drive, path: str) -> str:
    """The path of a number, or of the value of a constant; as it is where there is none."""
    with suppress(ModelError):
        return number_path(drive, path)
    return path


def _number_in_place(drive: Drive, path: str, known: Sequence[str]) -> Number:
    """A number that may be given in place of others."""
    try:
        value = value_at(drive, path)
    except ModelError:
        value = None
    if path == "belt.axial_stiffness" and drive.belt.stretch_curve is not None:
        raise ModelError(
            f"{path} = {value:.4g} N is the initial slope of belt.stretch_curve, not an independent parameter. "
            "Remove the curve, or omit the stiffness."
        )
    if not isinstance(value, float) or value == 0.0 or path.startswith(_KEPT):
        raise ModelError(f"{path} is not a continuous parameter of this drive. {suggest(path, list(known))}")
    return Number(path, value, PART * value)


# Monte Carlo on tolerances: results at Sobol points of numbers that scatter normally and independently

DEVIATIONS = 2.0
"""Standard deviations in a tolerance: 95 % of all numbers lie within it."""
_REACH = 4.0
"""Tolerances between a number and its bounds, beyond which no point lies."""


def require_points(count: int) -> None:
    """Make sure that Sobol points are balanced."""
    if count < 0 or (count and count & (count - 1)) or count == 1:
        raise ModelError(f"sobol = {count} must be a power of two, such as 64 or 256.")


def results_at_points(
    drive: Drive,
    tolerances: Mapping[str, float],
    names: Sequence[str],
    count: int,
    *,
    at_rest: bool,
    force_tolerance: float | None,
    tell: Callable[[int], None],
) -> tuple[FloatArray, list[str]]:
    """Results at scattered points, shape (points that run, results), and why the others do not run."""
    from scipy.stats import norm, qmc

    numbers = [_free(drive, path, tolerance) for path, tolerance in tolerances.items()]
    points = [OperatingPoint("as the drive file says", 1.0, lambda one: one)]
    watched = [named(name, drive, 1) for name in names]
    designs = Designs(drive, numbers, points, Points(), watched, force_tolerance, lambda part: None, at_rest=at_rest)
    start = designs.find({one.path: one.start for one in numbers})
    designs.derivatives(start)
    scattered = norm.ppf(qmc.Sobol(len(numbers), rng=0).random(count)) / DEVIATIONS
    values, failures = list[FloatArray](), list[str]()
    for place, row in enumerate(scattered):
        changes = {
            one.path: one.start + float(part) * tolerances[one.path] for one, part in zip(numbers, row, strict=True)
        }
        found = designs.find(changes, start)
        if found.failure:
            failures.append(found.failure)
        else:
            values.append(found.values[0])
        tell(place + 1)
    return np.array(values).reshape(-1, len(names)), failures


def _free(drive: Drive, path: str, tolerance: float) -> Free:
    """A number with its tolerance."""
    value, away = float(value_at(drive, path)), _REACH * tolerance
    return Free(path, unit_at(drive, path).replace("*", " "), value - away, value + away, value)


# The spread of results by the tolerances of numbers, from derivatives, and as it is at scattered points

_RESULT, _NUMBER = ("result",), ("number",)
_VARIABLES = {
    "tolerance": Variable(_NUMBER, VARIOUS, "Tolerance of the parameter, in SI units"),
    "contribution": Variable(("result", "number"), VARIOUS, "Change of the result over the tolerance of the parameter"),
    "spread": Variable(_RESULT, VARIOUS, "Spread due to tolerances"),
    "worst_case": Variable(_RESULT, VARIOUS, "Worst case of tolerances"),
    "mean_of_points": Variable(_RESULT, VARIOUS, "Mean over Sobol points"),
    "spread_of_points": Variable(_RESULT, VARIOUS, "Spread over Sobol points"),
}


def with_spread(result: Result, tolerances: Mapping[str, float], points: FloatArray | None) -> Result:
    """Sensitivities with the spread of results at scattered points, shape (points, results)."""
    dataset = result.dataset
    sizes = np.array([tolerances.get(str(path), np.nan) for path in dataset["number"].values])
    parts = dataset["derivative"].values * sizes
    arrays = {
        "tolerance": sizes,
        "contribution": parts,
        "spread": np.sqrt(np.nansum(parts**2, axis=1)),
        "worst_case": np.nansum(np.abs(parts), axis=1),
    }
    if points is not None and len(points) > 1:
        arrays["mean_of_points"] = points.mean(axis=0)
        arrays["spread_of_points"] = DEVIATIONS * points.std(axis=0, ddof=1)
    named = {name: (_VARIABLES[name].dims, values, _VARIABLES[name].attributes) for name, values in arrays.items()}
    return Result(dataset.assign(named), result.drive)


_USUAL = {STEADY: "efficiency, least_slip_safety, largest_tension", REST: "tension, hub_load"}
"""Results that are looked at where none are named."""
_USUAL_OF_TEETH = "efficiency, largest_tension"
"""The same in steady running of a belt with teeth, which does not slip."""


def _usual(drive: Drive, about: str) -> str:
    return _USUAL_OF_TEETH if about == STEADY and drive.belt.teeth else _USUAL[about]


@takes_options
def sensitivity(
    drive: Drive,
    *,
    of: str | Sequence[str] | None = None,
    numbers: str | Sequence[str] | None = None,
    about: str = STEADY,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    sobol: Annotated[Count, Field(ge=0)] = 0,
    progress: Report | None = None,
) -> Result:
    """Compute the sensitivity of results in steady running, or at rest, to each parameter of the drive file.

    Effects are changes per 1 % of a parameter, or per 1 mm of a coordinate of a center or pivot. A given installed
    tension is kept: the belt length, or the take-up, follows.

    Parameters
    ----------
    drive
        The drive.
    of
        Results, a list or separated by commas, such as "efficiency, pulley_slip[driven], hub_load": variables of a map,
        and in brackets the pulley, span, tensioner or cause of one. Results of modes are "frequency[SPAN]" and
        "damping_ratio[SPAN]", of the lowest mode dominated by the span, and "mode_frequency[NUMBER]" and
        "mode_damping_ratio[NUMBER]". "all" selects all of them. By default efficiency, tension, and without
        teeth slip safety; at rest tension and hub loads.
    numbers
        Paths of parameters, a list or separated by commas, such as "belt.width, pulley[driven].radius". By default all
        non-zero parameters of the drive at that instant.
    about
        "steady" or "rest".
    at
        Instant at which speeds, torques and schedules are evaluated, such as "0.5 s", or in s; by default the end of
        the simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    sobol
        Number of Sobol points within the tolerances that check the linear estimate of the spread: a power of two. By
        default none.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Along ``result`` and ``number`` ``derivative``, in SI units, and ``effect``, the change of the result per 1 % or
        1 mm; along ``number``, sorted by effect, ``relative_NAME`` of each result, its change in per cent; along
        ``result`` its ``value``. Where the drive file has tolerances, along ``number`` ``tolerance``, along both
        ``contribution``, and along ``result`` ``spread`` and ``worst_case``; with `sobol` ``spread_of_points`` and
        ``mean_of_points``.

    Raises
    ------
    ModelError
        If a name is unknown, a result has no value, or the drive cannot run steadily.
    ConvergenceError
        If there is no such state.

    Examples
    --------
    >>> found = bd.sensitivity(drive, of="largest_tension", numbers="belt.length, pulley[driven].radius")
    >>> found.dataset.effect.dims
    ('result', 'number')
    """
    if about not in _USUAL:
        raise ModelError(f'about = {about!r} must be "{STEADY}" or "{REST}".')
    given = at_instant(drive, at)
    require_points(sobol)
    tolerances = {path: size for path, size in tolerances_of(drive).items() if _stands(given, path)}
    if sobol and not tolerances:
        raise ModelError(
            f'sobol = {sobol} samples tolerances, but the drive file has none. Write for example width = "12.5 '
            '± 0.1 mm".'
        )
    chosen, wanted = (
        chosen_numbers(given, numbers, tolerances),
        names_in(names_of(drive, at_rest=about == REST), of or _usual(drive, about)),
    )
    rest = bring_at_rest(prepare(given)) if about == REST else bring_to_stand(prepare(given))
    bands = need_bands(wanted)
    state = (
        Resting(rest)
        if about == REST
        else Running(steady_state(rest.drive, force_tolerance=force_tolerance), bands=bands)
    )
    values = _values(state, wanted)
    changes = SmallChanges(given, rest)
    derivatives, warnings = np.full((len(values), len(chosen)), np.nan), _warnings(state, list(values))
    for place, number in enumerate(chosen):
        if progress is not None:
            progress(Progress(place, float(len(chosen)), 0.0, place, "operating points"))
        try:
            derivatives[:, place] = _derivatives(changes, state, number, list(values))
        except Exception as error:
            told = cause_of(
                error, f"bd.sensitivity(drive, of={list(values)!r}, numbers={number.path!r}, about={about!r})"
            )
            warnings.append(f"no derivative with respect to {number.path}: {told}")
    result = _result(drive, values, chosen, derivatives, warnings)
    if not tolerances:
        return result

    def tell(done: int) -> None:
        if progress is not None:
            progress(Progress(done, float(sobol), 0.0, done, "operating points"))

    points = None
    if sobol:
        points, failures = results_at_points(
            given,
            tolerances,
            list(values),
            sobol,
            at_rest=about == REST,
            force_tolerance=force_tolerance,
            tell=tell,
        )
        if failures:
            warnings.append(f"{len(failures)} of {sobol} points failed. The last one: {failures[-1]}")
            result = _result(drive, values, chosen, derivatives, warnings)
    return with_spread(result, tolerances, points)


def _stands(drive: Drive, path: str) -> bool:
    """Whether there is a number at a path at the instant that is looked at."""
    try:
        return isinstance(value_at(drive, path), float)
    except ModelError:
        return False


def _values(state: FoundState, names: Sequence[str]) -> dict[str, float]:
    """Results that have a value."""
    values = {name: state.value(name) for name in names}
    found = {name: value for name, value in values.items() if np.isfinite(value)}
    if not found:
        raise ModelError(f"{', '.join(names)} has no value in this state of the drive. Choose another result.")
    return found


def _warnings(state: FoundState, names: Sequence[str]) -> list[str]:
    """What is to be known of a state and of derivatives."""
    found, shared = list(state.run.warnings) if isinstance(state, Running) else [], state.shared_modes(names)
    if shared:
        found.append(
            f"{', '.join(shared)}: other modes have the same frequency, so their shapes are not unique. "
            "Derivatives are those of their mean."
        )
    return found


def _derivatives(changes: SmallChanges, state: FoundState, number: Number, names: Sequence[str]) -> FloatArray:
    """Derivatives of results with respect to a number, by central differences of the states; one-sided at a bound."""
    change = state.change * number.step / PART
    drives, refused = dict[float, Drive](), list[ModelError]()
    for value in (number.value + change, number.value - change):
        try:
            drives[value] = changes.drive(number.path, value)
        except ModelError as error:
            refused.append(error)
    if not drives:
        raise refused[0]
    if refused:
        drives[number.value] = changes.drive(number.path, number.value)
    beside = {value: state.neighbour(drive) for value, drive in drives.items()}
    (upper, above), (lower, below) = ((value, one) for value, one in sorted(beside.items(), reverse=True))
    return np.array([above.value(name) - below.value(name) for name in names]) / (upper - lower)


def _result(
    drive: Drive,
    values: dict[str, float],
    numbers: Sequence[Number],
    derivatives: FloatArray,
    warnings: Sequence[str],
) -> Result:
    """The table, with the numbers of largest effect first."""
    found = np.array(list(values.values()))
    effects = derivatives * np.array([number.step for number in numbers])
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(found[:, None] == 0.0, np.nan, 100.0 * effects / found[:, None])
    order = np.argsort(-np.max(np.nan_to_num(np.abs(relative)), axis=0), kind="stable")
    both = ("result", "number")
    variables: dict[str, tuple[Variable, ArrayLike]] = {
        "value": (Variable(("result",), "1", "Value, in the unit of the result"), found),
        "derivative": (
            Variable(both, "1", "Derivative of the result with respect to the parameter, in SI units"),
            derivatives[:, order],
        ),
        "effect": (Variable(both, "1", "Change of the result per 1 % or 1 mm"), effects[:, order]),
    }
    for name, changes in zip(values, relative[:, order], strict=True):
        variables[f"relative_{name}"] = Variable(("number",), "%", name), changes
    coordinates: dict[str, tuple[Variable, ArrayLike]] = {
        "result": (Variable(("result",), "1", "Result", "str"), list(values)),
        "number": (Variable(("number",), "1", "1 % or 1 mm more of", "str"), [numbers[k].path for k in order]),
        "unit": (Variable(("result",), "1", "Unit", "str"), [unit_of(name, drive) for name in values]),
    }
    return build_result("sensitivity", drive, variables, coordinates, warnings)
