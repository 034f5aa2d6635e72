"""Calibration: fit parameters of a drive to measured results, with confidence intervals."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.designs.designs import Free, free_numbers
from beltdyn.designs.named_results import unit_of
from beltdyn.designs.optimization_history import headed, require_free, write_found
from beltdyn.designs.residuals import MOST, Residuals
from beltdyn.model import Drive
from beltdyn.model.parameter_study import CalibrationStudy
from beltdyn.model.toml import edited, loads, read_study
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.atomic import locked_output
from beltdyn.results.schema import VARIOUS
from beltdyn.signals import closing, uninterrupted
from beltdyn.solvers.run_progress import Report

# Least squares between bounds (trust-region reflective, SciPy), and what the fit knows of its numbers

_TOLERANCE = 1e-8
"""Of numbers, goal and gradient, at which the search ends."""
_LEAST_SINGULAR = 1e-5
"""Relative singular value below which parameters cannot be separated: the accuracy of derivatives."""
_INVOLVED = 0.1
"""Component of a parameter in a singular direction above which it counts as unidentified."""


class Fit(NamedTuple):
    """Numbers that fit best."""

    numbers: FloatArray
    errors: FloatArray
    """Their standard errors, shape (n,); infinite for unidentified parameters."""
    correlation: FloatArray
    """Shape (n, n)."""
    reach: float
    """Half of an interval over the standard error."""
    residuals: FloatArray
    spread: float
    """Root mean square of residuals with the degrees of freedom that are left; NaN where none is left."""
    untold: tuple[int, ...]
    """Parameters that the measurements cannot identify, alone or separately."""
    interrupted: bool = False
    """Whether the search was ended before the numbers fitted best."""

    @property
    def told(self) -> bool:
        """Whether measurements tell all numbers."""
        return not self.untold


def fit(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    confidence: float,
    *,
    known: bool,
    most: int = 100,
    keep: Callable[[Fit], None] | None = None,
) -> Fit:
    """Fit numbers between 0 and 1 to residuals over standard deviations, shape (m,), with derivatives of shape (m, n).

    Unless the standard deviations are `known`, one factor of them is estimated. An interruption ends the search where
    it is, once derivatives at its start are known. `keep` gets the fit of each iteration, as of an interruption.
    """

    def reach(reached: _Reached) -> None:
        if keep is not None:
            keep(_fit_of(reached, confidence, known))

    return _fit_of(_search(residuals, jacobian, start, most, reach), confidence, known)


def _fit_of(reached: "_Reached", confidence: float, known: bool) -> Fit:
    """The fit at numbers, from derivatives there."""
    from scipy import stats

    numbers, away, slopes, interrupted = reached
    left = away.size - numbers.size
    spread = float(np.sqrt(away @ away / left)) if left > 0 else np.nan
    sizes = np.linalg.norm(slopes, axis=0)
    scaled = slopes / np.where(sizes > 0.0, sizes, 1.0)
    _, singular, rows = np.linalg.svd(scaled, full_matrices=False)
    unnoticed = rows[singular <= _LEAST_SINGULAR * singular.max()]
    untold = tuple(np.flatnonzero((sizes == 0.0) | (left < 0) | (np.abs(unnoticed) > _INVOLVED).any(axis=0)).tolist())
    told = not untold
    inverse = (
        rows.T / np.maximum(singular, np.finfo(float).tiny) if told else np.full((numbers.size, singular.size), np.inf)
    )
    covariance = inverse @ inverse.T if told else np.diag(np.full(numbers.size, np.inf))
    deviations = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(deviations, deviations) if told else np.full(covariance.shape, np.nan)
    factor = 1.0 if known else spread
    half = 0.5 * (1.0 + confidence)
    reach = float(stats.norm.ppf(half) if known else stats.t.ppf(half, left)) if known or left > 0 else np.inf
    errors = factor * deviations / np.where(sizes > 0.0, sizes, 1.0)
    return Fit(numbers, errors, correlation, reach, away, spread, untold, interrupted)


class _Reached(NamedTuple):
    """Where a search has come to."""

    numbers: FloatArray
    residuals: FloatArray
    slopes: FloatArray
    interrupted: bool


def _search(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    most: int,
    reach: Callable[[_Reached], None],
) -> _Reached:
    """Least squares, or the last numbers at which derivatives were taken where the search is interrupted."""
    from scipy.optimize import least_squares

    solve: Callable[..., Any] = least_squares
    settings = {"ftol": _TOLERANCE, "xtol": _TOLERANCE, "gtol": _TOLERANCE, "max_nfev": most}
    reached: _Reached | None = None

    def slopes_at(numbers: FloatArray) -> FloatArray:
        nonlocal reached
        slopes = jacobian(numbers)
        reached = _Reached(numbers.copy(), residuals(numbers), slopes, True)
        reach(reached)
        return slopes

    try:
        found = solve(residuals, start, jac=slopes_at, bounds=(0.0, 1.0), method="trf", x_scale="jac", **settings)
    except KeyboardInterrupt:
        if reached is None:
            raise
        return reached
    return _Reached(found.x, found.fun, found.jac, False)


_UNLIKELY = 1e-3
"""Probability of residuals so large, below which deviations or the drive are doubtful."""

_CORRELATED = 0.99
"""Correlation of errors with which an interval is seven times as long as if the other number were known."""

_NUMBER, _MEASURED = ("number",), ("measured",)
_VARIABLES = {
    "residual_deviation": Variable(
        (), "1", "Standard deviation of residuals, over that of the measurements or relative"
    ),
    "start": Variable(_NUMBER, VARIOUS, "Start"),
    "fitted": Variable(_NUMBER, VARIOUS, "Fitted"),
    "standard_error": Variable(_NUMBER, VARIOUS, "Standard error"),
    "lower": Variable(_NUMBER, VARIOUS, "Lower confidence limit"),
    "upper": Variable(_NUMBER, VARIOUS, "Upper confidence limit"),
    "number_unit": Variable(_NUMBER, "1", "Unit", "str"),
    "correlation": Variable(("number", "other_number"), "1", "Correlation of errors"),
    "measured_value": Variable(_MEASURED, VARIOUS, "Measured"),
    "start_value": Variable(_MEASURED, VARIOUS, "Start"),
    "fitted_value": Variable(_MEASURED, VARIOUS, "Fitted"),
    "residual": Variable(_MEASURED, "1", "Residual, over the standard deviation or relative"),
    "measured_unit": Variable(_MEASURED, "1", "Unit", "str"),
}
_COORDINATES = {
    "number": Variable(_NUMBER, "1", "Number", "str"),
    "other_number": Variable(("other_number",), "1", "Number", "str"),
    "measured": Variable(_MEASURED, "1", "Measured result", "str"),
    "row": Variable(_MEASURED, "1", "Row", "str"),
}


@takes_options
def calibrate(
    drive: Drive,
    *,
    study: Path | str | CalibrationStudy,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    r"""Fit parameters of a drive to measured results, with confidence intervals.

    A study names the parameters and the tables of measurements: results in steady running or at rest, such as slip over
    torque, span frequencies, or tensioner position over tension. The parameters are fitted by least squares. Their
    confidence intervals follow from the derivatives of results and the standard deviations of measurements; without
    these, a common relative deviation is estimated.

    Parameters
    ----------
    drive
        The drive, with the starting values.
    study
        The study file, TOML.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), with the calibrated drive file beside it; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Along ``number`` ``fitted``, ``standard_error``, ``lower`` and ``upper``; along ``measured`` the measured and
        the computed values. Its drive is the calibrated one, whose file text is the attribute ``best_drive``.

    Raises
    ------
    ModelError
        If the study is invalid, or does not fit the drive.
    ConvergenceError
        If the given drive has no such state, or the measurements cannot identify the parameters.
    KeyboardInterrupt
        If the search is interrupted before its first result. Later it returns the values of the last iteration, with
        the status "interrupted".

    Examples
    --------
    >>> from pathlib import Path
    >>> rows = ["driven torque [N m], pulley_slip[driven] [%]", "-0.5, 0.06", "-1, 0.12", "-2, 0.24"]
    >>> _ = Path("slip.csv").write_text("\n".join(rows))
    >>> study = bd.CalibrationStudy(
    ...     number=[{"path": "belt.youngs_modulus", "least": "50 MPa", "largest": "200 MPa"}],
    ...     measurement=[{"table": "slip.csv"}],
    ... )
    >>> found = bd.calibrate(drive, study=study)
    >>> bool(found.dataset.lower < found.dataset.fitted)
    True
    """
    path = None if output is None else Path(output)
    if path is not None:
        require_free(path, overwrite, study)
    with locked_output(path) if path is not None else nullcontext():
        return _calibrate(drive, study, force_tolerance, path, progress, overwrite)


def _calibrate(
    drive: Drive,
    study: Path | str | CalibrationStudy,
    force_tolerance: float | None,
    path: Path | None,
    progress: Report | None,
    overwrite: bool,
) -> Result:
    given = study if isinstance(study, CalibrationStudy) else read_study(study, CalibrationStudy)
    base = Path() if isinstance(study, CalibrationStudy) else Path(study).parent
    numbers = free_numbers(drive, given.numbers)
    fitting = Residuals(drive, numbers, given, base, force_tolerance, progress)
    first = fitting.start()

    confidence, known = given.confidence, fitting.known

    def save(result: Result) -> None:
        if path is not None:
            result.save(path, overwrite)
            write_found(path, str(result.dataset.attrs["best_drive"]), overwrite)

    def keep(found: Fit) -> None:
        with uninterrupted():
            save(_result(drive, numbers, fitting, found, confidence))

    keeping = keep if path is not None else None
    found = fit(fitting.residuals, fitting.jacobian, first, confidence, known=known, most=MOST, keep=keeping)
    result = _result(drive, numbers, fitting, found, confidence)
    with closing():
        save(result)
    return result


def _result(drive: Drive, numbers: Sequence[Free], fitting: Residuals, found: Fit, confidence: float) -> Result:
    """Fitted numbers and results."""
    ranges = np.array([one.largest - one.least for one in numbers])
    fitted = np.array([one.least for one in numbers]) + found.numbers * ranges
    errors = found.errors * ranges
    on = fitting.on
    names = [
        (watched.name, label, unit_of(watched.name, drive))
        for series in fitting.series
        for label in series.labels
        for watched in series.designs.watched
    ]
    shown = [one for one, there in zip(names, on, strict=True) if there]
    text = headed(edited(drive, dict(zip((one.path for one in numbers), fitted.tolist(), strict=True))), "calibrate")
    arrays: dict[str, ArrayLike] = {
        "residual_deviation": found.spread,
        "start": [one.start for one in numbers],
        "fitted": fitted,
        "standard_error": errors,
        "lower": fitted - found.reach * errors,
        "upper": fitted + found.reach * errors,
        "number_unit": [one.unit for one in numbers],
        "correlation": found.correlation,
        "measured_value": fitting.measured[on],
        "start_value": fitting.first[on],
        "fitted_value": fitting.values(found.numbers)[on],
        "residual": found.residuals,
        "measured_unit": [unit for _, _, unit in shown],
    }
    labels: Mapping[str, ArrayLike] = {
        "number": [one.path for one in numbers],
        "other_number": [one.path for one in numbers],
        "measured": [name for name, _, _ in shown],
        "row": [label for _, label, _ in shown],
    }
    warnings = list(_warnings(numbers, fitting, found))
    result = build_result(
        "calibrate",
        loads(text),
        {name: (_VARIABLES[name], values) for name, values in arrays.items()},
        {name: (one, labels[name]) for name, one in _COORDINATES.items()},
        warnings,
    )
    more = {"drive_as_given": drive.text, "best_drive": text, "confidence": confidence}
    if found.interrupted:
        more["status"] = "interrupted"
    more["title"] = f"{drive.title}: calibrated with {np.sum(on)} measured values, intervals of {confidence:.0%}"
    return Result(result.dataset.assign_attrs(more), result.drive)


def _warnings(numbers: Sequence[Free], fitting: Residuals, found: Fit) -> Iterator[str]:
    """Warnings about the fit."""
    from scipy import stats

    if found.interrupted:
        yield (
            "the search was interrupted: the values are those of the last iteration, and the intervals do not "
            "hold. Run it again to find the best fit."
        )
    yield from dict.fromkeys(failure for series in fitting.series for failure in series.designs.failed)
    paths = [one.path for one in numbers]
    if not found.told:
        untold = [paths[number] for number in found.untold]
        fault = (
            f"the measurements cannot identify {untold[0]}: no measured result depends on it"
            if len(untold) == 1
            else f"the measurements cannot identify {', '.join(untold)} separately: they affect the same "
            "results in the same way"
        )
        yield f"{fault}. Fit fewer parameters, or measure another quantity."
    wide = [path for path, error in zip(paths, found.errors, strict=True) if 1.0 < 2.0 * found.reach * error < np.inf]
    if wide:
        yield (
            f"{', '.join(wide)}: the confidence interval is wider than the bounds, so the measurements barely "
            "identify it. Measure more, or a quantity that depends on it."
        )
    for one, other in zip(*np.nonzero(np.triu(np.abs(found.correlation) > _CORRELATED, 1)), strict=True):
        yield (
            f"errors of {paths[one]} and {paths[other]} are correlated by {found.correlation[one, other]:.3f}: "
            "the measurements identify little more than their combined effect. Measure a quantity that depends "
            "on only one of them."
        )
    at_bounds = [one.path for one, part in zip(numbers, found.numbers, strict=True) if min(part, 1.0 - part) < 1e-6]
    if at_bounds:
        yield f"{', '.join(at_bounds)}: the fit is at a bound, where confidence intervals do not hold. Widen the bound."
    left = found.residuals.size - len(numbers)
    if fitting.known and left > 0:
        squares = float(found.residuals @ found.residuals)
        if stats.chi2.sf(squares, left) < _UNLIKELY:
            yield (
                f"residuals are {found.spread:.2g} times as large as the standard deviations of the "
                "measurements: the model does not describe the measurements, or they are less accurate than "
                "stated."
            )
