"""The sheet of a drive at rest: facts, pulleys, spans, tensioners, and chosen values."""

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from beltdyn.errors import BeltdynError, ConvergenceError, TimeLimitError
from beltdyn.model import (
    Drive,
    Installation,
    Path,
    Pulley,
    advise,
    alignment,
    describe_time,
    estimate_at_rest,
    install,
    prepare,
    tensioner_balances,
    unstable_balance,
)
from beltdyn.model.alignment import is_given
from beltdyn.model.belt_loads import RequiredTension
from beltdyn.model.carrier import Carrier
from beltdyn.model.carrying import swinging_lengths
from beltdyn.model.demand import required_tension
from beltdyn.model.hysteresis import bending_resistance, compression_losses
from beltdyn.model.installation import DEFLECTION, TensionCheck, tension_checks
from beltdyn.model.layout import teeth_in_mesh
from beltdyn.model.plausibility import other_diameters
from beltdyn.model.simulation import unused_settings
from beltdyn.model.toothing import RatedTeeth
from beltdyn.parts.messages import Finding, aligned, listing
from beltdyn.results.layout import describe_size
from beltdyn.show.notebook import picture, templates
from beltdyn.show.sheet import TENSION_HEADINGS, tension_columns
from beltdyn.show.tables import Facts, Sheet, Table, as_text
from beltdyn.solvers.run_progress import Report
from beltdyn.solvers.time_limit import time_limit
from beltdyn.state.installation import bring_to_rest, is_compiled

_LONGEST_SEARCH = 5.0
"""Processor time of a search for equilibrium that nobody asked for, s; those of all examples take below 2 s."""


@dataclass(frozen=True, repr=False)
class Check:
    """A drive at rest, and what is probably not meant in it; ``print`` shows all."""

    drive: Drive
    """The drive, with the belt length or the take-up that gives its installed tension."""
    installation: Installation
    """Tension, penetrations, hub loads and span frequencies at rest."""
    warnings: list[str]
    """What is probably not meant, by how much it matters, and remedies."""
    sheet: Sheet
    """Tables and facts for a reader."""
    computed: bool = field(default=True)
    """Whether the installation is that of the computed equilibrium, and not of closed forms."""
    failure: ConvergenceError | None = field(default=None)
    """Why there is no static equilibrium, if it was sought."""

    def __repr__(self) -> str:
        count = len(self.warnings)
        return (
            f'Check of "{self.drive.title}": {self.installation.tension:.4g} N at rest'
            f"{' (closed form)' * (not self.computed)}, {count or 'no'} warning{'s' * (count != 1)}"
        )

    def __str__(self) -> str:
        return "\n".join([as_text(self.sheet), *(f"warning: {warning}" for warning in self.warnings)])

    def _repr_html_(self) -> str:
        page = templates().get_template("result.html.jinja")
        shown = {"drive": self.drive, "picture": picture(self.drive), "sheet": self.sheet.parts}
        return page.render(**shown, kind="drive", status="at rest", warnings=self.warnings)


def check(drive: Drive, progress: Report | None = None, *, equilibrium: bool | None = None) -> Check:
    """Bring a drive to rest, and look for what is probably not meant.

    Closed forms need no compilation of kernels. Their tensions, hub loads and span frequencies are within 1 % of the
    computed equilibrium on meshes that resolve the tension; see `beltdyn.model.estimate_at_rest`.

    Parameters
    ----------
    drive : Drive
        The drive.
    progress : callable, optional
        Called with a `Progress` before compilation and before the search.
    equilibrium : bool, optional
        Whether to compute the static equilibrium; by default where its kernels are compiled, and for at most 5 s of
        processor time. Belts with teeth, supports or goods are judged by closed forms.

    Returns
    -------
    Check
        With a `failure`, and of closed forms, if there is no static equilibrium.

    Examples
    --------
    >>> checked = bd.check(drive)
    >>> round(checked.installation.tension), len(checked.warnings)  # N
    (27, 4)
    >>> checked.installation.hub_loads.shape
    (2, 2)
    """
    told = advise(drive, install(drive))
    if not drive.stays_at_rest and (equilibrium or (equilibrium is None and is_compiled(drive))):
        try:
            with time_limit(None if equilibrium else _LONGEST_SEARCH):
                rest = bring_to_rest(drive, progress)
        except TimeLimitError as error:
            return _estimated(drive, [str(_unfinished(error)), *told])
        except ConvergenceError as error:
            return replace(_estimated(drive, told), failure=error)
        unstable = [str(unstable_balance(rest.unstable))] if rest.unstable else []
        found = rest.installation
        return Check(rest.drive, found, [*unstable, *told], rest_sheet(drive, rest.drive, found))
    return _estimated(drive, told)


