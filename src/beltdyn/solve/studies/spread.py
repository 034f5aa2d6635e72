"""The spread of results by the tolerances of numbers, from derivatives, and as it is at scattered points.

Numbers vary independently: with derivatives d_i and tolerances t_i a result has

    spread = sqrt(sum (d_i t_i)^2),        worst case = sum |d_i| t_i.

The spread is what the tolerances are: of 95 % of all drives if they are those of 95 % of all parts, which is two
standard deviations of a normal distribution; the worst case is that of limits which every part keeps.
"""

from collections.abc import Mapping

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.results import Result, Variable
from beltdyn.results.shown import VARIOUS
from beltdyn.solve.studies.tolerance_points import DEVIATIONS

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
    """Sensitivities with the spread of results by tolerances.

    Parameters
    ----------
    result
        Of `sensitivity`.
    tolerances
        Path -> tolerance.
    points : ndarray, shape (points, results), optional
        Results at scattered points.
    """
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
