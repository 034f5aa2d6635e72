"""How the belt of a drive is tensioned on the machine, and how that is checked."""

from typing import NamedTuple

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, Installation, install
from beltdyn.model.tensioning import DEFLECTION, TensionCheck, tension_checks
from beltdyn.parts.messages import aligned
from beltdyn.show.sheet import Table

_NAMED = {"new": "of a new belt", "run in": "run in", "least": "before it is tensioned again"}


class Tensioning(NamedTuple):
    """An instruction to tension a belt."""

    facts: tuple[tuple[str, str], ...]
    table: Table
    """Frequency and force of each span."""


def tensioning(drive: Drive, specified: float | None = None) -> Tensioning | None:
    """Say how to tension a belt: its tension at rest, and how spans vibrate and deflect with it; None if slack."""
    try:
        return instruction(drive, install(drive), specified)
    except (BeltdynError, ValueError):
        return None


def instruction(drive: Drive, installation: Installation, specified: float | None = None) -> Tensioning | None:
    """Say how to tension a belt with its state at rest; None if it is slack."""
    checks = tension_checks(drive, installation, specified)
    if not checks or not all(check.frequencies.min() > 0.0 for check in checks):
        return None
    return Tensioning(tuple(_facts(drive, checks)), _table(drive, installation, checks))


def _facts(drive: Drive, checks: tuple[TensionCheck, ...]) -> list[tuple[str, str]]:
    fixed = [one for one in drive.tensioners if one.kind == "fixed"]
    centers = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    held = len(checks) == 1
    said = [("tension at rest", f"{checks[0].tension:.4g} N, held by its tensioner")] if held else []
    said += [(f"tension {_NAMED[one.state]}", f"{one.tension:.4g} N") for one in checks if not held]
    each = f"each of {drive.belt.v_belts} V-belts" if drive.belt.v_belts > 1 else "the belt"
    return [
        *said,
        *((f"center of {name}", f"[{x:.5g}, {y:.5g}] m after take-up") for name, (x, y) in centers),
        ("frequency meter", "first frequency of a span plucked at rest"),
        ("force", f"on {each} across the middle of a span, which deflects it by {1e3 * DEFLECTION:.3g} mm per m"),
    ]


def _table(drive: Drive, installation: Installation, checks: tuple[TensionCheck, ...]) -> Table:
    """Frequency and force of each span, in each state."""
    lengths = installation.path.span_lengths.tolist()
    columns = [aligned(lengths, 4), aligned([1e3 * DEFLECTION * one for one in lengths], 3)]
    headings = ["", "length\nm", "deflection\nmm"]
    for check in checks:
        for unit, values in (("Hz", check.frequencies), ("N", check.forces)):
            headings.append(f"{check.state}\n{unit}")
            columns.append(aligned(values.tolist(), 3))
    names = [f"{start} to {end}" for start, end in drive.spans]
    return Table("Tensioning", tuple(headings), tuple(zip(names, *columns, strict=True)))