def _estimated(drive: Drive, told: list[str]) -> Check:
    """A drive at rest by closed forms."""
    prepared, found = estimate_at_rest(prepare(drive))
    told = [*limitations(found), *told]
    sheet = rest_sheet(drive, prepared.drive, found, computed=False)
    return Check(prepared.drive, found, told, sheet, computed=False)


def limitations(installation: Installation) -> list[str]:
    """What the closed forms of a belt at rest leave out, as warnings."""
    if not installation.limitation:
        return []
    finding = Finding(
        f"closed forms with bending stiffness and weight do not hold for this belt at rest: {installation.limitation}",
        "Tensions, hub loads and frequencies are those of a flexible belt without weight.",
        "Compute the static equilibrium: beltdyn equilibrium.",
    )
    return [str(finding)]


def _unfinished(error: TimeLimitError) -> Finding:
    """A search for equilibrium that took too long."""
    return Finding(
        f"no static equilibrium is known: {error}",
        "Tensions, hub loads and frequencies are closed forms.",
        "Search to the end: beltdyn check --equilibrium.",
    )


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
    needed = required_tension(drive, installation)
    checks = tension_checks(drive, installation, specified, None if needed is None else needed.tension)
    if not checks or not all(check.frequencies.min() > 0.0 for check in checks):
        return None
    facts = (*_least_facts(needed), *_tension_facts(drive, checks))
    return Tensioning(facts, _tension_table(drive, installation, checks))


def _least_facts(needed: RequiredTension | None) -> list[tuple[str, str]]:
    """The least tension by each formula."""
    if needed is None:
        return []
    by_formula = listing([f"{tension:.4g} N ({name})" for name, tension in needed.by_formula.items()])
    if needed.load:
        return [("recommended tension", f"at least {by_formula}, for {needed.load}")]
    return [("least tension", f"{by_formula}, for the pull of {needed.pull:.4g} N with the service factor")]


def _tension_facts(drive: Drive, checks: tuple[TensionCheck, ...]) -> list[tuple[str, str]]:
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


def _tension_table(drive: Drive, installation: Installation, checks: tuple[TensionCheck, ...]) -> Table:
    """Frequency and force of each span, in each state."""
    lengths = swinging_lengths(drive.supports, drive.spans, installation.path).tolist()
    columns = [aligned(lengths, 4), aligned([1e3 * DEFLECTION * one for one in lengths], 3)]
    headings = ["", "length\nm", "deflection\nmm"]
    for check in checks:
        for unit, values in (("Hz", check.frequencies), ("N", check.forces)):
            headings.append(f"{check.state}\n{unit}")
            columns.append(aligned(values.tolist(), 3))
    names = [f"{start} to {end}" for start, end in drive.spans]
    return Table("Tensioning", tuple(headings), tuple(zip(names, *columns, strict=True)))


_PULLEY_HEADINGS = (
    "",
    "speed",
    "turns",
    "wrap",
    "effective\nradius mm",
    "speed\nratio",
    "penetration\nmm",
    "hub load\nN",
    "hub load\ndirection",
)


_SPAN_HEADINGS = ("", "length\nm", *TENSION_HEADINGS, "first frequency\nHz")
_TENSIONER_HEADINGS = ("", "position", "spring", "stops", "other equilibria")

_TOOTH_HEADINGS = ("", "teeth", "teeth\nin mesh", "pitch\ndiameter mm", "turns over\nthose of the first")
_PULL_HEADING = "allowed\npull N"
_BELTS_BESIDE = 2
"""Standard belts named on either side of the one of the drive."""

_SAME_TENSION = 5e-4
"""Relative change of tension by bending and soft contact that is not mentioned."""
_HALF_TURN = 179.95
"""Angle from which a direction is shown as 180.0, degrees."""


