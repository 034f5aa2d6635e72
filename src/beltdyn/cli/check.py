"""`beltdyn check`."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_facts, show_table, show_warnings

if TYPE_CHECKING:
    from beltdyn.model import Drive, Installation


def check(file: Path, /) -> None:
    """Validate a drive file, and say what to expect of the drive.

    Parameters
    ----------
    file
        The drive file, TOML.
    """
    from beltdyn.model import advise, install, load

    drive = load(file)
    installation = install(drive)
    show_facts(_facts(drive, installation))
    show_table("\nPulleys", ("", "motion", "radius", "wrap angle", "penetration"), _pulleys(drive, installation))
    show_table("\nSpans", ("", "length"), _spans(drive))
    show()
    show_warnings(advise(drive, installation))


def _facts(drive: "Drive", installation: "Installation") -> list[tuple[str, str]]:
    lost = 1 - installation.tension / installation.laid_tension
    return [
        ("path length", f"{drive.path.length:.5g} m"),
        ("belt length", f"{drive.belt.length:.5g} m unstretched, {drive.belt.elements} elements"),
        ("installed strain", f"{installation.strain:.4%}"),
        ("tension as laid", f"{installation.laid_tension:.4g} N"),
        ("element length", f"{drive.belt.length / drive.belt.elements:.3g} m{_layers(drive, installation)}"),
        ("tension at rest", f"about {installation.tension:.4g} N: {lost:.1%} is lost by sinking into the pulleys"),
    ]


def _layers(drive: "Drive", installation: "Installation") -> str:
    """Where contact forces may have peaks, which only elements as short can show."""
    if not installation.tension > 0.0:
        return ""
    from beltdyn.model import layer_lengths

    bending, sinking = layer_lengths(drive, installation.tension)
    return f"; the belt turns onto pulleys within {bending:.2g} m by bending, {sinking:.2g} m by sinking in"


def _pulleys(drive: "Drive", installation: "Installation") -> list[tuple[str, ...]]:
    return [
        (
            pulley.name,
            "prescribed" if pulley.prescribed else "free",
            f"{pulley.radius:.5g} m",
            f"{math.degrees(wrap):.1f}°",
            f"{depth:.2e} m ({depth / pulley.radius:.2%} of the radius)",
        )
        for pulley, wrap, depth in zip(drive.pulleys, drive.path.wrap_angles, installation.penetrations, strict=True)
    ]


def _spans(drive: "Drive") -> list[tuple[str, ...]]:
    names = [pulley.name for pulley in drive.pulleys]
    ends = zip(names, names[1:] + names[:1], drive.path.span_lengths, strict=True)
    return [(f"{start} to {end}", f"{length:.5g} m") for start, end, length in ends]
