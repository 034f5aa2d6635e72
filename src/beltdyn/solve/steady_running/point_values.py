"""What is known of an operating point, and how it follows from steady running."""

from typing import Any

import numpy as np

from beltdyn.model import Drive
from beltdyn.results import Run, Variable
from beltdyn.results.balance import LOSSES
from beltdyn.results.schema import AXIS_NAMES
from beltdyn.results.summary import Means

PULLEY, _SPAN, _TENSIONER = ("pulley",), ("span",), ("tensioner",)
_CAUSES = [cause for name, cause in LOSSES.items() if name != "numerical_loss"]

VARIABLES = {
    "belt_speed": Variable((), "m/s", "Belt speed"),
    "power_in": Variable((), "W", "Power input"),
    "power_out": Variable((), "W", "Power output"),
    "efficiency": Variable((), "1", "Efficiency"),
    "largest_tension": Variable((), "N", "Largest tension"),
    "least_slip_safety": Variable((), "1", "Least capstan margin"),
    "least_safe_pulley": Variable((), "1", "Pulley with the least capstan margin", "str"),
    "pulley_speed": Variable(PULLEY, "rad/s", "Pulley speed"),
    "shaft_torque": Variable(PULLEY, "N m", "Shaft torque"),
    "power": Variable(PULLEY, "W", "Power into the drive"),
    "pulley_slip": Variable(PULLEY, "1", "Slip"),
    "elastic_creep": Variable(PULLEY, "1", "Elastic creep"),
    "bending": Variable(PULLEY, "1", "Slip due to bending"),
    "regularisation": Variable(PULLEY, "1", "Slip due to the friction law slope"),
    "sliding": Variable(PULLEY, "1", "Gross slip"),
    "slip_safety": Variable(PULLEY, "1", "Capstan margin: factor on all loads at gross slip"),
    "sliding_arc": Variable(PULLEY, "rad", "Sliding arc"),
    "wrap_angle": Variable(PULLEY, "rad", "Wrap angle"),
    "hub_load": Variable(PULLEY, "N", "Hub load"),
    "hub_force": Variable((*PULLEY, "axis"), "N", "Force of the belt on the pulley"),
    "span_tension": Variable(_SPAN, "N", "Span tension"),
    "tensioner_position": Variable(_TENSIONER, "m or rad", "Tensioner position"),
    "tensioner_position_after_tensioning": Variable(
        _TENSIONER, "m or rad", "Position, held by dry friction after tensioning"
    ),
    "tensioner_position_after_yielding": Variable(
        _TENSIONER, "m or rad", "Position, held by dry friction after yielding"
    ),
    "loss": Variable(("cause",), "W", "Power loss"),
    "mesh_error": Variable((), "1", "Mesh error"),
    "failure": Variable((), "1", "Why the operating point failed", "str"),
}
"""What is known of an operating point; dimensions of the table come first."""

_OF_PULLEYS = {
    "pulley_speed": "speed",
    "shaft_torque": "shaft_torque",
    "power": "power",
    "pulley_slip": "slip",
    "elastic_creep": "elastic_creep",
    "bending": "bending",
    "regularisation": "regularisation",
    "sliding": "sliding",
    "slip_safety": "margin",
    "sliding_arc": "sliding_arc",
    "wrap_angle": "wrap_angle",
    "hub_load": "hub_load",
}
"""Variable -> attribute of a `PulleySummary`."""


def labels_of(drive: Drive) -> dict[str, list[str]]:
    """Labels along the dimensions of `VARIABLES`."""
    return {
        "pulley": [one.name for one in drive.pulleys],
        "span": ["-".join(names) for names in drive.spans],
        "tensioner": [one.pulley for one in drive.moving_tensioners],
        "cause": _CAUSES,
        "axis": list(AXIS_NAMES),
    }


def values_by_name(run: Run, means: Means) -> dict[str, Any]:
    """The values of an operating point by the names of `VARIABLES`.

    Parameters
    ----------
    run
        Steady running.
    means
        Its means.
    """
    balance, dataset, tensions = means.balance, run.dataset, [one.tension for one in means.spans]
    values: dict[str, Any] = {
        name: [getattr(one, attribute) for one in means.pulleys] for name, attribute in _OF_PULLEYS.items()
    }
    values |= {
        "hub_force": dataset["hub_force"].values[-1],
        "span_tension": tensions,
        "belt_speed": np.mean([abs(one.belt_speed) for one in means.spans]),
        "largest_tension": max(tensions),
        "power_in": balance.power_in,
        "power_out": balance.power_out,
        "efficiency": balance.efficiency,
        "loss": [balance.losses[cause] for cause in _CAUSES],
    }
    safeties = np.array(values["slip_safety"])
    if np.any(np.isfinite(safeties)):
        least = int(np.nanargmin(safeties))
        values |= {"least_slip_safety": safeties[least], "least_safe_pulley": means.pulleys[least].name}
    if means.tensioners:
        values["tensioner_position"] = stands = [one.position for one in means.tensioners]
        for name in ("tensioner_position_after_tensioning", "tensioner_position_after_yielding"):
            values[name] = dataset.attrs.get(name, stands)
    return values