_COMPUTED = "computed"
_CLOSED_FORM = "closed form, within 1 % of the computed equilibrium; penetrations less so"
_LIMITED_CLOSED_FORM = "closed form without bending stiffness and weight; see the warning"


def rest_sheet(given: Drive, drive: Drive, installation: Installation, *, computed: bool = True) -> Sheet:
    """Summarize a drive at rest, as computed or by closed forms."""
    method = _COMPUTED if computed else _LIMITED_CLOSED_FORM if installation.limitation else _CLOSED_FORM
    parts: list[Table | Facts] = [
        Facts((*_facts(given, drive, installation), ("static equilibrium", method))),
        Table("Pulleys at rest", _PULLEY_HEADINGS, tuple(_pulleys(drive, installation))),
        Table("Spans at rest", _SPAN_HEADINGS, tuple(_spans(drive, installation))),
    ]
    if drive.belt.teeth is not None:
        parts.append(_tooth_table(drive, installation))
    if installation.tensioner_positions.size:
        parts.append(Table("Tensioners at rest", _TENSIONER_HEADINGS, tuple(_tensioners(drive, installation))))
    if drive.belt.entry is not None and (told := instruction(drive, installation)) is not None:
        parts.append(told.table)
    if is_given(given) and not given.ends:
        parts.append(alignment_table(given, installation.path))
    choices = tuple((choice.key, choice.words) for choice in prepare(given).choices)
    if choices:
        parts.append(Facts(choices, "Chosen values (not given in the file)"))
    return Sheet("", tuple(parts))


def _facts(given: Drive, drive: Drive, installation: Installation) -> list[tuple[str, str]]:
    asked_for = prepare(given).installed_tension is not None
    length, path = drive.belt_length, installation.path.length
    unused = unused_settings(drive.belt, drive.contact) if drive.frame.stays else []
    return [
        *([("drive", drive.name)] if drive.name else []),
        ("tension at rest", f"{installation.tension:.4g} N{_origin(given, drive, installation, asked_for)}"),
        *_least_facts(required_tension(drive, installation)),
        (
            "belt length",
            f"{length:.5g} m unstretched, stretched by {installation.strain:z.3%} on its path of {path:.5g} m",
        ),
        *_pitches(drive, installation),
        *_as_sold(given, drive),
        *_taken_up(drive),
        ("mesh", f"{drive.elements} {drive.element_kind.name} elements, {drive.frame.words}"),
        ("element length", f"{1e3 * length / drive.elements:.3g} mm{_in_the_mean(drive)}"),
        *([("not used", f"{', '.join(unused)} (only for a travelling mesh)")] if unused else []),
        *_lost_in_the_belt(drive),
        *(_run_facts(drive) if drive.simulation.given_duration is not None else []),
    ]


def _run_facts(drive: Drive) -> list[tuple[str, str]]:
    """What a run over time needs."""
    time = describe_time(drive)
    return [
        ("result size", f"about {describe_size(prepare(drive))}"),
        *([("computing time", time)] if time else []),
    ]


def _pitches(drive: Drive, installation: Installation) -> list[tuple[str, str]]:
    """Teeth of the belt, and pitches of its path."""
    toothing, teeth = drive.belt.toothing, drive.belt.teeth
    if toothing is None or teeth is None:
        return []
    path = installation.path.length / drive.belt.given_pitch
    return [
        ("teeth of the belt", f"{teeth} of a pitch of {1e3 * toothing.pitch:.5g} mm; the path has {path:.3f} pitches"),
        *_standard_belts(drive, teeth),
    ]


def _standard_belts(drive: Drive, teeth: int) -> list[tuple[str, str]]:
    """Closed belts near that of the drive, and widths, in which its profile is sold."""
    entry = drive.belt.entry
    counts = sorted(entry.tooth_counts) if entry is not None and not drive.ends else []
    found = list[tuple[str, str]]()
    if counts:
        place = bisect_left(counts, teeth)
        beside = counts[max(place - _BELTS_BESIDE, 0) : place + _BELTS_BESIDE + (teeth in counts)]
        said = "a standard belt" if teeth in counts else "not a standard belt"
        found.append(("standard teeth", f"{teeth} are {said}; there are {', '.join(map(str, beside))}"))
    if entry is not None and entry.tooth_rating is not None and entry.tooth_rating.widths:
        widths = ", ".join(f"{1e3 * one:.4g}" for one in entry.tooth_rating.widths)
        found.append(("standard widths", f"{widths} mm"))
    return found


