"""Power rating of the belt of a drive: rated power, utilization, and number or width of belts needed at each pulley."""

from collections.abc import Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, install, prepare
from beltdyn.model.demand import required_tension
from beltdyn.model.rating import PowerRating, RatedBelt, lower_bound
from beltdyn.model.toothing import MeshRating, RatedTeeth
from beltdyn.parts.messages import listing
from beltdyn.parts.options import takes_options
from beltdyn.parts.quantity import Ratio
from beltdyn.points.belt_checks import Loads, checks_of, variables_of, verdict_of
from beltdyn.points.changed_drive import held_at
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.damage import fatigue_by_name
from beltdyn.results.means import ROUNDING, rate, smaller_than_rated, utilization
from beltdyn.results.schema import COORDINATES
from beltdyn.results.summary import means_of
from beltdyn.solvers.run_progress import Report
from beltdyn.state.steady import steady_state
from beltdyn.theory.rating import belts_factor, pulleys_factor

_PULLEY = ("pulley",)
Values = dict[str, tuple[Variable, Any]]

COLUMNS = {
    "diameter": Variable(_PULLEY, "m", "Diameter of the tension line"),
    "wrap_angle": Variable(_PULLEY, "rad", "Wrap angle"),
    "power": Variable(_PULLEY, "W", "Power into the drive"),
    "basic_power": Variable(_PULLEY, "W", "Basic rated power, one belt or rib"),
    "ratio_power": Variable(_PULLEY, "W", "Additional power by the ratio, one belt or rib"),
    "wrap_factor": Variable(_PULLEY, "1", "Wrap factor"),
    "rated_power": Variable(_PULLEY, "W", "Rated power of the belt"),
    "utilization": Variable(_PULLEY, "1", "Utilization: design power over rated power"),
    "belts_needed": Variable(_PULLEY, "1", "Belts or ribs needed"),
}
"""What a rating tells of each pulley."""
COLUMNS_OF_TEETH = {
    "diameter": Variable(_PULLEY, "m", "Diameter of the tension line"),
    "wrap_angle": Variable(_PULLEY, "rad", "Wrap angle"),
    "power": Variable(_PULLEY, "W", "Power into the drive"),
    "teeth_in_mesh": Variable(_PULLEY, "1", "Pitches of the belt on the arc"),
    "mesh_factor": Variable(_PULLEY, "1", "Whole teeth in mesh over the number that counts, at most 1"),
    "allowed_tooth_load": Variable(_PULLEY, "N", "Allowed load of a tooth at the speed of the pulley"),
    "allowed_pull": Variable(_PULLEY, "N", "Allowed pull of the belt"),
    "rated_power": Variable(_PULLEY, "W", "Rated power of the belt"),
    "utilization": Variable(_PULLEY, "1", "Utilization: design power over rated power"),
    "width_needed": Variable(_PULLEY, "m", "Belt width needed"),
}
"""What the rating of a toothed belt tells of each pulley."""
SCALARS_OF_TEETH = {
    "width": Variable((), "m", "Belt width"),
    "largest_utilization": Variable((), "1", "Largest utilization"),
    "standard_width": Variable((), "m", "Next standard width that carries the power"),
    "belt_speed": Variable((), "m/s", "Belt speed"),
    "service_factor": Variable((), "1", "Service factor"),
    "counted_teeth": Variable((), "1", "Largest number of teeth in mesh that counts"),
}
SCALARS = {
    "belts": Variable((), "1", "Belts or ribs"),
    "largest_utilization": Variable((), "1", "Largest utilization"),
    "most_belts_needed": Variable((), "1", "Belts or ribs needed"),
    "belt_speed": Variable((), "m/s", "Belt speed"),
    "service_factor": Variable((), "1", "Service factor"),
    "length_factor": Variable((), "1", "Length factor"),
    "belts_factor": Variable((), "1", "Factor for belts side by side"),
    "pulleys_factor": Variable((), "1", "Factor for the number of pulleys"),
}


