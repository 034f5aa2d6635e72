"""A drive at rest as it is written for a reader: facts, pulleys, spans, tensioners, and what is chosen."""

import math

from beltdyn.model import Drive, Installation, describe_time, tensioner_balances
from beltdyn.model.frame import unused_settings
from beltdyn.model.hysteresis import bending_resistance, compression_losses
from beltdyn.model.plausibility import other_diameters
from beltdyn.parts.columns import aligned
from beltdyn.results.sheet_parts import Facts, Sheet, Table
from beltdyn.results.size import describe_size

_PULLEY_HEADINGS = (
    "",
    "speed",
    "turns",
    "wrap",
    "effective\nradius mm",
    "speed\nratio",
    "belt sinks\nin by mm",
    "hub load\nN",
    "its\ndirection",
)


_SPAN_HEADINGS = ("", "length\nm", "tension\nN", "first frequency\nHz")
_TENSIONER_HEADINGS = ("", "position", "spring", "stops", "other balances")

_SAME_TENSION = 5e-4
"""Part of the tension by which bending and soft contact may change it without a word."""
_HALF_TURN = 179.95
"""Degrees from which on a direction is written as 180.0."""


def rest_sheet(given: Drive, drive: Drive, installation: Installation) -> Sheet:
    """Give what there is to say of a drive at rest.

    Parameters
    ----------
    given : Drive
        The drive of the file.
    drive : Drive
        With the length, or the take-up, that gives the installed tension.
    installation : Installation
        What static equilibrium gave for it, or estimates.

    Returns
    -------
    Sheet
        Facts of the belt, tables of pulleys, spans and tensioners, and the numbers that are chosen.
    """
    parts: list[Table | Facts] = [
        Facts(tuple(_facts(given, drive, installation))),
        Table("Pulleys at rest", _PULLEY_HEADINGS, tuple(_pulleys(drive, installation))),
        Table("Spans at rest", _SPAN_HEADINGS, tuple(_spans(drive, installation))),
    ]
    if installation.tensioner_positions.size:
        parts.append(Table("Tensioners at rest", _TENSIONER_HEADINGS, tuple(_tensioners(drive, installation))))
    if given.completed.choices:
        parts.append(Facts(tuple(_choices(given)), "Chosen, since the file leaves it open"))
    return Sheet("", tuple(parts))


def _facts(given: Drive, drive: Drive, installation: Installation) -> list[tuple[str, str]]:
    asked_for = given.belt.installed_tension is not None
    length, path = drive.belt_length, installation.path.length
    unused = unused_settings(drive.belt, drive.contact) if drive.frame.stays else []
    return [
        *([("drive", drive.name)] if drive.name else []),
        ("tension at rest", f"{installation.tension:.4g} N{_origin(drive, installation, asked_for)}"),
        ("belt length", f"{length:.5g} m unstretched, {installation.strain:z.3%} longer on its path of {path:.5g} m"),
        *_as_sold(given, drive),
        *_taken_up(drive),
        ("mesh", f"{drive.elements} {drive.element_kind.name} elements, {drive.frame.words}"),
        ("length of elements", f"{1e3 * length / drive.elements:.3g} mm{_in_the_mean(drive)}"),
        *([("not used", f"{', '.join(unused)}: only a mesh that travels has it")] if unused else []),
        *_lost_in_the_belt(drive),
        ("results of a run", f"about {describe_size(drive)}"),
        *([("computing time", time)] if (time := describe_time(drive)) else []),
    ]


def _as_sold(given: Drive, drive: Drive) -> list[tuple[str, str]]:
    """The length by which the belt is sold, with the force that measures it, and what other diameters would mean."""
    belt, force = drive.belt, drive.belt.measuring_force
    sold = force is not None or belt.nominal_length is not None
    if drive.ends or not sold:
        return []
    nominal = f"{belt.nominal_length_of(drive.belt_length):.5g} m"
    other = other_diameters(given)
    diameters = [("with pitch diameters", other)] if other else []
    if force is None:
        return [("nominal length", f"{nominal}, taken as unstretched: no measuring force is known"), *diameters]
    stretched = f"{belt.measured_stretch - 1.0:.3%} longer than unstretched"
    return [("nominal length", f"{nominal} under {force:.4g} N between two pulleys, {stretched}"), *diameters]


