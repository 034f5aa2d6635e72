"""The tables of a drive sheet."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.drive_sheet import REST_TENSIONS
from beltdyn.model.carrier import Carrier
from beltdyn.parts.messages import aligned, listing
from beltdyn.parts.quantity import RPM
from beltdyn.results import Result
from beltdyn.results.schema import least_safeties, variable_of
from beltdyn.show.line_sheet import line_sheet
from beltdyn.show.parts_list import parts_list
from beltdyn.show.sheet import TENSION_HEADINGS, safeties, safety_text, tension_columns
from beltdyn.show.tables import Facts, Sheet, Table

if TYPE_CHECKING:
    import xarray as xr

_DEGREES = 180.0 / np.pi
"""Degrees in a radian: angles are shown in degrees."""
CENTER_DISTANCES = ("center_distance", "fitting_allowance", "tensioning_allowance")
_NO_FIT = "does not fit"
_STATES = {
    "free": "free arm",
    "replace": "replace (stretched)",
    "max": "longest belt",
    "mean": "nominal belt",
    "min": "shortest belt",
    "load": "load stop",
}


def drive_sheet(result: Result) -> Sheet:
    """Give the sheet of a drive."""
    dataset = result.dataset
    if "tension_before" in dataset:
        return line_sheet(result)
    carriers = result.prepared.carriers
    parts: list[Table | Facts] = [*parts_list(result.prepared), Facts(tuple(_facts(dataset))), _pulleys(dataset)]
    if "state" in dataset.dims:
        parts.append(_states(dataset))
    if "standard" in dataset.dims:
        parts.append(_belts(dataset, carriers))
    parts += [_points(dataset, carriers), *_span_tensions(dataset), *_hub_loads(dataset), _spans(dataset)]
    if "mode" in dataset.dims:
        parts.append(_modes(dataset))
    return Sheet(str(dataset.attrs["title"]), tuple(parts))


def _facts(dataset: "xr.Dataset") -> Iterable[tuple[str, str]]:
    """Belt, tension and conditions in a few words."""
    nominal, length = float(dataset["nominal_length"]), float(dataset["belt_length"])
    yield "belt length", f"{length:.5g} m unstretched, {1e3 * nominal:.5g} mm nominal"
    yield "tension at rest", f"{float(dataset['tension_at_rest']):.4g} N"
    if "state_take_up" in dataset:
        at = dataset["state_take_up"].sel(state="mean")
        rate = 1e3 * float(at) / _DEGREES if at.attrs["units"] == "m/rad" else float(at)
        yield (
            "take-up",
            f"{rate:.3g} mm of path per {'degree' if at.attrs['units'] == 'm/rad' else 'mm'} at the nominal belt",
        )
    if "take_up_rate" in dataset:
        yield "take-up", f"{float(dataset['take_up_rate']):.3g} mm of path per mm"
    if "belt_state" in dataset.dims:
        yield (
            "tension check",
            "frequency of a plucked span at rest; force on one belt across the middle of a span",
        )
    if "center_distance" in dataset:
        distance, fit, tension = (1e3 * float(dataset[name]) for name in CENTER_DISTANCES)
        yield (
            "center distance",
            f"{distance:.5g} mm, at least {fit:.3g} mm less to fit belts and {tension:.3g} mm more to tension them "
            "(GB/T 13575.1)",
        )
    for name in ("cord_life", "rib_life"):
        if name in dataset:
            yield str(dataset[name].attrs["long_name"]).lower(), f"{float(dataset[name]):.3g} h, under this duty"
    if "required_tension" in dataset:
        least = zip(dataset["tension_formula"].values, dataset["required_tension"].values, strict=True)
        yield "least tension", listing([f"{tension:.4g} N ({name})" for name, tension in least])
    yield "peak", "with acceleration and vibration"
    yield "cases", ", ".join(map(str, dataset["case"].values))
    factors = ", ".join(f"{one:.3g}" for one in dataset["friction"].values)
    yield "friction", f"{factors} times the coefficients below; the least slip safety is over all cases and these"
    if "allowed_fleeting_angle" in dataset:
        allowed = _DEGREES * float(dataset["allowed_fleeting_angle"])
        yield "alignment", f"fleeting angles up to {allowed:.3g}°, by geometry alone: the dynamics are planar"
    safety = dataset["least_slip_safety_over_speed"]
    if bool(safety.notnull().any()):
        speed, pulley = np.unravel_index(int(np.nanargmin(safety.values)), safety.shape)
        at_speed = RPM * float(dataset["speed"].values[speed])
        yield (
            "least slip safety",
            f"{safety_text(float(np.nanmin(safety)))} of {dataset['pulley'].values[pulley]} over the speeds, at "
            f"{at_speed:.4g} rpm",
        )


def _pulleys(dataset: "xr.Dataset") -> Table:
    centers = 1e3 * dataset["center"].values
    columns = (
        map(str, dataset["pulley"].values),
        aligned(centers[:, 0].tolist(), 5),
        aligned(centers[:, 1].tolist(), 5),
        aligned((1e3 * dataset["pitch_diameter"].values).tolist(), 5),
        (f"{_DEGREES * one:.1f}°" for one in dataset["wrap_angle"].values),
        (f"{one:.4f}" for one in dataset["speed_ratio"].values),
        (f"{one:.3g}" for one in dataset["friction_coefficient"].values),
        aligned(dataset["rest_hub_load"].values.tolist()),
    )
    headings = (
        "",
        "x\nmm",
        "y\nmm",
        "pitch diameter\nmm",
        "wrap",
        "speed\nratio",
        "friction,\nwith wedge",
        "hub load\nat rest N",
    )
    return Table("Pulleys", headings, tuple(zip(*columns, strict=True)))


def _spans(dataset: "xr.Dataset") -> Table:
    """Spans at rest: how the tension is checked, and their fleeting angles if pulleys are out of line."""
    columns: list[Sequence[str]] = [
        [str(one) for one in dataset["span"].values],
        aligned((1e3 * dataset["span_length"].values).tolist(), 4),
    ]
    headings: tuple[str, ...] = ("", "length\nmm")
    if REST_TENSIONS.keys() <= set(dataset):
        columns += tension_columns(np.column_stack([dataset[name].values for name in REST_TENSIONS]))
        headings = (*headings, *TENSION_HEADINGS)
    if "belt_state" in dataset.dims:
        columns.append(aligned((1e3 * dataset["deflection"].values).tolist(), 3))
        headings = (*headings, "deflection\nmm")
        for state in map(str, dataset["belt_state"].values):
            at = dataset.sel(belt_state=state)
            columns += [aligned(at[name].values.tolist(), 3) for name in ("span_frequency", "deflection_force")]
            headings = (*headings, f"{state}\nHz", f"{state}\nN")
    angles, worst = (_DEGREES * dataset[name].values for name in ("fleeting_angle", "worst_fleeting_angle"))
    if worst.any():
        columns += [[f"{one:z.3f}°" for one in side] for side in angles.T.tolist()]
        columns.append([f"{one:.3f}°" for one in worst.max(axis=1)])
        headings = (*headings, "fleeting\nleaving", "angle\nreaching", "worst, with\ntolerances")
    if "allowed_offset" in dataset:
        columns.append(aligned((1e3 * dataset["allowed_offset"].values).tolist(), 3))
        headings = (*headings, "offset\nallowed mm")
    return Table("Spans at rest", headings, tuple(zip(*columns, strict=True)))


def _states(dataset: "xr.Dataset") -> Table:
    """Positions of the tensioner."""
    names = [str(one) for one in dataset["state"].values]
    turns = "state_arm_angle" in dataset
    place, unit = ("state_arm_angle", "arm angle\n°") if turns else ("state_position", "position\nmm")
    columns: list[Sequence[str]] = [[_STATES[name] for name in names]]
    columns += [
        aligned((1e3 * dataset["state_belt_length"].values).tolist(), 5),
        aligned(((_DEGREES if turns else 1e3) * dataset[place].values).tolist(), 4),
        aligned(dataset["state_spring"].values.tolist()),
        aligned(dataset["state_tension"].values.tolist()),
        aligned(dataset["state_hub_load"].values.tolist()),
        [_angle(one) for one in dataset["state_hub_direction"].values],
        _or_dash((1e3 / _DEGREES if turns else 1.0) * dataset["state_take_up"].values, 3),
    ]
    spring = f"spring\n{'N m' if turns else 'N'}"
    rate = f"take-up\nmm/{'deg' if turns else 'mm'}"
    headings = ("", "belt length\nmm", unit, spring, "tension\nN", "hub load\nN", "direction", rate)
    return Table(f"Tensioner of {dataset['tensioner'].values[0]}", headings, tuple(zip(*columns, strict=True)))


def _points(dataset: "xr.Dataset", carriers: Sequence[Carrier]) -> Table:
    """A line for each operating point, with the worst of pulleys and spans."""
    whole = float(dataset["duration"].sum())
    driver = int(np.argmin(np.abs(dataset["speed_ratio"].values - 1.0)))
    safety, least = least_safeties(dataset).values, dataset["least_slip_safety"].values
    columns: list[Sequence[str]] = [
        [str(one) for one in dataset["row"].values],
        [f"{one / whole:.3g}" if whole == 0.0 else f"{one / whole:.1%}" for one in dataset["duration"].values],
        aligned((RPM * np.abs(dataset["pulley_speed"].values[:, driver])).tolist(), 4),
        aligned((1e-3 * dataset["power"].values[:, driver]).tolist(), 3),
        aligned(dataset["belt_speed"].values.tolist(), 3),
        aligned(variable_of(dataset, "least_span_tension").min("span").values.tolist(), 4),
        aligned(variable_of(dataset, "largest_span_tension").max("span").values.tolist(), 4),
        aligned(dataset["peak_tension"].max("span").values.tolist(), 4),
        aligned(dataset["peak_hub_load"].max("pulley").values.tolist(), 4),
        safeties(np.fmin.reduce(safety, axis=1)),
        safeties(np.fmin.reduce(least, axis=1)),
    ]
    headings: tuple[str, ...] = (
        *("", "time", "speed\nrpm", "power\nkW", "belt\nm/s", "tension\nmin N", "max N", "peak N"),
        *("peak hub\nload N", "slip\nsafety", "least, all\ncases"),
    )
    if "tensioner_position" in dataset:
        columns.append(aligned(carriers[0].shown(dataset["tensioner_position"].values[:, 0]).tolist(), 4))
        headings = (*headings, _place(carriers[0]))
    if "utilization" in dataset:
        used = np.fmax.reduce(dataset["utilization"].values, axis=1)
        shares = [f"{_whole(100.0 * one)}%".replace("–%", "–") for one in used]
        columns.append(["outside" if np.isinf(one) else share for one, share in zip(used, shares, strict=True)])
        headings = (*headings, "rating\nused")
    return Table("Operating points", headings, tuple(zip(*columns, strict=True)))


def _span_tensions(dataset: "xr.Dataset") -> list[Table]:
    """Largest tension of each span in each operating point, and its peak."""
    quantities = {
        "Largest span tension\nN": _whole_numbers(variable_of(dataset, "largest_span_tension").values),
        "Peak span tension\nN": _whole_numbers(dataset["peak_tension"].values),
    }
    return _over_points(dataset, "span", "Tensions of spans", quantities)


def _hub_loads(dataset: "xr.Dataset") -> list[Table]:
    """Hub load of each pulley in each operating point, its peak and direction, and slip safety."""
    safety = least_safeties(dataset).values
    quantities = {
        "Hub load\nN": _whole_numbers(dataset["hub_load"].values),
        "Peak hub load\nN": _whole_numbers(dataset["peak_hub_load"].values),
        "Direction\nof the hub load": [list(map(_angle, row)) for row in dataset["hub_direction"].values],
        "Slip safety": [safeties(row) for row in safety],
    }
    return _over_points(dataset, "pulley", "Hub loads", quantities)


def _over_points(dataset: "xr.Dataset", dim: str, title: str, quantities: Mapping[str, list[list[str]]]) -> list[Table]:
    """Quantities of pulleys or spans: one table for one operating point, else one of each quantity over the points."""
    points, names = ([str(one) for one in dataset[key].values] for key in ("row", dim))
    if len(points) == 1:
        rows = zip(names, *(cells[0] for cells in quantities.values()), strict=True)
        return [Table(title, ("", *quantities), tuple(rows))]
    return [
        Table(
            heading.replace("\nN", ", N").replace("\n", " "),
            ("", *names),
            tuple((point, *row) for point, row in zip(points, cells, strict=True)),
        )
        for heading, cells in quantities.items()
    ]


def _modes(dataset: "xr.Dataset") -> Table:
    columns = (
        map(str, dataset["mode"].values),
        aligned(dataset["mode_frequency"].values.tolist(), 3),
        (f"{one:.1%}" for one in dataset["mode_damping"].values),
        map(str, dataset["mode_parts"].values),
    )
    title = "First modes, at the largest power, with sliding tensioners"
    return Table(title, ("", "frequency\nHz", "damping\nratio", "moving"), tuple(zip(*columns, strict=True)))


def _belts(dataset: "xr.Dataset", carriers: Sequence[Carrier]) -> Table:
    """Belts of standard length."""
    columns: list[Sequence[str]] = [
        [f"{1e3 * one:.5g}" for one in dataset["standard"].values],
        aligned((1e3 * dataset["standard_longer"].values).tolist(), 3),
        [_NO_FIT if cell == "–" else cell for cell in _or_dash(dataset["standard_tension"].values)],
    ]
    headings: tuple[str, ...] = ("nominal length\nmm", "longer by\nmm", "tension\nN")
    if "standard_position" in dataset:
        columns.append(_or_dash(carriers[0].shown(dataset["standard_position"].values)))
        headings = (*headings, _place(carriers[0]))
    if "standard_center_distance" in dataset:
        columns.append(_or_dash(1e3 * dataset["standard_center_distance"].values, 5))
        headings = (*headings, "center distance for the\nsame tension mm")
    if "standard_take_up" in dataset:
        columns.append(_or_dash(1e3 * dataset["standard_take_up"].values, 3))
        headings = (*headings, "take-up for the\nsame tension mm")
    return Table("Belts of standard length", headings, tuple(zip(*columns, strict=True)))


def _place(carrier: Carrier) -> str:
    """Heading of places of a tensioner."""
    return "\n".join(carrier.shown_as)


def _whole(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.0f}"


def _whole_numbers(values: FloatArray) -> list[list[str]]:
    return [list(map(_whole, row)) for row in values]


def _angle(radians: float) -> str:
    return "–" if np.isnan(radians) else f"{_DEGREES * radians:z.0f}°"


def _or_dash(values: FloatArray, digits: int = 4) -> list[str]:
    return ["–" if np.isnan(one) else f"{one:z.{digits}g}" for one in values]
