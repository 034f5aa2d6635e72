"""The tables of a sheet of a line: a web line, a conveyor, or a guided belt."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.designs.line_belt import ELONGATIONS, STRETCHES, USUAL_TEMPERATURES
from beltdyn.designs.line_sheet import LARGEST_SAG, RESISTANCES
from beltdyn.model import Belt
from beltdyn.parts.messages import aligned, plain
from beltdyn.parts.quantity import RPM
from beltdyn.results import Result
from beltdyn.results.schema import least_safeties, variable_of
from beltdyn.show.parts_list import parts_list
from beltdyn.show.sheet import power_unit, safeties
from beltdyn.show.tables import Facts, Sheet, Table

if TYPE_CHECKING:
    import xarray as xr

_DEGREES = 180.0 / np.pi
"""Degrees in a radian: angles are shown in degrees."""
_TONNES_PER_HOUR = 3.6
"""Tonnes per hour in 1 kg/s: conveyed mass flows are shown in t/h."""
_ROUNDING = 1e-9
"""Share of the largest power, or a position in m or rad, below which a value is rounding."""


def line_sheet(result: Result) -> Sheet:
    """Give the sheet of a line."""
    dataset, parts = result.dataset, list[Table | Facts]()
    parts += [*parts_list(result.prepared), Facts(tuple(_facts(dataset, result.drive.belt))), _points(dataset)]
    if "moved_mass" in dataset:
        parts += [_starts(dataset), _motions(dataset)]
        parts += [_safety(dataset)] if "belt_safety" in dataset else []
        parts += [_take_up(dataset)] if "take_up_travel" in dataset else []
    for number, name in enumerate(dataset["row"].values):
        at, where = dataset.isel(row=number), f", operating point {name}" if dataset.sizes["row"] > 1 else ""
        stands = np.array(result.drive.guides, dtype=bool)
        parts += [_pulleys(at, where, stands), _grip(at, where, stands), _spans(at, where)]
        if "motion_torque" in at:
            parts.append(_drives(at, where))
        if "main_resistance" in at:
            parts.append(_resistances(at, where))
            if at["sag"].notnull().any():
                parts.append(_sag(at, where))
        if "idler_load" in at:
            parts.append(_idlers(at, where))
        if "tensioner_position" in at:
            parts.append(_tensioners(at, where, result))
        if "roll_radius" in at:
            parts.append(_rolls(at, where))
        if "nip_force" in at:
            parts.append(_nips(at, where))
    return Sheet(str(dataset.attrs["title"]), tuple(parts))


def _facts(dataset: "xr.Dataset", belt: Belt) -> Iterator[tuple[str, str]]:
    yield "belt length", f"{float(dataset['belt_length']):.5g} m unstretched"
    yield "tension at rest", f"{plain(float(dataset['tension_at_rest']), 4)} N"
    if "take_up_ratio" in dataset and np.isfinite(dataset["take_up_ratio"]):
        taken = 1e3 * float(dataset["stretch_at_rest"] / dataset["take_up_ratio"])
        yield "take-up", f"{taken:.4g} mm for the stretch of the belt at rest"
    if "belt_safety" in dataset:
        yield "safety factors", "strength times width over the largest tension; those needed by [limits] or the class"
    if "take_up_travel" in dataset:
        yield "elongation of the belt", _elongation(belt)
    factors = ", ".join(f"{one:.3g}" for one in dataset["friction"].values)
    yield "slack tension needed", f"by Euler's formula, with {factors} times the friction of the pulleys"
    if "main_resistance" in dataset:
        named = " of DIN 22101" if dataset["sag"].notnull().any() else ""
        yield "resistances", f"by the equations{named}, beside the rise of tension in computed steady running"


def _elongation(belt: Belt) -> str:
    """By which values the belt gets longer, and whether they are those of its class."""
    low, high = belt.temperature_range or USUAL_TEMPERATURES
    parts = (
        ("permanent_elongation", "permanent", "of the length", " (estimate of the class)"),
        ("thermal_expansion", "by heat", "1/K", " (of the class)"),
    )
    words = [
        f"{word} not stated"
        if (value := getattr(belt, name)) is None
        else f"{word} {value:.3g} {unit}{origin * belt.is_of_profile(name)}"
        for name, word, unit, origin in parts
    ]
    return f"{'; '.join(words)}, from {low:g} to {high:g} °C{' (by default)' * (belt.temperature_range is None)}"


def _points(dataset: "xr.Dataset") -> Table:
    """A line for each operating point, with the worst of pulleys and spans."""
    durations = dataset["duration"].values
    powers, (unit, watts) = dataset["power_in"].values, power_unit(dataset["power"].values)
    least, largest = (variable_of(dataset, f"{which}_span_tension") for which in ("least", "largest"))
    columns: list[Sequence[str]] = [
        [str(one) for one in dataset["row"].values],
        [f"{one:.1%}" for one in durations / durations.sum()],
        aligned(dataset["belt_speed"].mean("span").values.tolist(), 4),
        aligned((powers / watts).tolist(), 4),
        aligned((dataset["power_out"].values / watts).tolist(), 4),
        aligned((dataset["loss"].values / watts).tolist(), 4),
        [
            f"{out / given:.1%}" if given > 0.0 and out > 0.0 else "none"
            for out, given in zip(dataset["power_out"].values, powers, strict=True)
        ],
        aligned(least.min("span").values.tolist(), 4),
        aligned(largest.max("span").values.tolist(), 4),
        safeties(np.fmin.reduce(least_safeties(dataset).values, axis=1)),
    ]
    headings: tuple[str, ...] = (
        *("", "time", "belt\nm/s", f"power in\n{unit}", f"out\n{unit}", f"losses\n{unit}", "efficiency"),
        *("tension\nmin N", "max N", "slip\nsafety"),
    )
    if "goods_mass" in dataset and dataset["goods_mass"].values.any():
        flow = _TONNES_PER_HOUR * (dataset["goods_mass"] * dataset["belt_speed"]).max("span").values
        lifting = dataset["lifting_power"].values / watts
        falls = bool(lifting.max() < 0.0)  # then goods put power in
        columns += [aligned((-lifting if falls else lifting).tolist(), 4), aligned(flow.tolist(), 4)]
        headings = (*headings, f"{'lowering' if falls else 'lifting'}\n{unit}", "goods\nt/h")
    return Table("Operating points", headings, tuple(zip(*columns, strict=True)))


def _starts(dataset: "xr.Dataset") -> Table:
    """Pull, slack tension and take-up in starts, and the torque of a holdback."""
    slack, needed = dataset["start_slack_tension"].values, dataset["least_start_slack_tension"].values
    drive = np.nanargmin(slack - needed, axis=1)  # the drive that is nearest to slipping
    rows, ratio = np.arange(len(drive)), float(dataset["take_up_ratio"])
    running, starting = dataset["running_pull"].values, dataset["start_pull"].values
    columns: list[Sequence[str]] = [
        [str(one) for one in dataset["row"].values],
        aligned(dataset["moved_mass"].values.tolist(), 4),
        aligned(dataset["acceleration"].values.tolist(), 3),
        aligned(running.tolist(), 4),
        aligned(starting.tolist(), 4),
        [f"{one / by:.2f}" if by > 0.0 else "–" for one, by in zip(starting, running, strict=True)],
        aligned(slack[rows, drive].tolist(), 4),
        aligned(needed[rows, drive].tolist(), 4),
        aligned(dataset["holdback_torque"].values.tolist(), 4),
    ]
    headings: tuple[str, ...] = (
        *("", "moved\nkg", "start\nm/s²", "pull, running\nN", "start\nN", "start\nfactor"),
        *("slack, start\nN", "needed\nN", "to hold it\nN m"),
    )
    if np.isfinite(ratio):
        columns += [aligned((1e3 / ratio * dataset[one].values).tolist(), 4) for one in STRETCHES]
        headings = (*headings, "take-up, running\nmm", "start\nmm")
    return Table("Starts", headings, tuple(zip(*columns, strict=True)))


def _motions(dataset: "xr.Dataset") -> Table:
    """Start, coasting and emergency stop of each operating point."""
    several = dataset.sizes["row"] > 1
    names = [
        f"{motion}, {row}" if several else str(motion)
        for row in dataset["row"].values
        for motion in dataset["motion"].values
    ]
    columns = [
        _known(dataset[f"motion_{name}"].values.ravel())
        for name in ("rate", "time", "travel", "goods", "brakes", "largest_tension", "least_tension")
    ]
    headings = (
        "",
        "rate\nm/s²",
        "time\ns",
        "travel\nm",
        "goods that\nleave kg",
        "brakes\nN",
        "tension\nmax N",
        "min N",
    )
    return Table("Start and stops", headings, tuple(zip(names, *columns, strict=True)))


def _safety(dataset: "xr.Dataset") -> Table:
    """Safety factors of the belt in steady running, starts and stops, beside those needed."""
    rows, several = list[tuple[str, ...]](), dataset.sizes["row"] > 1
    for number, row in enumerate(dataset["row"].values):
        at, place = dataset.isel(row=number), f", {row}" if several else ""
        factors = {"steady running": (float(at["belt_safety"]), float(at["needed_belt_safety"]))}
        factors |= {
            str(motion): (factor, float(at["needed_motion_safety"]))
            for motion, factor in zip(at["motion"].values, at["motion_belt_safety"].values.tolist(), strict=True)
        }
        rows += [
            (f"{name}{place}", *_known(np.array([factor, least])), _judged(factor, least))
            for name, (factor, least) in factors.items()
            if np.isfinite(factor)
        ]
    return Table("Safety factors of the belt", ("", "factor", "needed", ""), tuple(rows))


def _judged(factor: float, least: float) -> str:
    if np.isnan(least):
        return "not judged: neither limit nor class"
    return "met" if factor >= least else "too low"


def _take_up(dataset: "xr.Dataset") -> Table:
    """What a take-up takes up over the life of the belt, as length of belt and as its travel, beside its room."""
    ratio, difference = float(dataset["take_up_ratio"]), float(dataset["temperature_difference"])
    words = ("stretch, at most", "permanent elongation", f"heat, {difference:.3g} K")
    parts = [float(dataset[name]) for name in ELONGATIONS]
    rows = [(word, f"{part:.3f}", f"{part / ratio:.3f}") for word, part in zip(words, parts, strict=True)]
    rows.append(("needed", f"{sum(parts):.3f}", f"{float(dataset['take_up_travel']):.3f}"))
    room = float(dataset["take_up_room"]) if "take_up_room" in dataset else np.nan
    rows.append(("of the frame", "", f"{room:.3f}" if np.isfinite(room) else "not stated"))
    return Table("Take-up over the life of the belt", ("", "belt\nm", "travel\nm"), tuple(rows))


def _drives(at: "xr.Dataset", where: str) -> Table:
    """Torque, power, pull, its share and the tension ratio of each drive and brake, steadily and in motions."""
    names, motions = at["pulley"].values, ["steady running", *map(str, at["motion"].values)]
    powered = np.flatnonzero(at["motion_torque"].notnull().any("motion").values)
    unit, watts = power_unit(at["power"].values)
    speeds = np.abs(at["pulley_speed"].values)
    torque = np.divide(at["power"].values, speeds, out=np.zeros_like(speeds), where=speeds > 0.0)
    steady = (
        torque,
        at["power"].values,
        torque / np.abs(0.5 * at["pitch_diameter"].values),
        at["tension_ratio"].values,
    )
    moving = (at[f"motion_{name}"].values for name in ("torque", "power", "pull", "tension_ratio"))
    torques, powers, pulls, ratios = (
        np.vstack([one, many])[:, powered] for one, many in zip(steady, moving, strict=True)
    )
    sums = np.nansum(pulls, axis=1, keepdims=True)
    shares = np.divide(
        pulls, sums, out=np.full_like(pulls, np.nan), where=np.abs(sums) > _ROUNDING * np.nanmax(np.abs(pulls))
    )
    allowed = at["allowed_tension_ratio"].values[powered]
    rows = [
        (
            f"{names[powered[place]]}, {motion}",
            *_known(np.array([torques[number, place], powers[number, place] / watts, pulls[number, place]])),
            f"{shares[number, place]:.1%}" if np.isfinite(shares[number, place]) else "–",
            *("∞" if np.isinf(one) else f"{one:.2f}" for one in (ratios[number, place], allowed[place])),
        )
        for place in range(len(powered))
        for number, motion in enumerate(motions)
        if max(abs(torques[number, place]), abs(pulls[number, place])) > 0.0  # nor where it is not a number
    ]
    headings = ("", "torque\nN m", f"power\n{unit}", "pull\nN", "share", "tension\nratio", "allowed")
    return Table(f"Drives and brakes{where}", headings, tuple(rows))


def _known(values: FloatArray) -> list[str]:
    """Numbers with four digits; a dash where there is none."""
    return [plain(one + 0.0, 4) if np.isfinite(one) else "–" for one in values.tolist()]


def _idlers(at: "xr.Dataset", where: str) -> Table:
    """Number, load and speed of idlers."""
    columns = (
        map(str, at["idlers"].values),
        [f"{one:.0f}" for one in at["idler_count"].values],
        aligned(at["idler_spacing"].values.tolist(), 3),
        aligned(at["idler_load"].values.tolist()),
        aligned((RPM * at["idler_speed"].values).tolist()),
    )
    headings = ("", "number", "spacing\nm", "load of one\nN", "speed\nrpm")
    return Table(f"Idlers{where}", headings, tuple(zip(*columns, strict=True)))


def _pulleys(at: "xr.Dataset", where: str, stands: BoolArray) -> Table:
    """Diameter, speed, torque, power and hub load of each pulley."""
    power, (unit, watts) = at["power"].values, power_unit(at["power"].values)
    power = np.where(np.abs(power) > _ROUNDING * np.max(np.abs(power), initial=1.0), power, 0.0)
    columns: list[Sequence[str]] = [
        [str(one) for one in at["pulley"].values],
        aligned((1e3 * at["pitch_diameter"].values).tolist(), 5),
        [f"{_DEGREES * one:.1f}°" for one in at["wrap_angle"].values],
        _but(stands, aligned((RPM * at["pulley_speed"].values).tolist(), 5)),
        _but(stands, aligned(at["shaft_torque"].values.tolist(), 4)),
        _but(stands, aligned((power / watts).tolist(), 4)),
        aligned(at["hub_load"].values.tolist(), 4),
        [f"{_DEGREES * one:z.0f}°" for one in at["hub_direction"].values],
    ]
    headings = ["", "diameter\nmm", "wrap", "speed\nrpm", "torque\nN m", f"power\n{unit}", "hub load\nN", "direction"]
    if "smallest_diameter" in at:
        headings.append("diameter\nat least mm")
        columns.append(aligned((1e3 * at["smallest_diameter"].values).tolist(), 4))
    return Table(f"Pulleys{where}", tuple(headings), tuple(zip(*columns, strict=True)))


def _grip(at: "xr.Dataset", where: str, stands: BoolArray) -> Table:
    """Tensions before and behind each pulley, slip, and the slack tension needed."""
    before, after, needed = (at[name].values for name in ("tension_before", "tension_after", "least_slack_tension"))
    tensions = aligned([*before, *after, *needed.ravel()], 5)
    count = len(before)
    columns: list[Sequence[str]] = [
        [str(one) for one in at["pulley"].values],
        tensions[:count],
        tensions[count : 2 * count],
        aligned((before - after).tolist(), 4),
        _but(stands, [f"{one:z.3%}" for one in at["pulley_slip"].values]),
        [f"{one:.3g}" for one in at["friction_coefficient"].values],
        _but(stands, safeties(at["slip_safety"].values)),
        _but(stands, safeties(variable_of(at, "own_load_safety").values)),
    ]
    grid = np.array(tensions[2 * count :]).reshape(needed.shape)
    idle = stands | np.isnan(at["slip_safety"].values)
    columns += [_but(idle, list(map(str, grid[:, number]))) for number in range(needed.shape[1])]
    factors = [f"× {one:.3g}" for one in at["friction"].values]
    headings = (
        *("", "tension\nbefore N", "behind N", "pull\nN", "slip", "friction", "slip safety\nall loads", "own load"),
        *(f"slack needed\nN {one}" if number == 0 else f"\nN {one}" for number, one in enumerate(factors)),
    )
    return Table(f"Grip{where}", headings, tuple(zip(*columns, strict=True)))


def _spans(at: "xr.Dataset", where: str) -> Table:
    """Tensions at both ends of each span, strain and draw."""
    first, last = (at[name].values for name in ("tension_at_start", "tension_at_end"))
    tensions, count = aligned([*first, *last], 5), len(first)
    columns: list[Sequence[str]] = [
        [str(one) for one in at["span"].values],
        aligned(at["span_length"].values.tolist(), 4),
        tensions[:count],
        tensions[count:],
        [f"{one:z.4%}" for one in at["span_strain"].values],
        aligned(at["belt_speed"].values.tolist(), 5),
        [f"{one:+z.4%}" for one in at["draw"].values],
    ]
    headings = ("", "length\nm", "tension at\nstart N", "end N", "strain", "belt\nm/s", "draw")
    return Table(f"Spans{where}", headings, tuple(zip(*columns, strict=True)))


def _resistances(at: "xr.Dataset", where: str) -> Table:
    """Sum of resistances by hand, beside the pull that is found."""
    parts = np.array([at[name].values for name in RESISTANCES])
    cells = np.vstack([parts, parts.sum(axis=0), at["span_pull"].values])
    cells = np.hstack([cells, cells.sum(axis=1, keepdims=True)])
    lengths, goods = at["span_length"].values.tolist(), at["goods_mass"].values.tolist()
    columns: list[Sequence[str]] = [
        [*map(str, at["span"].values), "sum"],
        [*aligned(lengths, 4), ""],
        [*aligned(goods, 4), ""],
        *(aligned(one.tolist(), 4) for one in cells),
    ]
    headings = (
        *("", "length\nm", "goods\nkg/m", "main\nN", "secondary\nN", "slope,\nbelt N", "slope,\ngoods N"),
        *("sum\nN", "found\nN"),
    )
    return Table(f"Resistances of spans{where}", headings, tuple(zip(*columns, strict=True)))


def _sag(at: "xr.Dataset", where: str) -> Table:
    """Sag between idlers."""
    carried = np.flatnonzero(at["sag"].notnull().values)
    there = at.isel(span=carried)
    least = variable_of(there, "least_span_tension").values
    columns = (
        map(str, there["span"].values),
        aligned(there["largest_idler_spacing"].values.tolist(), 3),
        aligned(there["least_tension_for_sag"].values.tolist(), 4),
        aligned(least.tolist(), 4),
        [f"{one:.2%}" for one in there["sag"].values],
    )
    headings = ("", "spacing\nm", f"tension for {LARGEST_SAG:.0%}\nN", "least tension\nN", "sag")
    return Table(f"Sag between idlers{where}", headings, tuple(zip(*columns, strict=True)))


def _tensioners(at: "xr.Dataset", where: str, result: Result) -> Table:
    rows = []
    for one, place, force in zip(
        result.drive.moving_tensioners, at["tensioner_position"].values, at["tensioner_force"].values, strict=True
    ):
        unit = one.force_unit
        stops = " to ".join(one.written(stop) for stop in one.stops or ()) or "none"
        place = place if abs(place) > _ROUNDING else 0.0
        rows.append((one.pulley, one.written(float(place)), f"{plain(float(force), 4)} {unit}", stops))
    return Table(f"Tensioners{where}", ("", "position", "force", "stops"), tuple(rows))


def _rolls(at: "xr.Dataset", where: str) -> Table:
    columns = (
        map(str, at["roll"].values),
        aligned((1e3 * at["roll_radius"].values).tolist(), 5),
        aligned(at["roll_inertia"].values.tolist(), 4),
        aligned((RPM * at["roll_speed"].values).tolist(), 4),
        aligned(at["roll_torque"].values.tolist(), 4),
    )
    headings = ("", "radius\nmm", "inertia\nkg m²", "speed\nrpm", "torque\nN m")
    return Table(f"Rolls{where}", headings, tuple(zip(*columns, strict=True)))


def _nips(at: "xr.Dataset", where: str) -> Table:
    """Force, pressure and thickness of each nip, and the tensions on its sides."""
    factors = (("force", 1.0), ("width", 1e3), ("peak_pressure", 1e-6), ("gap", 1e6), ("thickness_after", 1e6))
    columns: list[Sequence[str]] = [[str(one) for one in at["nip"].values]]
    columns += [aligned((factor * at[f"nip_{name}"].values).tolist(), 4) for name, factor in factors]
    columns.append([f"{one:.5f}" for one in at["nip_speed_ratio"].values])
    columns += [
        aligned(at[f"nip_{name}"].values.tolist(), 5)
        for name in ("tension_before", "tension_after", "compression_loss")
    ]
    headings = (
        *("", "force\nN", "width\nmm", "peak pressure\nMPa", "gap\nµm", "thickness\nafter µm", "speed\nratio"),
        *("tension\nbefore N", "behind N", "loss by\ncompression W"),
    )
    return Table(f"Nips{where}", headings, tuple(zip(*columns, strict=True)))


def _but(stands: BoolArray, texts: Sequence[str]) -> list[str]:
    """Texts, with a dash in some places, such as guides that stand still."""
    return ["–" if still else text for still, text in zip(stands, texts, strict=True)]
