"""Results of steady running and at rest by name, such as "pulley_slip[driven]" and "mode_frequency[2]"."""

from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.parts.messages import suggest
from beltdyn.points.operating_points import DATA, VARIABLES, labels_of, values_by_name, variables_in, variables_of
from beltdyn.results import Run, Variable
from beltdyn.results.run import OWN
from beltdyn.results.summary import means_of
from beltdyn.vibration.modes import FIRST_STUCK
from beltdyn.vibration.small_motions import dry_tensioners

MODES = 12
"""Modes that have names by their numbers; as many more with stuck tensioners, if dry friction may hold some."""

OF_MODES = {
    "frequency": Variable(("span",), "Hz", "Lowest frequency of the modes dominated by the span"),
    "damping_ratio": Variable(("span",), "1", "Damping ratio of that mode"),
    "mode_frequency": Variable(("mode",), "Hz", "Frequency of the numbered mode"),
    "mode_damping_ratio": Variable(("mode",), "1", "Damping ratio of the numbered mode"),
}
"""Results of modes, in steady running and at rest."""

AT_REST = {name: VARIABLES[name] for name in ("largest_tension", "wrap_angle", "span_tension", "tensioner_position")}
AT_REST |= OWN
"""Results of a drive at rest."""


def name_of(variable: str, label: str = "") -> str:
    """The name of a scalar result."""
    return f"{variable}[{label}]" if label else variable


def variable_and_label(name: str) -> tuple[str, str]:
    """Variable and label of a scalar result; the reverse of `name_of`."""
    variable, _, label = name.removesuffix("]").partition("[")
    return variable, label


def need_bands(names: Iterable[str]) -> bool:
    """Whether results are among those that dry friction of tensioners makes of its own."""
    return any(name.startswith("tensioner_position_after") for name in names)


def listed(names: str | Sequence[str]) -> list[str]:
    """Names of a list, or of a text with commas between."""
    given = names.split(",") if isinstance(names, str) else names
    return [name.strip() for name in given if name.strip()]


def scalar_results(run: Run) -> list[str]:
    """Variables of a run that are numbers, or numbers of pulleys, spans, tensioners and causes."""
    return [name for name, one in variables_in(run).items() if one.dtype != "str" and len(one.dims) < 2]


def values_of(run: Run, variables: Collection[str]) -> dict[str, float]:
    """Scalar results of a run by their names, of some variables of `scalar_results`."""
    found, labels, wanted = dict[str, float](), labels_of(run.drive), set(variables).intersection(scalar_results(run))
    for name, values in values_by_name(run, means_of(run), wanted).items() if wanted else ():
        if name in wanted:
            dims = VARIABLES[name].dims
            parts = [name_of(name, label) for label in (labels[dims[0]] if dims else [""])]
            found |= {part: float(value) for part, value in zip(parts, np.atleast_1d(values), strict=True)}
    return found


def names_of(drive: Drive, *, at_rest: bool = False) -> list[str]:
    """Names of the scalar results of a drive, and of its modes; of some there may be no value."""
    labels, found = labels_of(drive) | {"mode": _numbers_of_modes(drive)}, list[str]()
    for name, variable in ((AT_REST if at_rest else variables_of(drive)) | OF_MODES).items():
        if variable.dtype != "str" and len(variable.dims) < 2:
            found += [name_of(name, label) for label in (labels[variable.dims[0]] if variable.dims else [""])]
    return found


def _numbers_of_modes(drive: Drive) -> list[str]:
    """Numbers of modes, as `beltdyn modes` gives them."""
    firsts = (1, FIRST_STUCK) if dry_tensioners(prepare(drive)).size else (1,)
    return [str(first + one) for first in firsts for one in range(MODES)]


def names_in(known: Mapping[str, float] | Sequence[str], of: str | Sequence[str], key: str = "of") -> list[str]:
    """The names of results that a text asks for."""
    if of == "all":
        return list(known)
    found = list[str]()
    for wanted in listed(of):
        named = [name for name in known if wanted in (name, variable_and_label(name)[0])]
        if not named:
            names = known if "[" in wanted else dict.fromkeys(variable_and_label(name)[0] for name in known)
            needed = DATA.get(variable_and_label(wanted)[0])
            if needed is not None:
                raise ModelError(f"{key} = {wanted!r} needs data that the belt does not have. Give {needed}.")
            raise ModelError(f"{key} = {wanted!r} is not a numerical result. {suggest(wanted, list(names))}")
        found += named
    return list(dict.fromkeys(found))


def unit_of(name: str, drive: Drive) -> str:
    """SI unit of a result; empty for a pure number."""
    variable, label = variable_and_label(name)
    unit = (VARIABLES | AT_REST | OF_MODES)[variable].units
    if unit == "m or rad":
        turning = {one.pulley: one.turns for one in drive.moving_tensioners}
        unit = "rad" if turning.get(label, all(turning.values())) else "m"
    return "" if unit == "1" else unit
