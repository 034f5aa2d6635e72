"""Headline of a figure: name of the drive and operating point."""

from collections.abc import Sequence
from textwrap import fill

from matplotlib.figure import Figure

from beltdyn.parts.quantity import RPM
from beltdyn.parts.text_file import as_text
from beltdyn.results import Result, Run, StaticResult, power_balance
from beltdyn.results.cycles import mean_window
from beltdyn.results.recorded import runs_steadily

_SIZE = 11
_AN_INCH = 11.5
"""Letters of this size in an inch."""


def write_headline(page: Figure, text: str) -> None:
    """Write above all panels of a page, at the left, in as many lines as it takes."""
    text = fill(text, int(_AN_INCH * page.get_figwidth()))
    page.suptitle(text, x=0.01, horizontalalignment="left", fontsize=_SIZE)


def headlines(results: Sequence[Result]) -> str:
    """The headline of one result, or the names of the drives of several, as far as they have names."""
    if len(results) == 1:
        return headline(results[0])
    return ", ".join(dict.fromkeys(name for name in map(name_of, results) if name))


def headline(result: Result) -> str:
    """Describe the drive of a result and its operating point.

    Parameters
    ----------
    result : Result
        Of a run with at least one output, or of another analysis.

    Returns
    -------
    str
        Such as "fan: motor 1440 rpm, 2.21 kW in"; without a name where a drive in memory has none.
    """
    if isinstance(result, Run):
        point = _range(result) or _operating_point(result)
    elif isinstance(result, StaticResult):
        point = f"at rest, mean belt tension {float(result.dataset['tension']):.4g} N"
    else:
        point = result.kind
    return ": ".join(part for part in (name_of(result), point) if part)


def at_instant(result: Result, time: float) -> str:
    """Name an instant of a run; nothing at rest and in steady running, where all instants are alike."""
    lasts = isinstance(result, StaticResult) or runs_steadily(result.dataset)
    return "" if lasts else f"t = {time:.4g} s"


def name_of(result: Result) -> str:
    """Name of a result: that of its drive, or of its file without suffix; empty in memory without either."""
    return result.drive.name or file_name(result)


def file_name(result: Result) -> str:
    """Name of a result's file without suffix; empty in memory."""
    return as_text(result.path.stem) if result.path is not None else ""


def _range(run: Run) -> str:
    """Mean speeds between which a pulley was swept; empty of other runs."""
    swept = run.dataset.attrs.get("swept_pulley", "")
    profile = next((one.speed for one in run.drive.pulleys if one.name == swept), None)
    if profile is None:
        return ""
    first, last = RPM * profile.at(run.dataset["time"].values[[0, -1]])
    return f"{swept} from {_whole(float(first))} to {_whole(float(last))} rpm"


def _operating_point(run: Run) -> str:
    """Mean speed at the end of the pulley that gives most power, and the power that is put in."""
    with run.recorded() as recorded:
        over = mean_window(recorded, run.drive)
        power = over.product(recorded, "shaft_torque", "shaft_speed")
        speed = RPM * over.mean(recorded, "pulley_speed")
        put_in = power_balance(recorded, over).power_in
    first = int(power.argmax()) if put_in > 0.0 else 0
    given = f", {_power(put_in)} in" if put_in > 0.0 else ""
    return f"{run.drive.pulleys[first].name} {_whole(float(speed[first]))} rpm{given} at the end"


def _power(power: float) -> str:
    return f"{power / 1e3:.3g} kW" if power >= 1e3 else f"{power:.3g} W"


def _whole(number: float) -> str:
    """Four digits, or all those before the point where they are more."""
    return f"{number:z.4g}" if abs(number) < 9999.5 else f"{number:.0f}"
