"""`beltdyn check`."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_facts, show_table, show_warnings
from beltdyn.cli.progress import progress_bar
from beltdyn.parts.columns import aligned

if TYPE_CHECKING:
    from beltdyn.model import Drive, Installation


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


_SAME_TENSION = 5e-4
"""Part of the tension by which bending and soft contact may change it without a word."""
_HALF_TURN = 179.95
"""Degrees from which on a direction is written as 180.0."""


def check(
    file: Path,
    /,
    *,
    figure: Annotated[Path | None, Parameter(alias="-f")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Validate a drive file, and say what to expect of the drive at rest.

    Parameters
    ----------
    file
        The drive file, TOML.
    figure
        Draw the layout into this file too, such as layout.png; it replaces figures of beltdyn, and no other files.
    force
        Replace other files too.
    """
    from beltdyn.errors import ConvergenceError
    from beltdyn.model import advise, install, load, unstable_balance
    from beltdyn.solve import bring_to_rest

    drive = given = load(file)
    if figure is not None:
        from beltdyn.results.atomic import is_marked, require_replaceable

        require_replaceable(figure, is_marked, force)
    estimate = install(drive)
    failure: ConvergenceError | None = None
    unstable: tuple[str, ...] = ()
    try:
        with progress_bar() as report:
            rest = bring_to_rest(drive, report)
        drive, installation, unstable = rest.drive, rest.installation, rest.unstable
    except ConvergenceError as error:
        failure, installation = error, estimate
        show("No static equilibrium was found. These are estimates by hand, without bending and weight.\n")
    show_facts(_facts(drive, installation, given.belt.installed_tension is not None))
    show_table("\nPulleys at rest", _PULLEY_HEADINGS, _pulleys(drive, installation))
    show_table("\nSpans at rest", ("", "length\nm", "tension\nN", "first frequency\nHz"), _spans(drive, installation))
    if installation.tensioner_positions.size:
        show_table(
            "\nTensioners at rest",
            ("", "position", "spring", "stops", "other balances"),
            _tensioners(drive, installation),
        )
    if given.completed.choices:
        show("\nChosen, since the file leaves it open")
        show_facts(_choices(given))
    show()
    show_warnings([*([str(unstable_balance(unstable))] if unstable else []), *advise(given, estimate)])
    if figure is None:
        show(f"To see the layout: beltdyn check {file} --figure layout.png")
    else:
        from beltdyn import plot

        show(f"Layout: {plot.save_layout(drive, figure, installation, force)}")
    if failure:
        raise failure


def _facts(drive: "Drive", installation: "Installation", asked_for: bool) -> list[tuple[str, str]]:
    from beltdyn.model import describe_time
    from beltdyn.results import describe_size

    length, path = drive.belt_length, installation.path.length
    return [
        *([("drive", drive.name)] if drive.name else []),
        ("tension at rest", f"{installation.tension:.4g} N{_origin(drive, installation, asked_for)}"),
        ("belt length", f"{length:.5g} m unstretched, {installation.strain:.3%} longer on its path of {path:.5g} m"),
        *_taken_up(drive),
        ("elements", f"{drive.elements} of {1e3 * length / drive.elements:.3g} mm"),
        *_lost_in_the_belt(drive),
        ("results of a run", f"about {describe_size(drive)}"),
        *([("computing time", time)] if (time := describe_time(drive)) else []),
    ]


def _taken_up(drive: "Drive") -> list[tuple[str, str]]:
    """Where fixed tensioners have put their pulleys: what a user asked for who gave length and tension."""
    fixed = [tensioner for tensioner in drive.tensioners if tensioner.kind == "fixed"]
    places = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    return [(f"center of {name}", f"[{x:.5g}, {y:.5g}] m, after its take-up") for name, (x, y) in places]


def _lost_in_the_belt(drive: "Drive") -> list[tuple[str, str]]:
    """What the loss factors of bending and compression cost, at any speed and load."""
    from beltdyn.model.hysteresis import bending_resistance, compression_losses

    forces = {"bending": bending_resistance(drive), "compression": compression_losses(drive).sum()}
    return [
        (f"lost in {cause}", f"{force:.3g} N of the pull at the belt, {force:.3g} W for each m/s of its speed")
        for cause, force in forces.items()
        if force > 0.0
    ]


def _origin(drive: "Drive", installation: "Installation", asked_for: bool) -> str:
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


def _pulleys(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    """The ratio of speeds is that of a belt that does not creep; a negative one means the other sense."""
    path, loads = installation.path, installation.hub_loads.tolist()
    return list(
        zip(
            (pulley.name for pulley in drive.pulleys),
            ("prescribed" if pulley.prescribed else "free" for pulley in drive.pulleys),
            ("ccw" if pulley.turning > 0 else "cw" for pulley in drive.pulleys),
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


def _spans(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    columns = installation.path.span_lengths, installation.span_tensions, installation.span_frequencies
    names = (f"{start} to {end}" for start, end in drive.spans)
    return list(zip(names, *(aligned(column.tolist()) for column in columns), strict=True))


def _tensioners(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    rows = list[tuple[str, ...]]()
    others = other_balances(drive, installation)
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


def _choices(drive: "Drive") -> list[tuple[str, str]]:
    """Numbers that the file leaves open, as they are chosen, with their reasons."""
    return [(choice.key, choice.words) for choice in drive.completed.choices]


def other_balances(drive: "Drive", installation: "Installation") -> list[str]:
    """Where tensioners balance the belt too, one text for each spring-loaded tensioner, empty without any."""
    from beltdyn.model import tensioner_balances

    return [
        ", ".join(
            f"{tensioner.written(balance.position)} ({'stable' if balance.stable else 'not stable'})"
            for balance in balances
            if not balance.here
        )
        for tensioner, balances in zip(drive.moving_tensioners, tensioner_balances(drive, installation), strict=True)
    ]
