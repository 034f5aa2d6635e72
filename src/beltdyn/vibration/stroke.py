"""A linear axis over its stroke: stiffness at the carriage, and natural frequency, about rest."""

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, install, prepare
from beltdyn.model.axis_tension import damping_ratio
from beltdyn.model.demand import required_tension
from beltdyn.model.end import free_stroke
from beltdyn.model.installation import tension_checks
from beltdyn.parts.options import RangeCount, takes_options
from beltdyn.parts.quantity import Count, Numbers, numbers_in
from beltdyn.results import Result, Variable, build_result
from beltdyn.solvers.flutter import Vibrations
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.state.installation import Rest, on_equal_elements, rest_of
from beltdyn.state.static import standing
from beltdyn.system.constant_drive import constant_drive
from beltdyn.theory.input_shaping import SHAPERS, best_shaper, fitted_shaper
from beltdyn.vibration.small_motions import sticking_rate

if TYPE_CHECKING:
    import xarray as xr

_INSET = 0.05
"""Part of the free stroke at each end that the default range leaves out: a clamp at a pulley has no span."""
_MOST_STRETCH = 0.02
"""Largest change of the tension over the stroke, relative, that is not mentioned."""

_PLACE = ("place",)
_EACH = ("place", "mode")
_VARIABLES = {
    "stiffness": Variable(_PLACE, "N/m", "Stiffness at the carriage, driver held"),
    "frequency": Variable(_PLACE, "Hz", "Natural frequency of the carriage, on its belt"),
    "damping_ratio": Variable(_PLACE, "1", "Damping ratio, by losses of the belt and viscous friction of the guide"),
    "decay_rate": Variable(_PLACE, "1/s", "Decay rate, of the amplitude of ringing"),
    "friction_step": Variable(_PLACE, "m", "Amplitude lost in a period, by dry friction of the guide"),
    "carriage_share": Variable(_PLACE, "1", "Share of the carriage, in the kinetic energy of that mode"),
    "lowest_frequency": Variable(_PLACE, "Hz", "Lowest natural frequency, spans among them"),
    "tension": Variable(_PLACE, "N", "Tension at rest"),
    "mode_frequency": Variable(_EACH, "Hz", "Natural frequencies, from the lowest on"),
    "mode_part": Variable(_EACH, "1", "Part with most of the kinetic energy", "str"),
}
_SHAPERS = ("shaper",)
_OF_SHAPERS = {
    "shaper_frequency": Variable(_SHAPERS, "Hz", "Frequency, for the stroke"),
    "shaper_duration": Variable(_SHAPERS, "s", "Longer moves by"),
    "shaper_residual": Variable(_SHAPERS, "1", "Vibration left, at most"),
}
_OF_TENSION = {
    "recommended_tension": Variable((), "N", "Recommended tension, at least"),
    "largest_pull": Variable((), "N", "Largest pull of the moves, with vibration and friction"),
}
_SPANS = ("span",)
_OF_SPANS = {
    "plucked_frequency": Variable(_SPANS, "Hz", "First frequency of a plucked span, at the tension at rest"),
    "recommended_frequency": Variable(_SPANS, "Hz", "First frequency of a plucked span, at the recommended tension"),
}
BELT = "belt"
"""Name of the belt among what moves in a mode."""


