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
    "power_in": Variable((), "W", "Power in"),
    "power_out": Variable((), "W", "Power out"),
    "efficiency": Variable((), "1", "Efficiency"),
    "largest_tension": Variable((), "N", "Largest tension"),
    "least_slip_safety": Variable((), "1", "Least slip safety"),
    "least_safe_pulley": Variable((), "1", "Pulley with it", "str"),
    "pulley_speed": Variable(PULLEY, "rad/s", "Speed of the pulley"),
    "shaft_torque": Variable(PULLEY, "N m", "Torque on the shaft"),
    "power": Variable(PULLEY, "W", "Power into the drive"),
    "pulley_slip": Variable(PULLEY, "1", "Slip"),
    "elastic_creep": Variable(PULLEY, "1", "Elastic creep"),
    "bending": Variable(PULLEY, "1", "Slip by bending"),
    "regularisation": Variable(PULLEY, "1", "Slip that the slope of the friction law makes"),
    "sliding": Variable(PULLEY, "1", "Slip of arcs that slide as a whole"),
    "slip_safety": Variable(PULLEY, "1", "Slip safety: factor on all loads at which the whole arc slides"),
    "sliding_arc": Variable(PULLEY, "rad", "Arc that slides"),
    "wrap_angle": Variable(PULLEY, "rad", "Wrap angle"),
    "hub_load": Variable(PULLEY, "N", "Hub load"),
    "hub_force": Variable((*PULLEY, "axis"), "N", "Force of the belt on the pulley"),
    "span_tension": Variable(_SPAN, "N", "Span tension"),
    "tensioner_position": Variable(_TENSIONER, "m or rad", "Position of the tensioner"),
    "tensioner_position_after_tensioning": Variable(
        _TENSIONER, "m or rad", "Position, held by dry friction as it grew"
    ),
    "tensioner_position_after_yielding": Variable(_TENSIONER, "m or rad", "Position, held by dry friction as it fell"),
    "loss": Variable(("cause",), "W", "Power lost"),
    "mesh_error": Variable((), "1", "Error of the mesh"),
    "failure": Variable((), "1", "Why there is no operating point", "str"),
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