def _in_the_mean(drive: Drive) -> str:
    """Elements that travel with the belt are all of one length."""
    return ", in the mean" if drive.frame.stays else ""


def _taken_up(drive: Drive) -> list[tuple[str, str]]:
    """Where fixed tensioners have put their pulleys: what a user asked for who gave length and tension."""
    fixed = [tensioner for tensioner in drive.tensioners if tensioner.kind == "fixed"]
    places = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    return [(f"center of {name}", f"[{x:.5g}, {y:.5g}] m, after its take-up") for name, (x, y) in places]


def _lost_in_the_belt(drive: Drive) -> list[tuple[str, str]]:
    """What the loss factors of bending and compression cost, at any speed and load."""
    forces = {"bending": bending_resistance(drive), "compression": compression_losses(drive).sum()}
    return [
        (f"lost in {cause}", f"{force:.3g} N of the pull at the belt, {force:.3g} W for each m/s of its speed")
        for cause, force in forces.items()
        if force > 0.0
    ]


def _origin(drive: Drive, installation: Installation, asked_for: bool) -> str:
    asked = ", as asked for" * asked_for
    if installation.tensioner_positions.size:
        return f"{asked}, which tensioners set"
    if any(not end.held for end in drive.ends):
        return ", which the pulled end sets"
    gained = installation.tension / installation.laid_tension - 1
    if abs(gained) < _SAME_TENSION:
        return asked
    change = f"{abs(gained):.1%} {'less' if gained < 0 else 'more'} than the {installation.laid_tension:.4g} N"
    return f"{asked}: {change} of a limp belt on hard pulleys"


def _pulleys(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    """The ratio of speeds is that of a belt that does not creep; a negative one means the other sense."""
    path, loads = installation.path, installation.hub_loads.tolist()
    return list(
        zip(
            (pulley.name for pulley in drive.pulleys),
            ("prescribed" if pulley.prescribed else "free" for pulley in drive.pulleys),
            ("ccw" if drive.running_sense * pulley.turning > 0 else "cw" for pulley in drive.pulleys),
            (f"{math.degrees(wrap):.1f}°" for wrap in path.wrap_angles),
            aligned([1e3 * abs(radius) for radius in path.radii], 5),
            (f"{path.radii[0] / radius:.4f}" for radius in path.radii),
            aligned([1e3 * depth for depth in installation.penetrations], 2),
            aligned([math.hypot(*load) for load in loads]),
            (f"{_angle(load):z.1f}°" for load in loads),
            strict=True,
        )
    )


def _angle(force: list[float]) -> float:
    """Direction of a force, above -180° up to 180°."""
    angle = math.degrees(math.atan2(force[1], force[0]))
    return angle if angle > -_HALF_TURN else angle + 360.0


def _spans(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    columns = installation.path.span_lengths, installation.span_tensions, installation.span_frequencies
    names = (f"{start} to {end}" for start, end in drive.spans)
    return list(zip(names, *(aligned(column.tolist()) for column in columns), strict=True))


def _tensioners(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    rows = list[tuple[str, ...]]()
    others = _others(drive, installation)
    for tensioner, position, other in zip(
        drive.moving_tensioners, installation.tensioner_positions.tolist(), others, strict=True
    ):
        unit = "N m" if tensioner.turns else "N"
        rows.append(
            (
                tensioner.pulley,
                tensioner.written(position),
                f"{tensioner.preload - tensioner.rate * position:.4g} {unit}",
                " to ".join(tensioner.written(stop) for stop in tensioner.stops or ()),
                other or "none",
            )
        )
    return rows


def _choices(drive: Drive) -> list[tuple[str, str]]:
    """Numbers that the file leaves open, as they are chosen, with their reasons."""
    return [(choice.key, choice.words) for choice in drive.completed.choices]


def _others(drive: Drive, installation: Installation) -> list[str]:
    """Where tensioners balance the belt too, one text for each spring-loaded tensioner, empty without any."""
    return [
        ", ".join(
            f"{tensioner.written(balance.position)} ({'stable' if balance.stable else 'not stable'})"
            for balance in balances
            if not balance.here
        )
        for tensioner, balances in zip(drive.moving_tensioners, tensioner_balances(drive, installation), strict=True)
    ]