@takes_options
def stroke(
    drive: Drive,
    *,
    places: Numbers | None = None,
    points: RangeCount = 9,
    count: Annotated[Count, Field(ge=1)] = 6,
    progress: Report | None = None,
) -> Result:
    """Compute stiffness, natural frequency and modes of a linear axis over its stroke.

    At each place of the carriage the axis is at rest with the same belt; prescribed pulleys are held, others turn, and
    the belt sticks to its pulleys or is held by its teeth. The stiffness is that of all spans, arcs and teeth at the
    carriage. Of the natural modes that in which the carriage has most of the kinetic energy counts: in it the carriage
    rings after a move. For it the input shapers ZV, MZV and EI are fitted (`beltdyn.theory.input_shaping`), each at the
    frequency that leaves least vibration over the stroke; the shortest that leaves at most 5 % fits. The tension that
    the moves require stands beside that at rest, with the frequencies of plucked spans.

    Parameters
    ----------
    drive
        The axis: a drive with a carriage.
    places
        Ways of the carriage from its center, such as "-100..100 mm" or "0, 50 mm", or in m; by default over the stroke,
        or over the free length of the belt.
    points
        Number of places in a range.
    count
        Number of modes at each place, from the lowest frequency on.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Along ``place``, and the modes along ``mode`` too.

    Raises
    ------
    ModelError
        If the drive has no carriage, no pulley holds the belt, a place is beyond the stroke, or `count` is below 1.
    ConvergenceError
        If there is no equilibrium.

    Examples
    --------
    >>> found = bd.stroke(bd.example("printer_axis"), places="0, 80 mm").dataset
    >>> bool(found.stiffness[1] > found.stiffness[0])  # nearer to the motor
    True
    """
    carriage = drive.carriage
    if carriage is None:
        raise ModelError("a stroke needs a carriage. Give the group [carriage], to which both ends are clamped.")
    if not any(pulley.prescribed for pulley in drive.pulleys):
        raise ModelError(
            "no pulley holds the belt: a stiffness at the carriage needs one with prescribed speed. Give the driver "
            "its speed in place of a motor."
        )
    prepared = prepare(on_equal_elements(drive))
    ways = _ways(prepared, places, points)
    first = rest_of(prepared, progress).prepared.drive  # with the length, or the take-up, of the installed tension
    rows = list[dict[str, Any]]()
    for number, way in enumerate(ways.tolist()):
        if progress is not None:
            progress(Progress(float(number), float(ways.size), 0.0, number, "equilibrium"))
        rows.append(_at(rest_of(prepare(_moved(first, way)), None), count))
    columns = {name: np.array([row[name] for row in rows]) for name in _VARIABLES}
    axis = Variable(_PLACE, "m", "Way of the carriage, from its center")
    values: dict[str, Any] = {name: (one, columns[name]) for name, one in _VARIABLES.items()}
    tensions = columns["tension"]
    doubts = []
    if np.ptp(tensions) > _MOST_STRETCH * tensions.mean():
        doubts = [
            f"the tension at rest changes over the stroke from {tensions.min():.4g} to {tensions.max():.4g} N: the "
            "guide does not run along the belt. Move carriage.center onto the line of the belt."
        ]
    numbers = np.arange(1, columns["mode_frequency"].shape[1] + 1)
    modes = Variable(("mode",), "1", "Mode", "int64")
    if not carriage.friction:
        del values["friction_step"]
    values |= _shapers(columns["frequency"], float(columns["damping_ratio"].mean()))
    values |= _tensions(drive)
    coordinates: dict[str, tuple[Variable, Any]] = {
        "place": (axis, ways),
        "mode": (modes, numbers),
        "shaper": (Variable(_SHAPERS, "1", "Input shaper", "str"), list(SHAPERS)),
        "span": (Variable(_SPANS, "1", "Span", "str"), ["-".join(names) for names in drive.spans]),
    }
    result = build_result("stroke", drive, values, coordinates, doubts)
    result.dataset.attrs.update(axes="place", columns_by="mode", answer=_answer(result.dataset))
    return result


def _answer(dataset: "xr.Dataset") -> str:
    """Tension, ringing and input shaper in a sentence."""
    frequencies, left = dataset["frequency"].values, dataset["shaper_residual"].values
    best, tension = best_shaper(left), float(dataset["tension"].mean())
    shaper, frequency = str(dataset["shaper"].values[best]), float(dataset["shaper_frequency"][best])
    has_moves = "recommended_tension" in dataset
    needed = f"at least {float(dataset['recommended_tension']):.3g} N" if has_moves else "unknown"
    return (
        f"Required tension {needed}, {tension:.4g} N at rest; rings at {frequencies.min():.4g} to "
        f"{frequencies.max():.4g} Hz over the stroke; {shaper} at {frequency:.4g} Hz leaves {left[best]:.1%} of it"
    )


def _tensions(drive: Drive) -> dict[str, tuple[Variable, Any]]:
    """Values of `_OF_TENSION` and `_OF_SPANS`; the recommended ones are left out without prescribed moves."""
    installation = install(drive)
    needed = required_tension(drive, installation)
    least = None if needed is None else needed.tension
    checks = {one.state: one for one in tension_checks(drive, installation, least=least)}
    found: dict[str, tuple[Variable, Any]] = {}
    if "run in" in checks:
        found["plucked_frequency"] = _OF_SPANS["plucked_frequency"], checks["run in"].frequencies
    if needed is not None:
        found["recommended_tension"] = _OF_TENSION["recommended_tension"], needed.tension
        found["largest_pull"] = _OF_TENSION["largest_pull"], needed.pull
        if "least" in checks:
            found["recommended_frequency"] = _OF_SPANS["recommended_frequency"], checks["least"].frequencies
    return found


def _shapers(frequencies: FloatArray, damping: float) -> dict[str, tuple[Variable, FloatArray]]:
    """Values of `_OF_SHAPERS` for the natural frequencies (Hz) of the carriage over the stroke."""
    fitted = [fitted_shaper(name, frequencies, damping) for name in SHAPERS]
    rows = [(frequency, shaper.duration, residual) for frequency, residual, shaper in fitted]
    return {
        name: (variable, np.array(column))
        for (name, variable), column in zip(_OF_SHAPERS.items(), zip(*rows, strict=True), strict=True)
    }