def _as_sold(given: Drive, drive: Drive) -> list[tuple[str, str]]:
    """The nominal length with its measuring force, and the effect of other diameters."""
    belt, force = drive.belt, drive.belt.measuring_force
    sold = force is not None or belt.nominal_length is not None
    if drive.ends or not sold:
        return []
    nominal = f"{belt.nominal_length_of(drive.belt_length):.5g} m"
    other = other_diameters(given)
    diameters = [("with pitch diameters", other)] if other else []
    if force is None:
        return [("nominal length", f"{nominal}, assumed unstretched (no measuring force given)"), *diameters]
    stretched = f"stretched by {belt.measured_stretch - 1.0:.3%}"
    return [("nominal length", f"{nominal} under {force:.4g} N between two pulleys, {stretched}"), *diameters]


def _in_the_mean(drive: Drive) -> str:
    """The elements of a travelling mesh are equally long."""
    return " on average" if drive.frame.stays else ""


def _taken_up(drive: Drive) -> list[tuple[str, str]]:
    """Pulley centers after the take-up of fixed tensioners."""
    fixed = [tensioner for tensioner in drive.tensioners if tensioner.kind == "fixed"]
    places = [(one.pulley, drive.centers[drive.carried(one)]) for one in fixed]
    return [(f"center of {name}", f"[{x:.5g}, {y:.5g}] m after take-up") for name, (x, y) in places]


def _lost_in_the_belt(drive: Drive) -> list[tuple[str, str]]:
    """The loss in bending and compression, independent of speed and load."""
    prepared = prepare(drive)
    forces = {"bending": bending_resistance(prepared), "compression": compression_losses(prepared).sum()}
    return [
        (f"{cause} loss", f"{force:.3g} N of belt pull, {force:.3g} W per m/s of belt speed")
        for cause, force in forces.items()
        if force > 0.0
    ]


def _origin(given: Drive, drive: Drive, installation: Installation, asked_for: bool) -> str:
    asked = (", run in, as the loads require" if given.layout.for_loads else " as specified") * asked_for
    if installation.tensioner_positions.size:
        return f"{asked}, set by tensioners"
    if any(not end.held for end in drive.ends):
        return ", set by the pulled end"
    gained = installation.tension / installation.laid_tension - 1
    if abs(gained) < _SAME_TENSION:
        return asked
    change = f"{abs(gained):.1%} {'less' if gained < 0 else 'more'} than {installation.laid_tension:.4g} N"
    return f"{asked} ({change} without bending stiffness and contact compliance)"


