"""Sheets of axes: over the stroke; of runs that end at standstill, the carriage, and peaks of pulleys and spans."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import BoolArray
from beltdyn.parts.messages import aligned
from beltdyn.parts.quantity import RPM
from beltdyn.results.cycles import last_change
from beltdyn.results.free_decay import free_decay, real_decay
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.schema import Recorded, names
from beltdyn.show.tables import Facts, Sheet, Table
from beltdyn.theory.input_shaping import EI_TOLERANCE, best_shaper

if TYPE_CHECKING:
    import xarray as xr

_MICROMETERS = 1e6
"""Micrometers in a meter: errors of position of a carriage are shown in µm."""
_UNDAMPED_RATE = 0.002
"""Decay rate over the frequency below which a vibration takes 350 periods to halve: what steps leave of rounding."""


def carriage_table(run: Run) -> tuple[Table, ...]:
    """Errors of position of the carriage, and how it rings after the last move; nothing without a carriage."""
    if run.drive.carriage is None:
        return ()
    with run.recorded() as recorded:
        time = np.asarray(recorded["time"])
        error = _MICROMETERS * np.asarray(recorded["carriage_error"])[:, 0]
        since = time >= last_change(run.prepared, time)
        ringing = _ringing(run, recorded, since) if "step_size" in recorded else ("–", "too few outputs")
    largest = int(np.argmax(np.abs(error)))
    rows = [
        ("largest error of position", _ahead(error[largest]), f"at {time[largest]:.4g} s"),
        ("error at the end", _ahead(error[-1]), f"at {time[-1]:.4g} s"),
        ("ringing after the last move", *ringing),
    ]
    return (Table(run.drive.carriage.name.capitalize(), ("", "", ""), tuple(rows)),)


def _ahead(error: float) -> str:
    """An error of position, µm, in words."""
    return f"{abs(error):.3g} µm {'ahead of' if error > 0.0 else 'behind'} the driver"


def _ringing(run: Run, recorded: Recorded, since: BoolArray) -> tuple[str, str]:
    """Frequency and amplitude of the vibration after the last change of what is prescribed, and its decay."""
    time = np.asarray(recorded["time"])[since][:-1]
    error = np.asarray(recorded["carriage_error"])[since, 0][:-1]
    decay = free_decay(time, error)
    if decay is None:
        swing = _MICROMETERS * np.ptp(error) / 2.0 if error.size else math.nan
        return (f"{swing:.2g} µm", "no free vibration") if error.size else ("–", "the move ends with the run")
    steps = np.asarray(recorded["step_size"])[since][:-1]
    real, _ = real_decay(decay, time, steps, run.drive.simulation.spectral_radius)
    size = f"{_MICROMETERS * decay.amplitude:.2g} µm at {real.frequency:.4g} Hz"
    if real.rate < _UNDAMPED_RATE * real.frequency:
        return size, "hardly dies away: give the belt its losses, or the guide its friction"
    return size, f"dies away with {real.rate:.2g} 1/s, by half in {math.log(2.0) / real.rate:.2g} s"


def stroke_sheet(result: Result) -> Sheet:
    """Give the sheet of an axis over its stroke: recommended tension, ringing, input shapers, stiffness and modes."""
    dataset = result.dataset
    parts = [Facts(tuple(_axis_facts(dataset)))]
    return Sheet(str(dataset.attrs["title"]), (*parts, _over_stroke(dataset), *_shapers(dataset), _modes(dataset)))


def _axis_facts(dataset: "xr.Dataset") -> Iterator[tuple[str, str]]:
    """What an axis needs, in words."""
    if "recommended_tension" in dataset:
        needed, tension = float(dataset["recommended_tension"]), float(dataset["tension"].mean())
        pull = f"for a pull of {float(dataset['largest_pull']):.3g} N"
        enough = "is enough" if tension >= needed else "is too little: a span becomes slack"
        yield "recommended tension", f"at least {needed:.3g} N, {pull}; {tension:.4g} N at rest {enough}"
    for name, words in (("recommended_frequency", "recommended"), ("plucked_frequency", "at rest")):
        if name in dataset:
            pairs = zip(dataset["span"].values, dataset[name].values.tolist(), strict=True)
            yield f"plucked spans, {words}", ", ".join(f"{span} {frequency:.3g} Hz" for span, frequency in pairs)
    frequency, ratio, rate = (dataset[name].values for name in ("frequency", "damping_ratio", "decay_rate"))
    rings = f"from {frequency.min():.4g} to {frequency.max():.4g} Hz over the stroke"
    if "friction_step" in dataset:
        step = _MICROMETERS * float(dataset["friction_step"].max())
        rings += f"; dry friction takes up to {step:.2g} µm of the amplitude in each period"
    if not ratio.max() > 0.0:
        yield "ringing", f"{rings}; decay unknown: the belt has no losses, and the guide no viscous friction"
    else:
        half = math.log(2.0) / rate
        yield "ringing", f"{rings}; its losses halve it in {half.min():.2g} to {half.max():.2g} s"
    yield "input shaper", _fitting_shaper(dataset)


def _fitting_shaper(dataset: "xr.Dataset") -> str:
    """The shortest shaper that leaves little, or that which leaves least."""
    names, left = dataset["shaper"].values, dataset["shaper_residual"].values
    number = best_shaper(left)
    frequency, longer = (float(dataset[name][number]) for name in ("shaper_frequency", "shaper_duration"))
    said = f"{names[number]} at {frequency:.4g} Hz leaves at most {left[number]:.1%} of the vibration over the stroke"
    if left[number] > EI_TOLERANCE:
        return f"none leaves {EI_TOLERANCE:.0%} or less; {said}. Over a shorter stroke frequencies are nearer together"
    return f"{said}, and makes moves {1e3 * longer:.2g} ms longer"


def _over_stroke(dataset: "xr.Dataset") -> Table:
    """Stiffness, frequency, decay and tension at each place."""
    columns = [
        ("stiffness\nN/mm", aligned((1e-3 * dataset["stiffness"].values).tolist(), 4)),
        ("rings at\nHz", aligned(dataset["frequency"].values.tolist(), 4)),
        ("damping\nratio", [f"{one:.2%}" for one in dataset["damping_ratio"].values]),
        ("decay\n1/s", aligned(dataset["decay_rate"].values.tolist(), 3)),
        ("carriage's\nshare", [f"{one:.0%}" for one in dataset["carriage_share"].values]),
        ("tension\nN", aligned(dataset["tension"].values.tolist(), 4)),
    ]
    return _by_place(dataset, "", columns)


def _shapers(dataset: "xr.Dataset") -> tuple[Table, ...]:
    """Input shapers for the frequencies over the stroke."""
    columns = (
        dataset["shaper"].values.tolist(),
        aligned(dataset["shaper_frequency"].values.tolist(), 4),
        [f"{1e3 * one:.2f}" for one in dataset["shaper_duration"].values],
        [f"{one:.1%}" for one in dataset["shaper_residual"].values],
    )
    headings = ("input shaper", "frequency\nHz", "longer by\nms", "vibration left\nat most")
    return (Table("", headings, tuple(zip(*columns, strict=True))),)


def _modes(dataset: "xr.Dataset") -> Table:
    """Frequencies of the lowest modes at each place, with what moves most."""
    frequencies, parts = dataset["mode_frequency"].values, dataset["mode_part"].values
    cells = [
        [f"{frequency:.4g} {part}" for frequency, part in zip(*pair, strict=True)]
        for pair in zip(frequencies.T, parts.T, strict=True)
    ]
    columns = [(f"mode {number}\nHz", column) for number, column in enumerate(cells, 1)]
    return _by_place(dataset, "Natural modes, with what moves most", columns)


def _by_place(dataset: "xr.Dataset", title: str, columns: Sequence[tuple[str, Sequence[str]]]) -> Table:
    """A table of columns over the ways of the carriage."""
    ways = [f"{1e3 * way:z.1f}" for way in dataset["place"].values]
    headings, cells = zip(*columns, strict=True)
    return Table(title, ("way\nmm", *headings), tuple(zip(ways, *cells, strict=True)))


def peak_tables(run: Run) -> tuple[Table, ...]:
    """Largest values of pulleys and extremes of spans over a run that ends at standstill."""
    with run.recorded() as recorded:
        pulleys, spans = names(recorded, "pulley"), names(recorded, "span")
        speed, torque = (np.asarray(recorded[name]) for name in ("shaft_speed", "shaft_torque"))
        power = speed * torque
        hub = np.linalg.norm(np.asarray(recorded["hub_force"]), axis=2)
        least, most = (np.asarray(recorded[name]) for name in ("least_span_tension", "largest_span_tension"))
        time = np.asarray(recorded["time"])
    columns = (RPM * np.abs(speed), np.abs(torque), np.abs(power), hub)
    cells = [aligned(np.nanmax(column, axis=0).tolist(), 4) for column in columns]
    of_pulleys = ("", "largest\nrpm", "torque\nN m", "power\nW", "hub\nN")
    low, high = np.nanargmin(least, axis=0), np.nanargmax(most, axis=0)
    along = np.arange(len(spans))
    of_spans = (
        aligned(least[low, along].tolist(), 4),
        [f"{time[number]:.4g}" for number in low],
        aligned(most[high, along].tolist(), 4),
        [f"{time[number]:.4g}" for number in high],
    )
    return (
        Table("Pulleys, largest of the run", of_pulleys, tuple(zip(pulleys, *cells, strict=True))),
        Table(
            "Spans, extremes of the run",
            ("", "least\nN", "at\ns", "largest\nN", "at\ns"),
            tuple(zip(spans, *of_spans, strict=True)),
        ),
    )