def _ways(prepared: Prepared, places: Numbers | None, points: int) -> FloatArray:
    """Ways of the carriage, m, within its stroke."""
    carriage = prepared.carriage
    assert carriage is not None
    room = np.array(free_stroke(carriage, prepared.path))
    inner = (1.0 - 2.0 * _INSET) * (room - room.mean()) + room.mean()
    lower, upper = carriage.stroke or inner.tolist()
    if places is None:
        return np.linspace(lower, upper, points)
    found = numbers_in("places", places, "m", points)
    if found.min() <= room[0] or found.max() >= room[1]:
        raise ModelError(
            f"places = {places!r} go beyond the ways from {room[0]:.5g} to {room[1]:.5g} m, where a clamp of the "
            "carriage reaches a pulley. Give ways between them."
        )
    return found


def _moved(drive: Drive, way: float) -> Drive:
    """The axis with its carriage at another place."""
    carriage = drive.carriage
    assert carriage is not None
    x, y = (at + way * part for at, part in zip(carriage.center, carriage.direction, strict=True))
    held = [one.replace(speed=0.0, harmonics=()) if one.prescribed else one for one in drive.pulleys]
    own = carriage.replace(center=(x, y), stroke=None, stop_stiffness=None, stop_damping=0.0)
    return drive.replace(carriage=own, pulley=held)


def _at(rest: Rest, count: int) -> dict[str, Any]:
    """Values of `_VARIABLES` at a place, with so many modes."""
    stiffness, mass = _linearised(rest)
    from scipy.linalg import eigh

    last = stiffness.shape[0] - 1
    unit = np.zeros(last + 1)
    unit[last] = 1.0
    compliance = float(np.linalg.solve(stiffness, unit)[last])
    squares, ways = eigh(stiffness, mass)
    shares = mass[last, last] * ways[last] ** 2
    own = int(np.argmax(shares))
    hertz = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
    carriage = rest.prepared.carriage
    assert carriage is not None
    ratio = float(damping_ratio(rest.prepared.belt, carriage, hertz[own], float(ways[last, own] ** 2)))
    names = np.array(_parts(rest, last + 1))
    energies = ways[:, :count] * (mass @ ways[:, :count])
    parts = list(dict.fromkeys(names.tolist()))
    largest = np.argmax([energies[names == part].sum(axis=0) for part in parts], axis=0)
    return {
        "stiffness": 1.0 / compliance,
        "frequency": float(hertz[own]),
        "damping_ratio": ratio,
        "decay_rate": 2.0 * np.pi * float(hertz[own]) * ratio,
        "friction_step": 4.0 * carriage.friction * compliance,
        "carriage_share": float(shares[own]),
        "lowest_frequency": float(hertz[0]),
        "tension": rest.tension,
        "mode_frequency": hertz[:count],
        "mode_part": [parts[number] for number in largest.tolist()],
    }


def _parts(rest: Rest, size: int) -> list[str]:
    """To what each unknown of `_linearised` belongs: the belt, a pulley or its hub, and last the carriage."""
    unknown, pulleys = np.asarray(rest.system.bodies.unknown), rest.prepared.pulleys
    carriage = rest.prepared.carriage
    assert carriage is not None
    free = np.argsort(unknown)[np.count_nonzero(unknown < 0) :].tolist()
    names = [pulleys[body].name if body < len(pulleys) else f"hub {body + 1 - len(pulleys)}" for body in free[:-1]]
    return [*[BELT] * (size - len(free)), *names, carriage.name]


def _linearised(rest: Rest) -> tuple[FloatArray, FloatArray]:
    """Stiffness and mass of nodes, free pulleys and, last, the carriage, symmetric, where the belt sticks."""
    system = constant_drive(standing(rest.system), 0.0)
    smooth = system.pulleys.copy()
    smooth["friction"] = 0.0
    parts = []
    for one in (system._replace(pulleys=smooth), system):
        vibrations = Vibrations(one)
        tangents = vibrations.tangents(0.0, rest.state.position, np.zeros_like(rest.state.velocity))
        parts.append([vibrations.matrix(values).toarray() for values in tangents])
    (stiffness, sliding, mass), (_, rubbing, _) = parts
    stuck = stiffness + sticking_rate(rest.tension, system) * (rubbing - sliding)
    kept = np.ones(len(mass), dtype=bool)
    kept[[0, 1, system.first_body - len(system.scale), system.first_body - len(system.scale) + 1]] = False  # carried
    stuck, mass = (0.5 * (one + one.T)[np.ix_(kept, kept)] for one in (stuck, mass))
    return stuck, mass
