"""Natural frequencies of a drive about its equilibrium at rest: (K + s C + s^2 M) x = 0."""

from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.parts.options import takes_options
from beltdyn.parts.quantity import Count
from beltdyn.results import Result, Variable, build_result
from beltdyn.solvers.flutter import Vibrations
from beltdyn.state.installation import bring_to_rest
from beltdyn.state.static import standing

_SLOWEST = 1.0
"""Angular frequency below which a mode is none, rad/s: what creeps, and what turns freely."""

_VARIABLES = {
    "frequency": Variable(("mode",), "Hz", "Natural frequency"),
    "damping_ratio": Variable(("mode",), "1", "Damping ratio"),
    "shape": Variable(("mode", "part", "node", "axis"), "1", "Displacement of the nodes over the largest"),
}
_COORDINATES = {
    "mode": Variable(("mode",), "1", "Mode"),
    "part": Variable(("part",), "1", "Real or imaginary part", "str"),
    "axis": Variable(("axis",), "1", "Direction in the plane", "str"),
}


@takes_options
def natural_frequencies(drive: Drive, *, count: Annotated[Count, Field(ge=1)] = 10) -> Result:
    """Find the natural frequencies of a drive at rest, and its mode shapes.

    Parameters
    ----------
    drive
        The drive.
    count
        How many modes to give, from the lowest frequency on.

    Returns
    -------
    Result
        Variables along ``mode``.

    Raises
    ------
    ConvergenceError
        If no equilibrium is found, or it has no mode that swings.

    Examples
    --------
    >>> found = bd.natural_frequencies(drive, count=2)
    >>> found.kind
    'natural_frequencies'
    """
    from scipy.linalg import eig

    rest = bring_to_rest(drive)
    system = standing(rest.system)
    vibrations, place = Vibrations(system), rest.state.position
    tangents = vibrations.tangents(0.0, place, np.zeros_like(place))
    stiffness, damping, mass = (vibrations.matrix(entries).toarray() for entries in tangents)
    none, unit = np.zeros_like(mass), np.eye(len(mass))
    first_order = np.block([[none, unit], [-stiffness, -damping]]), np.block([[unit, none], [none, mass]])
    values, vectors = eig(*first_order)
    swinging = np.flatnonzero(np.isfinite(values) & (values.imag > _SLOWEST))
    chosen = swinging[np.argsort(values[swinging].imag)][:count]
    if not chosen.size:
        raise ConvergenceError("the drive has no mode that swings. Check its masses and stiffnesses.")
    found, coordinates = values[chosen], len(place) - len(system.bodies)
    moved = vectors[:coordinates, chosen].T.reshape(len(chosen), system.nodes, -1)[:, :, :2]
    shapes = np.array([shape / shape.flat[abs(shape).argmax()] for shape in moved])
    results = {
        "frequency": found.imag / (2.0 * np.pi),
        "damping_ratio": -found.real / abs(found),
        "shape": np.stack([shapes.real, shapes.imag], axis=1),
    }
    labels: dict[str, ArrayLike] = {
        "mode": np.arange(1, len(chosen) + 1),
        "part": ["real", "imaginary"],
        "axis": ["x", "y"],
    }
    return build_result(
        "natural_frequencies",
        rest.drive,
        {name: (variable, results[name]) for name, variable in _VARIABLES.items()},
        {name: (variable, labels[name]) for name, variable in _COORDINATES.items()},
        ["a mode at rest grows by itself. Check the tensioners."] if found.real.max() > 0.0 else [],
    )