def _pulleys(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    """Pulley rows; the speed ratio is that without creep, negative for the opposite sense."""
    path, loads = installation.path, installation.hub_loads.tolist()
    sense, guides, ratios = drive.running_sense, drive.guides, path.radii[0] / path.radii
    guided = list(zip(drive.pulleys, guides, strict=True))
    return list(
        zip(
            (pulley.name for pulley in drive.pulleys),
            (_shaft(pulley, stands) for pulley, stands in guided),
            (_NO_TURN if stands else "ccw" if sense * pulley.turning > 0 else "cw" for pulley, stands in guided),
            (f"{math.degrees(wrap):.1f}°" for wrap in path.wrap_angles),
            aligned([1e3 * abs(radius) for radius in path.radii], 5),
            (_NO_TURN if stands else f"{ratio:.4f}" for ratio, stands in zip(ratios, guides, strict=True)),
            aligned([1e3 * depth for depth in installation.penetrations], 2),
            aligned([math.hypot(*load) for load in loads]),
            (f"{_angle(load):z.1f}°" for load in loads),
            strict=True,
        )
    )


_NO_TURN = "–"
"""The sense and the speed ratio of a guide that stands still."""


def _shaft(pulley: Pulley, stands: bool) -> str:
    """Whether a shaft stands, has a prescribed speed, or is free."""
    return "stands" if stands else "prescribed" if pulley.prescribed else "free"


def _angle(force: list[float]) -> float:
    """Direction of a force, above -180° up to 180°."""
    angle = math.degrees(math.atan2(force[1], force[0]))
    return angle if angle > -_HALF_TURN else angle + 360.0


def _tooth_table(drive: Drive, installation: Installation) -> Table:
    """Pulleys with teeth, with the pull that a belt at rest is rated for."""
    rows, belt, path = _teeth(drive, installation), drive.rated_belt, installation.path
    if not isinstance(belt, RatedTeeth):
        return Table("Teeth", _TOOTH_HEADINGS, tuple(rows))
    toothed = prepare(drive).toothed
    pulls = belt.on(2.0 * np.abs(path.radii), path.wrap_angles, 0.0, toothed).pull[toothed]
    return Table(
        "Teeth",
        (*_TOOTH_HEADINGS, _PULL_HEADING),
        tuple((*row, one) for row, one in zip(rows, aligned(pulls.tolist(), 3), strict=True)),
    )


def _teeth(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    """Rows of pulleys with teeth; their ratio is exact."""
    path, toothed = installation.path, np.flatnonzero(prepare(drive).toothed).tolist()
    meshes, first = teeth_in_mesh(drive.belt, path), drive.pulleys[toothed[0]].teeth
    return [
        (
            drive.pulleys[p].name,
            f"{drive.pulleys[p].teeth}",
            f"{meshes[p]:.1f}",
            f"{2e3 * abs(path.radii[p]):.5g}",
            f"{first}/{drive.pulleys[p].teeth}",
        )
        for p in toothed
    ]


def _spans(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    rows = np.column_stack([installation.span_tensions, installation.extreme_tensions, installation.end_tensions])
    lengths, frequencies = installation.path.span_lengths.tolist(), installation.span_frequencies.tolist()
    names = (f"{start} to {end}" for start, end in drive.spans)
    return list(zip(names, aligned(lengths), *tension_columns(rows), aligned(frequencies), strict=True))


def _tensioners(drive: Drive, installation: Installation) -> list[tuple[str, ...]]:
    rows = list[tuple[str, ...]]()
    carriers = prepare(drive).carriers
    others = _others(drive, installation, carriers)
    for carrier, position, other in zip(carriers, installation.tensioner_positions.tolist(), others, strict=True):
        tensioner = carrier.tensioner
        unit = tensioner.force_unit
        rows.append(
            (
                tensioner.pulley,
                f"{carrier.shown_as[0]} {carrier.written(position)}",
                f"{carrier.force(position):.4g} {unit}",
                " to ".join(carrier.written(stop) for stop in tensioner.stops or ()),
                other or "none",
            )
        )
    return rows


def alignment_table(given: Drive, path: Path) -> Table:
    """Fleeting angles of the spans, with tolerances, against the limit of the belt."""
    found = alignment(given, path)
    headings = ["", "leaving", "reaching"]
    columns = [[f"{math.degrees(angle):z.3f}°" for angle in side] for side in found.angles.T.tolist()]
    if (found.worst > abs(found.angles) + 1e-12).any():
        headings.append("worst, with\ntolerances")
        columns.append([f"{math.degrees(angle):.3f}°" for angle in found.worst.max(axis=1).tolist()])
    if not math.isnan(found.limit):
        headings += ["allowed", "offset still\nallowed mm"]
        columns += [
            [f"{math.degrees(found.limit):.3g}°"] * len(found.worst),
            aligned((1e3 * found.allowed_offset).tolist(), 3),
        ]
    names = [f"{start} to {end}" for start, end in given.spans]
    title = "Fleeting angles (geometry only: the dynamics are planar)"
    return Table(title, tuple(headings), tuple(zip(names, *columns, strict=True)))


def _others(drive: Drive, installation: Installation, carriers: Sequence[Carrier]) -> list[str]:
    """Other equilibrium positions, one text for each spring-loaded tensioner, empty if there are none."""
    return [
        ", ".join(
            f"{carrier.written(balance.position)} ({'stable' if balance.stable else 'unstable'})"
            for balance in balances
            if not balance.here
        )
        for carrier, balances in zip(carriers, tensioner_balances(drive, installation), strict=True)
    ]