@takes_options
def rating(
    drive: Drive,
    *,
    service_factor: Annotated[Ratio, Field(gt=0)] | None = None,
    at: float | str | None = None,
    progress: Report | None = None,
) -> Result:
    """Rate the belt in steady running: rated power, utilization, belts, ribs or width needed, and a verdict.

    The rated power is that of the belt's profile in the catalogue, by the law of `beltdyn.theory.rating` with the
    wrap, length, belts and pulleys factors. That of a toothed belt is by the law of `beltdyn.theory.rating`, with
    the teeth in mesh and the speed of the pulley. The design power is the power of a pulley times the service factor.

    Parameters
    ----------
    drive
        The drive, whose belt is given by a profile with a rating.
    service_factor
        Design power over power; by default limits.service_factor.
    at
        Instant at which speeds, torques and schedules are evaluated, such as "0.5 s", or in s; by default the end of
        the simulation.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Variables along ``pulley``, and the factors; checks of power, tension, slip, speed, pulleys and length along
        ``check``. The attribute ``verdict`` begins with "passes" or "fails"; ``rating_source`` names the source.

    Raises
    ------
    ModelError
        If the profile has no rating, the belt is not given by a profile, or the drive cannot run steadily.
    ConvergenceError
        If no steady running is found, but for a belt between fixed centers that slips through: it fails.

    Examples
    --------
    >>> found = bd.rating(bd.example("alternator_drive"), service_factor=1.2).dataset
    >>> found.largest_utilization.item() < 1.0, found.belts_needed.dims
    (True, ('pulley',))
    """
    held = held_at(_served(drive, service_factor), at)
    belt = _rated(held)
    loads = _loads(held, progress)
    found = rate(prepare(held), loads.speeds, loads.powers, loads.centers)
    assert found is not None
    used = utilization(held, found.power, loads.powers)
    speed = float(abs(loads.speeds[held.reference] * held.radii[held.reference]))
    if isinstance(found, MeshRating):
        assert isinstance(belt, RatedTeeth)
        values = _of_teeth(belt, found, loads.powers, used) | _scalars_of_teeth(belt, used, speed, held)
    else:
        assert isinstance(belt, RatedBelt)
        values = _of_belts(belt, found, loads.powers, used) | _scalars_of_belts(belt, used, speed, held)
    rest = install(held)
    required = required_tension(held, rest)
    checks = list(checks_of(held, belt, rest, required, Loads(used, loads.least_safety, speed)))
    values |= variables_of(checks) | loads.values
    values["tension_at_rest"] = Variable((), "N", "Tension at rest"), rest.tension
    values["rest_hub_load"] = Variable(_PULLEY, "N", "Hub load at rest"), np.linalg.norm(rest.hub_loads, axis=1)
    names = {
        "pulley": (COORDINATES["pulley"], [pulley.name for pulley in held.pulleys]),
        "check": (Variable(("check",), "1", "Check", "str"), [one.name for one in checks]),
    }
    warnings = [*loads.warnings, *_doubts(held, belt, found, speed)]
    result = build_result("rating", held, values, names, warnings)
    result.dataset.attrs |= {
        "drive_as_given": drive.text,
        "rating_source": belt.rating.source,
        "verdict": verdict_of(checks),
    }
    return result


class _Loads(NamedTuple):
    """Speeds and powers of all pulleys."""

    speeds: FloatArray
    powers: FloatArray
    """Into the drive, W."""
    centers: FloatArray
    least_safety: float
    """Least slip safety; zero where the belt slips through, NaN where teeth hold it."""
    values: Values
    """Hub loads, and lives where the belt has data."""
    warnings: list[str]


def _loads(drive: Drive, progress: Report | None) -> _Loads:
    """Loads in steady running; where the belt slips through, those that the drive file asks for."""
    try:
        run = steady_state(drive, progress=progress)
    except ConvergenceError as error:
        if drive.driver is None or drive.moving_tensioners:
            raise
        taken, speed = drive.belt_loads(drive.driver).powers_drawn(drive.path)
        if not taken.max() > 0.0:
            raise
        powers = -taken
        powers[drive.driver] = taken.sum()
        speeds = drive.running_sense * speed / drive.path.radii
        return _Loads(
            speeds,
            powers,
            drive.centers,
            0.0,
            {},
            [f"{str(error).rstrip('.')}. The rating is that of the loads asked for."],
        )
    means = means_of(run).pulleys
    speeds, powers, hub, safety = (
        np.array([getattr(one, name) for one in means]) for name in ("speed", "power", "hub_load", "least_safety")
    )
    values: Values = {
        "hub_load": (Variable(_PULLEY, "N", "Hub load"), hub),
        "slip_safety": (Variable(_PULLEY, "1", "Slip safety"), safety),
    }
    fatigue = fatigue_by_name(run)
    for name, label in (("cord_life", "Life of the cords"), ("rib_life", "Life of the ribs")):
        if name in fatigue:
            values[name] = Variable((), "h", label), fatigue[name]
    return _Loads(speeds, powers, run.dataset["pulley_center"].values[-1], float(np.fmin.reduce(safety)), values, [])


def _of_belts(belt: RatedBelt, found: PowerRating, powers: FloatArray, used: FloatArray) -> Values:
    """What the rating of V-belts or ribs tells of each pulley."""
    columns: tuple[Any, ...] = (
        found.diameter,
        found.wrap,
        powers,
        found.basic,
        found.ratio,
        found.wrap_factor,
        found.power,
        used,
        _belts_needed(belt, used),
    )
    return {name: (one, value) for (name, one), value in zip(COLUMNS.items(), columns, strict=True)}


