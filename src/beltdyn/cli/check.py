"""`beltdyn check`."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_facts, show_table, show_warnings
from beltdyn.cli.progress import progress_bar

if TYPE_CHECKING:
    from beltdyn.model import Drive, Installation


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
    show_table(
        "\nPulleys",
        ("", "motion", "turns", "wrap angle", "effective radius", "speed ratio"),
        _pulleys(drive, installation),
    )
    show_table("\nPulleys at rest", ("", "penetration", "hub load", "direction"), _loads(drive, installation))
    show_table("\nSpans at rest", ("", "length", "tension", "first frequency"), _spans(drive, installation))
    if installation.tensioner_positions.size:
        show_table(
            "\nTensioners at rest",
            ("", "position", "spring", "stops", "other balances"),
            _tensioners(drive, installation),
        )
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

    return [
        ("path length", f"{installation.path.length:.5g} m"),
        ("belt length", f"{drive.belt_length:.5g} m unstretched, {drive.belt.elements} elements"),
        ("installed strain", f"{installation.strain:.4%}"),
        ("tension as laid", f"{installation.laid_tension:.4g} N"),
        ("element length", f"{drive.belt_length / drive.belt.elements:.3g} m{_layers(drive, installation)}"),
        ("tension at rest", f"{installation.tension:.4g} N{_origin(drive, installation, asked_for)}"),
        *_taken_up(drive),
        ("results of a run", f"about {describe_size(drive)}"),
        *([("computing time", time)] if (time := describe_time(drive)) else []),
    ]


def _taken_up(drive: "Drive") -> list[tuple[str, str]]:
    """Where fixed tensioners have put their pulleys: what a user asked for who gave length and tension."""
    fixed = [tensioner for tensioner in drive.tensioners if tensioner.kind == "fixed"]
    places = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    return [(f"center of {name}", f"[{x:.5g}, {y:.5g}] m, after its take-up") for name, (x, y) in places]


def _origin(drive: "Drive", installation: "Installation", asked_for: bool) -> str:
    asked = ", as asked for" * asked_for
    if installation.tensioner_positions.size:
        return f"{asked}, which tensioners set"
    if any(not end.held for end in drive.ends):
        return ", which the pulled end sets"
    gained = installation.tension / installation.laid_tension - 1
    change = f"{abs(gained):.1%} {'less' if gained < 0 else 'more'} than laid"
    return f"{asked}: {change}, by penetration into the pulleys and bending stiffness"


def _layers(drive: "Drive", installation: "Installation") -> str:
    """Where contact forces may have peaks, which only elements as short can show."""
    if not installation.tension > 0.0:
        return ""
    from beltdyn.model import layer_lengths

    bending, sinking = layer_lengths(drive, installation.tension)
    return f"; transition lengths at the ends of arcs: {bending:.2g} m of bending, {sinking:.2g} m of penetration"


def _pulleys(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    """The ratio of speeds is that of a belt that does not creep; a negative one means the other sense."""
    path = installation.path
    return [
        (
            pulley.name,
            "prescribed" if pulley.prescribed else "free",
            "ccw" if pulley.turning > 0 else "cw",
            f"{math.degrees(wrap):.1f}°",
            f"{abs(radius):.5g} m",
            f"{path.radii[0] / radius:.4f}",
        )
        for pulley, wrap, radius in zip(drive.pulleys, path.wrap_angles, path.radii, strict=True)
    ]


def _loads(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    return [
        (
            pulley.name,
            f"{depth:.2e} m ({depth / radius:.2%} of the radius)",
            f"{math.hypot(*load):.4g} N",
            f"{math.degrees(math.atan2(load[1], load[0])):.1f}°",
        )
        for pulley, depth, radius, load in zip(
            drive.pulleys, installation.penetrations, drive.radii, installation.hub_loads.tolist(), strict=True
        )
    ]


def _spans(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    columns = installation.path.span_lengths, installation.span_tensions, installation.span_frequencies
    return [
        (f"{start} to {end}", f"{length:.5g} m", f"{tension:.4g} N", f"{frequency:.4g} Hz")
        for (start, end), length, tension, frequency in zip(drive.spans, *columns, strict=True)
    ]


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
