"""Power rating of the belt of a drive: rated power, utilization and number of belts needed at each pulley."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.model.rating import PowerRating, RatedBelt
from beltdyn.parts.messages import listing
from beltdyn.points.changed_drive import held_at
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.schema import COORDINATES
from beltdyn.results.summary import means_of
from beltdyn.results.utilization import rate, utilization
from beltdyn.solvers.progress import Report
from beltdyn.state.steady import steady_state
from beltdyn.theory.belt_rating import belts_factor, pulleys_factor

_PULLEY = ("pulley",)

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


def rating(
    drive: Drive,
    *,
    service_factor: float | None = None,
    at: float | str | None = None,
    progress: Report | None = None,
) -> Result:
    """Rate the belt in steady running: rated power, utilization and number of belts or ribs needed at each pulley.

    The rated power is that of the belt's profile in the catalogue, by the law of `beltdyn.theory.belt_rating` with the
    wrap, length, belts and pulleys factors. The design power is the power of a pulley times the service factor.

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
        Variables along ``pulley``, and the factors; the attribute ``rating_source`` names the source of the rating.

    Raises
    ------
    ModelError
        If the profile has no rating, the belt is not given by a profile, or the drive cannot run steadily.
    ConvergenceError
        If no steady running is found.

    Examples
    --------
    >>> found = bd.rating(bd.example("alternator_drive"), service_factor=1.2).dataset
    >>> found.largest_utilization.item() < 1.0, found.belts_needed.dims
    (True, ('pulley',))
    """
    held = held_at(_served(drive, service_factor), at)
    belt = _rated(held)
    run = steady_state(held, progress=progress)
    means, centers = means_of(run).pulleys, run.dataset["pulley_center"].values[-1]
    speeds, powers = (np.array([getattr(one, name) for one in means]) for name in ("speed", "power"))
    found = rate(prepare(held), speeds, powers, centers)
    assert found is not None
    used = utilization(held, found.power, powers)
    pulleys = len(held.pulleys)
    needed = [belt.belts_needed(one, pulleys) if np.isfinite(one) else np.nan for one in used.tolist()]
    columns: tuple[Any, ...] = (
        found.diameter,
        found.wrap,
        powers,
        found.basic,
        found.ratio,
        found.wrap_factor,
        found.power,
        used,
        needed,
    )
    speed = float(abs(speeds[held.reference] * held.radii[held.reference]))
    scalars: tuple[Any, ...] = (
        *(belt.belts, np.nanmax(used), np.nanmax(needed), speed, held.limits.service_factor or 1.0),
        *(belt.rating.length_factor(belt.nominal_length), belts_factor(belt.belts) if belt.in_set else 1.0),
        pulleys_factor(pulleys),
    )
    values = {name: (one, value) for (name, one), value in zip(COLUMNS.items(), columns, strict=True)}
    values |= {name: (one, value) for (name, one), value in zip(SCALARS.items(), scalars, strict=True)}
    names = {"pulley": (COORDINATES["pulley"], [pulley.name for pulley in held.pulleys])}
    result = build_result("rating", held, values, names, list(_doubts(held, belt, found, speed)))
    result.dataset.attrs |= {"drive_as_given": drive.text, "rating_source": belt.rating.source}
    return result


def _served(drive: Drive, service_factor: float | None) -> Drive:
    """The drive with a service factor."""
    if service_factor is None:
        return drive
    return drive.replace(limits=drive.limits.replace(service_factor=service_factor))


def _rated(drive: Drive) -> RatedBelt:
    """The belt as its profile is rated."""
    if drive.rated_belt is None:
        profile = drive.belt.value_of("profile")
        said = "the belt is not given by a profile" if profile is None else f'profile "{profile}" has no rating'
        raise ModelError(
            f"{said}, so that its rated power is unknown. Give a profile with a rating (see `beltdyn catalogue`), or a "
            "group [PROFILE.rating] in a catalogue of your own."
        )
    return drive.rated_belt


def _doubts(drive: Drive, belt: RatedBelt, found: PowerRating, speed: float) -> Iterator[str]:
    """What is outside the range of the rating."""
    largest = belt.rating.largest_speed
    if speed > largest:
        yield (
            f"The belt runs at {speed:.3g} m/s, beyond the {largest:.3g} m/s up to which its rating holds: the rated "
            "power is extrapolated. Use smaller pulleys, or ask the manufacturer."
        )
    smallest = drive.belt.smallest_diameter
    grooved = [one for one in drive.pulleys if one.side == "inside"]
    small = [one.name for one in grooved if smallest is not None and 2.0 * one.radius < smallest * (1.0 - 1e-9)]
    if small and smallest is not None:
        yield (
            f"{listing(small)}: smaller than {1e3 * smallest:.3g} mm, the smallest pulley of the profile, from which "
            "on its rating holds; life falls by about the sixth power of the diameter. Use larger pulleys."
        )
    if np.any(found.power == 0.0):
        none = [one.name for one, power in zip(drive.pulleys, found.power.tolist(), strict=True) if power == 0.0]
        yield (
            f"{listing(none)}: the rated power is zero, since bending and centrifugal force take all of the rated "
            "pull. Use a larger pulley, a smaller speed or another profile."
        )
