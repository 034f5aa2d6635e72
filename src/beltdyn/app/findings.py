"""What the page shows of results as figures and charts: plain data in SI units, that processes can send."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.app.scene import MILLIMETERS
from beltdyn.model import Drive, Installation, Path
from beltdyn.results import Result, Run, summarize
from beltdyn.show.notebook import outline

_TENSION_POINTS = 240
"""Number of points of the tension around the belt, about: the chart is 400 units wide."""
_MAX_SHAPES = 6
"""Number of mode shapes drawn at most, those of the lowest modes: more would make the page long."""
_LIGHT_DAMPING = 0.5
"""Damping ratio below which a mode is drawn: above, resonance raises its amplitude by less than 16 %."""
_POINT_STRIDE = 3
"""Points of the belt for each that is drawn of a mode: shapes stay smooth, and the page small."""
_UNLOADED_SAFETY = 1e3
"""Slip safety, 1, from which on none is shown: such a pulley is as good as unloaded."""


class Figure(NamedTuple):
    """A number that counts."""

    name: str
    value: float
    unit: str
    """SI unit; "%" for a share; empty for a plain number."""
    of: str = ""
    """The pulley or span that has it."""


class Column(NamedTuple):
    """A number of each pulley or span, drawn as bars."""

    name: str
    unit: str
    values: tuple[float, ...]
    """NaN where there is none."""
    least: float = math.nan
    """A value below which it is marked."""


class Rows(NamedTuple):
    """Numbers side by side: a line a pulley or span."""

    title: str
    names: tuple[str, ...]
    columns: tuple[Column, ...]


class Around(NamedTuple):
    """The tension around the belt, from the middle of the first span, or from the end of an open belt."""

    places: tuple[float, ...]
    """Arc lengths, m."""
    tensions: tuple[float, ...]
    """N."""
    arcs: tuple[tuple[str, float, float], ...]
    """Pulleys, with the arc lengths where the belt runs on and off."""


class Shape(NamedTuple):
    """A mode, as the drive looks at its largest displacement; lengths in mm, y down."""

    frequency: float
    """Hz."""
    damping: float
    """Damping ratio."""
    about: str
    """Kind, and what moves."""
    extent: tuple[float, float, float, float]
    """Left, top, width and height."""
    rest: str
    """The path of the belt without the mode."""
    belt: str
    """The path with it."""
    pulleys: tuple[tuple[float, float, float, float], ...]
    """Centers, radii, and rotation in degrees."""


class Findings(NamedTuple):
    """What is shown of a result; all of it may be missing."""

    figures: tuple[Figure, ...] = ()
    around: Around | None = None
    rows: tuple[Rows, ...] = ()
    shapes: tuple[Shape, ...] = ()
    tensions: tuple[float, ...] = ()
    """Tensions of the spans, N, as the canvas shows them."""


def at_rest(drive: Drive, found: Installation) -> Findings:
    """A drive at rest."""
    path = found.path
    loads = np.linalg.norm(found.hub_loads, axis=1)
    names, spans = _names(drive), _spans(drive)
    tensions = found.span_tensions
    places, arcs = _pieces(path, names)
    order = path.order if path.ends is not None else np.append(path.order, path.order[0])
    along = np.repeat(tensions[order], 2)[: len(places)]
    wraps = np.abs(path.wrap_angles)
    return Findings(
        figures=(
            Figure("tension at rest", float(found.tension), "N"),
            Figure("belt length", float(drive.belt_length), "m"),
            _extreme("largest hub load", "N", names, loads),
            _extreme("lowest span frequency", "Hz", spans, found.span_frequencies, least=True),
        ),
        around=Around(tuple(places), tuple(map(float, along)), arcs),
        rows=(
            Rows("Pulleys", names, (Column("wrap", "rad", _plain(wraps)), Column("hub load", "N", _plain(loads)))),
            Rows(
                "Spans",
                spans,
                (
                    *_tensions(tensions, *found.extreme_tensions.T, *found.end_tensions.T),
                    Column("frequency", "Hz", _plain(found.span_frequencies)),
                ),
            ),
        ),
        tensions=_plain(tensions),
    )


def in_running(run: Run) -> Findings:
    """A run: its means, and the tension around the belt at its last instant."""
    summary = summarize(run)
    names = tuple(one.name for one in summary.pulleys)
    loads = [one.hub_load for one in summary.pulleys]
    safeties = _up_to(_UNLOADED_SAFETY, (one.least_safety for one in summary.pulleys))
    balance, spans = summary.balance, summary.spans
    figures = []
    if balance.power_in > 0.0:
        figures.append(Figure("power", float(balance.power_in), "W"))
    if balance.power_in > 0.0 and balance.power_out > 0.0:
        figures.append(Figure("efficiency", float(balance.efficiency), "%"))
    figures.append(_extreme("least slip safety", "", names, safeties, least=True))
    figures.append(_extreme("largest hub load", "N", names, loads))
    columns = (
        Column("speed", "rad/s", _plain(one.speed for one in summary.pulleys)),
        Column("slip", "%", _plain(one.slip for one in summary.pulleys)),
        Column("tension ratio", "", _plain(one.tension_ratio for one in summary.pulleys)),
        Column("allowed ratio", "", _plain(one.allowed_tension_ratio for one in summary.pulleys)),
        *(
            Column(name, "", tuple(_up_to(_UNLOADED_SAFETY, values)), run.drive.limits.least_slip_safety or 1.0)
            for name, values in (
                ("slip safety, own load", (one.own_load_safety for one in summary.pulleys)),
                ("slip safety, all loads", (one.slip_safety for one in summary.pulleys)),
            )
        ),
        Column("hub load", "N", _plain(loads)),
    )
    return Findings(
        figures=tuple(one for one in figures if math.isfinite(one.value)),
        around=_along(run),
        rows=(
            Rows("Pulleys", names, columns),
            Rows(
                "Spans",
                tuple(one.name for one in spans),
                (
                    *_tensions(
                        *zip(
                            *((one.tension, one.lowest, one.highest, one.at_start, one.at_end) for one in spans),
                            strict=True,
                        )
                    ),
                    Column("belt speed", "m/s", _plain(one.belt_speed for one in spans)),
                ),
            ),
        ),
        tensions=_plain(one.tension for one in spans),
    )


def of_modes(result: Result) -> Findings:
    """The first modes of a drive."""
    from beltdyn.show.plot.vibration import shown_modes

    damping = result.dataset["damping_ratio"]
    light = [number for number in shown_modes(result) if float(damping.sel(mode=number)) < _LIGHT_DAMPING]
    shapes = tuple(_shape(result, number) for number in light[:_MAX_SHAPES])
    if not shapes:
        return Findings()
    least = min(shapes, key=lambda one: one.damping)
    figures = (
        Figure("lowest frequency", min(one.frequency for one in shapes), "Hz"),
        Figure("least damping ratio", least.damping, "%", f"at {least.frequency:.3g} Hz"),
    )
    return Findings(figures=figures, shapes=shapes)


def findings_of(result: Result) -> Findings:
    """What is shown of a result of any analysis."""
    if isinstance(result, Run):
        return in_running(result) if result.outputs else Findings()
    return of_modes(result) if result.kind == "modes" else Findings()


def _extreme(name: str, unit: str, of: Sequence[str], values: Iterable[float], *, least: bool = False) -> Figure:
    """The least or largest of some values, and which it is; NaN of none."""
    known = [(float(value), one) for one, value in zip(of, values, strict=True) if math.isfinite(value)]
    if not known:
        return Figure(name, math.nan, unit)
    value, one = (min if least else max)(known, key=lambda each: each[0])
    return Figure(name, value, unit, one)


def _tensions(*columns: Iterable[float]) -> Iterator[Column]:
    """Columns of the tensions of spans: mean, extremes, and at both arcs."""
    names = ("mean tension", "least tension", "largest tension", "tension at start", "tension at end")
    for name, values in zip(names, columns, strict=True):
        yield Column(name, "N", _plain(values))


def _up_to(limit: float, values: Iterable[float]) -> list[float]:
    """The values, and NaN in place of those from a limit on."""
    return [value if value < limit else math.nan for value in values]


def _plain(values: Iterable[float]) -> tuple[float, ...]:
    return tuple(float(one) for one in values)


def _names(drive: Drive) -> tuple[str, ...]:
    return tuple(one.name for one in drive.pulleys)


def _spans(drive: Drive) -> tuple[str, ...]:
    from beltdyn.model import prepare

    return tuple(f"{a}-{b}" for a, b in prepare(drive).spans)


def _pieces(path: Path, names: Sequence[str]) -> tuple[list[float], tuple[tuple[str, float, float], ...]]:
    """Arc lengths of the ends of spans, in their order, and the arcs between them; a closed belt begins mid-span."""
    lengths, turned = path.span_lengths, path.wrap_angles * np.abs(path.radii)
    closed = path.ends is None
    reached = -0.5 * float(lengths[path.order[0]]) if closed else 0.0
    places, arcs = list[float](), list[tuple[str, float, float]]()
    for span in path.order:
        places.append(max(reached, 0.0))
        reached += float(lengths[span])
        places.append(reached)
        pulley = int(path.span_pulleys[span, 1])
        if pulley >= 0:
            arcs.append((names[pulley], reached, reached + float(turned[pulley])))
            reached += float(turned[pulley])
    return [*places, path.length] if closed else places, tuple(arcs)


def _along(run: Run) -> Around | None:
    """The tension around the belt at the last instant of a run with fields."""
    from beltdyn.show.report.replay import along_belt

    if not run.dataset.sizes["field_time"]:
        return None
    _, tension, _ = along_belt(run, run.fields_at())
    path = run.drive.path
    every = max(len(tension) // _TENSION_POINTS, 1)
    places = np.linspace(0.0, path.length, len(tension), endpoint=bool(run.drive.ends))
    if not run.drive.ends:
        places, tension = np.append(places, path.length), np.append(tension, tension[:1])
    return Around(_plain(places[::every]), _plain(tension[::every]), _pieces(path, _names(run.drive))[1])


def _shape(result: Result, number: int) -> Shape:
    from beltdyn.show.plot.vibration import swing

    one, way, drive = result.dataset.sel(mode=number), swing(result, number), result.drive
    turned = np.exp(-0.5j * np.angle(np.sum(way.belt**2) + np.sum((way.angles * np.abs(drive.path.radii)) ** 2)))
    belt = result.dataset["point_position"].values + (way.belt * turned).real
    centers = drive.path.centers + (way.centers * turned).real
    angles = np.degrees((way.angles * turned).real)
    reach = np.abs(drive.path.radii)[:, None] + 1.5 * way.size
    low, high = (drive.path.centers - reach).min(axis=0), (drive.path.centers + reach).max(axis=0)
    if drive.path.ends is not None:
        low, high = np.minimum(low, drive.path.ends.min(axis=0)), np.maximum(high, drive.path.ends.max(axis=0))
    left, top = MILLIMETERS * float(low[0]), -MILLIMETERS * float(high[1])
    width, height = (MILLIMETERS * float(one) for one in high - low)
    points = "L".join(f"{x:.1f} {y:.1f}" for x, y in MILLIMETERS * belt[::_POINT_STRIDE] * (1.0, -1.0))
    return Shape(
        float(one["frequency"]),
        float(one["damping_ratio"]),
        f"{one['kind'].values}: {one['moving_parts'].values}",
        (left, top, width, height),
        outline(drive.path, lambda x, y: (MILLIMETERS * x, -MILLIMETERS * y), MILLIMETERS),
        f"M{points}" + "Z" * (not drive.ends),
        tuple(
            (MILLIMETERS * float(x), -MILLIMETERS * float(y), MILLIMETERS * abs(float(radius)), -float(angle))
            for (x, y), radius, angle in zip(centers, drive.path.radii, angles, strict=True)
        ),
    )