def _belts_needed(belt: RatedBelt, used: FloatArray) -> list[float]:
    return [belt.belts_needed(one, used.size) if np.isfinite(one) else np.nan for one in used.tolist()]


def _scalars_of_belts(belt: RatedBelt, used: FloatArray, speed: float, drive: Drive) -> Values:
    """Factors of V-belts or ribs, and the worst pulley."""
    needed = np.array(_belts_needed(belt, used))
    most_needed = np.nan if np.isinf(used).any() else float(np.nanmax(needed))
    scalars: tuple[Any, ...] = (
        *(belt.belts, np.nanmax(used), most_needed, speed, drive.limits.service_factor or 1.0),
        *(belt.rating.length_factor(belt.nominal_length), belts_factor(belt.belts) if belt.in_set else 1.0),
        pulleys_factor(used.size),
    )
    return {name: (one, value) for (name, one), value in zip(SCALARS.items(), scalars, strict=True)}


def _of_teeth(belt: RatedTeeth, found: MeshRating, powers: FloatArray, used: FloatArray) -> Values:
    """What the rating of a toothed belt tells of each pulley."""
    columns: tuple[Any, ...] = (
        *(found.diameter, found.wrap, powers, found.in_mesh, found.mesh_factor, found.load, found.pull, found.power),
        *(used, belt.width * used),
    )
    return {name: (one, value) for (name, one), value in zip(COLUMNS_OF_TEETH.items(), columns, strict=True)}


def _scalars_of_teeth(belt: RatedTeeth, used: FloatArray, speed: float, drive: Drive) -> Values:
    """Width and the worst pulley."""
    largest = float(np.nanmax(used))
    scalars: tuple[Any, ...] = (
        *(belt.width, largest, belt.rating.next_width(belt.width * largest), speed),
        *(drive.limits.service_factor or 1.0, belt.rating.counted_teeth),
    )
    return {name: (one, value) for (name, one), value in zip(SCALARS_OF_TEETH.items(), scalars, strict=True)}


def _served(drive: Drive, service_factor: float | None) -> Drive:
    """The drive with a service factor."""
    if service_factor is None:
        return drive
    return drive.replace(limits=drive.limits.replace(service_factor=service_factor))


def _rated(drive: Drive) -> RatedBelt | RatedTeeth:
    """The belt as its profile is rated."""
    if drive.rated_belt is None:
        profile = drive.belt.value_of("profile")
        said = "the belt is not given by a profile" if profile is None else f'profile "{profile}" has no rating'
        raise ModelError(
            f"{said}, so that its rated power is unknown. Give a profile with a rating (see `beltdyn catalogue`), or a "
            "group [PROFILE.rating] in a catalogue of your own."
        )
    return drive.rated_belt


def _doubts(drive: Drive, belt: RatedBelt | RatedTeeth, found: PowerRating | MeshRating, speed: float) -> Iterator[str]:
    """What is outside the range of the rating."""
    largest, smallest = belt.rating.largest_speed, drive.belt.smallest_diameter
    if speed > largest * (1.0 + ROUNDING):
        yield (
            f"Outside the rating: the belt runs at {speed:.3g} m/s, but its rating ends at {largest:.3g} m/s, beyond "
            "which it has no rated power. Use smaller pulleys, or ask the manufacturer."
        )
    too_small = smaller_than_rated(drive)
    by_teeth = drive.belt.teeth is not None
    grooved = np.array([one.side == "inside" and (bool(one.teeth) or not by_teeth) for one in drive.pulleys])
    small = [one.name for one, counts in zip(drive.pulleys, too_small & grooved, strict=True) if counts]
    if small and smallest is not None:
        yield (
            f"Outside the rating: {listing(small)}, smaller than the smallest pulley of the profile, "
            f"{1e3 * smallest:.3g} mm; life falls by about the sixth power of the diameter. Use larger pulleys."
        )
    spent = (found.power == 0.0) & ~too_small & (speed <= largest)
    if np.any(spent):
        none = [one.name for one, is_spent in zip(drive.pulleys, spent, strict=True) if is_spent]
        causes = "no tooth is in mesh, or centrifugal force takes", "bending and centrifugal force take"
        cause = causes[not by_teeth]
        yield (
            f"{listing(none)}: the rated power is zero, since {cause} all of the rated "
            "pull. Use a larger pulley, a smaller speed or another profile."
        )
    if isinstance(belt, RatedBelt) and belt.rating.of_profile is not None:
        yield lower_bound(belt.rating.of_profile)
