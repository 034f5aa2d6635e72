"""Sensitivity of results in steady running or at rest to each parameter of the drive file.

Each number is changed a little up and down, and the state follows on the same mesh by the tangent of the state at hand,
which is factorised once: the first step is that of the implicit function theorem, du = -(dF/du)^-1 dF, with dF the
residual of the changed drive, and those after it, with the same tangent, take the rest.  An adjoint solution for each
result would save the substitution, which is a small part of making the changed drive, whose residual it needs too.
Where a tension at rest is asked for, the length of the belt, or the take-up, follows in each changed drive: on its own,
it would change the tension by so much more that other points of the mesh come into contact.  Modes are followed by
their shapes, with right and left eigenvectors (`state_modes`).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.tolerances import tolerances_of
from beltdyn.parts.change import value_at
from beltdyn.results import Result, Variable, build_result
from beltdyn.solve.modes import REST, STEADY
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.rest.staying import bring_to_stand
from beltdyn.solve.steady import steady_state
from beltdyn.solve.steady_running.changed_drive import at_instant
from beltdyn.solve.studies.drive_numbers import PART, Number, chosen_numbers
from beltdyn.solve.studies.found_state import FoundState, Resting, Running
from beltdyn.solve.studies.named_results import names_in, names_of, need_bands, unit_of
from beltdyn.solve.studies.small_changes import CHANGE, SmallChanges
from beltdyn.solve.studies.spread import with_spread
from beltdyn.solve.studies.tolerance_points import require_points, results_at_points

_USUAL = {STEADY: "efficiency, least_slip_safety, largest_tension", REST: "tension, hub_load"}
"""Results that are looked at where none are named."""


def sensitivity(
    drive: Drive,
    *,
    of: str | None = None,
    numbers: str | None = None,
    about: str = STEADY,
    at: float | str | None = None,
    force_tolerance: float | None = None,
    sobol: int = 0,
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
        Results, separated by commas, such as "efficiency, pulley_slip[driven], hub_load": variables of a map, and in
        brackets the pulley, span, tensioner or cause of one. Results of modes are "frequency[SPAN]" and
        "damping_ratio[SPAN]", of the lowest mode dominated by the span, and "mode_frequency[NUMBER]" and
        "mode_damping_ratio[NUMBER]". "all" selects all of them. By default efficiency, capstan margin and tension; at
        rest tension and hub loads.
    numbers
        Paths of parameters, separated by commas, such as "belt.width, pulley[driven].radius". By default all non-zero
        parameters of the drive at that instant.
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
    >>> found = bd.sensitivity(drive, of="efficiency", numbers="belt.length, pulley[driven].radius")
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
        names_in(names_of(drive, at_rest=about == REST), of or _USUAL[about]),
    )
    rest = bring_to_stand(given)
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
        except (ConvergenceError, ModelError) as error:
            warnings.append(f"no derivative with respect to {number.path}: {error}")
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
    """Derivatives of results with respect to a number, by central differences of the states."""
    change = CHANGE * number.step / PART

    def at(value: float) -> FloatArray:
        beside = state.neighbour(changes.drive(number.path, value))
        return np.array([beside.value(name) for name in names])

    return np.asarray((at(number.value + change) - at(number.value - change)) / (2.0 * change))


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
