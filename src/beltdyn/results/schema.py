"""The variables of a result: their dimensions, units and meaning, in one table."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from beltdyn.parts.quantity import SHOWN_UNITS

if TYPE_CHECKING:
    import h5py
    import xarray as xr

FORMAT = (1, 4)
"""Version of the result file: the major number grows when earlier readers would misread a file, the minor number when a
file holds more than before."""

AXIS_NAMES = ("x", "y")
"""Names of the two axes of the plane."""


SHORT = "float32"
"""Type of variables for which single precision is enough (relative rounding error up to 6e-8)."""


@dataclass(frozen=True, slots=True)
class Variable:
    """Dimensions, units and meaning of a variable.

    Examples
    --------
    >>> tension = bd.results.VARIABLES["span_tension"]
    >>> tension.long_name, tension.units, tension.dims
    ('Span tension', 'N', ('time', 'span'))
    """

    dims: tuple[str, ...]
    """Dimensions in order. ``time`` or ``field_time`` comes first where it occurs."""
    units: str
    """SI units, "1" for a pure number."""
    long_name: str
    """The meaning in words, suitable as an axis label."""
    dtype: str = "float64"
    """NumPy data type; "str" for names."""
    core: bool = True
    """Whether every result file must hold it: summary, warnings and the essential figures need it."""
    at_rest: bool = False
    """Whether a drive in static equilibrium also has it."""

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of the variable in the dataset and its file."""
        attributes = {"long_name": self.long_name}
        return attributes if self.dtype == "str" else {"units": self.units, **attributes}


_OVER_TIME = ("time",)
_PULLEY = ("time", "pulley")
_NODE = ("field_time", "node", "coordinate")
_BODY = ("field_time", "body")
_ELEMENT = ("field_time", "element")
_SPAN = ("time", "span")
_POINT = ("field_time", "contact_point")
_TOOTH = ("field_time", "tooth")
_ARC = ("field_time", "pulley", "arc_part")
_TENSIONER = ("time", "tensioner")
_CARRIAGE = ("time", "carriage")
_ROLL = ("time", "roll")
_NIP = ("time", "nip")
_IN_NIP = ("field_time", "nip", "contact_point")

COORDINATES = MappingProxyType(
    {
        "time": Variable(("time",), "s", "Time"),
        "field_time": Variable(("field_time",), "s", "Time of outputs along the belt"),
        "filtered_time": Variable(("filtered_time",), "s", "Time of filtered outputs"),
        "pulley": Variable(("pulley",), "1", "Pulley", "str"),
        "span": Variable(("span",), "1", "Span, named by the pulleys or ends it connects", "str"),
        "body": Variable(("body",), "1", "Body other than the belt", "str", core=False),
        "tensioner": Variable(("tensioner",), "1", "Tensioner, named by the pulley it carries", "str"),
        "carriage": Variable(("carriage",), "1", "Carriage of a linear axis", "str", core=False),
        "roll": Variable(("roll",), "1", "Roll of a web line", "str", core=False),
        "nip": Variable(("nip",), "1", "Nip, named by its roller beside the path", "str", core=False),
        "axis": Variable(("axis",), "1", "Axis of the plane", "str"),
        "coordinate": Variable(("coordinate",), "1", "Nodal coordinate", "str"),
        "node_coordinate": Variable(("node",), "m", "Belt coordinate of the node, unstretched"),
        "element_coordinate": Variable(("element",), "m", "Belt coordinate of the element midpoint, unstretched"),
        "arc_share": Variable(("arc_part",), "1", "Position on the arc from the inlet", core=False),
        "belt_coordinate": Variable(("contact_point",), "m", "Belt coordinate of the contact point, unstretched"),
        "tooth_coordinate": Variable(("tooth",), "m", "Belt coordinate of the tooth, unstretched", core=False),
    }
)
"""Coordinates of the dataset by name; those along a dimension of size zero are omitted."""

_OUTPUTS = {
    "pulley_speed": Variable(_PULLEY, "rad/s", "Pulley speed"),
    "pulley_angle": Variable(_PULLEY, "rad", "Pulley angle"),
    "shaft_speed": Variable(_PULLEY, "rad/s", "Shaft speed"),
    "shaft_angle": Variable(_PULLEY, "rad", "Shaft angle"),
    "pulley_torque": Variable(_PULLEY, "N m", "Torque of the belt on the pulley"),
    "shaft_torque": Variable(_PULLEY, "N m", "Torque on the pulley's shaft"),
    "hub_force": Variable((*_PULLEY, "axis"), "N", "Force of the belt on the pulley", at_rest=True),
    "wrap_angle": Variable(_PULLEY, "rad", "Wrap angle", at_rest=True),
    "pulley_center": Variable((*_PULLEY, "axis"), "m", "Center of the pulley", at_rest=True),
    "sliding_speed": Variable(_PULLEY, "m/s", "Sliding speed of the whole arc", SHORT),
    "sliding_share": Variable(_PULLEY, "1", "Sliding share of the arc", SHORT),
    "friction_power": Variable(_PULLEY, "W", "Power lost in friction"),
    "contact_damping_power": Variable(_PULLEY, "W", "Power lost in contact damping"),
    "tensioner_position": Variable(_TENSIONER, "m, rad", "Tensioner position", at_rest=True),
    "tensioner_speed": Variable(_TENSIONER, "m/s, rad/s", "Tensioner speed", core=False),
    "carriage_position": Variable(_CARRIAGE, "m", "Way of the carriage", core=False, at_rest=True),
    "carriage_speed": Variable(_CARRIAGE, "m/s", "Speed of the carriage", core=False),
    "carriage_error": Variable(_CARRIAGE, "m", "Way of the carriage ahead of the driver", core=False),
    "roll_length": Variable(_ROLL, "m", "Unstretched length of web on the roll", core=False),
    "roll_radius": Variable(_ROLL, "m", "Radius of the roll", core=False),
    "roll_inertia": Variable(_ROLL, "kg m^2", "Moment of inertia of the roll", core=False),
    "roll_speed": Variable(_ROLL, "rad/s", "Speed of the roll in running direction", core=False),
    "roll_torque": Variable(_ROLL, "N m", "Torque of the web about the axis of the roll", core=False),
    "nip_width": Variable(_NIP, "m", "Nip width", core=False),
    "nip_tension_before": Variable(_NIP, "N", "Tension where the belt enters a nip", core=False),
    "nip_tension_after": Variable(_NIP, "N", "Tension where the belt leaves a nip", core=False),
    "node_position": Variable(("field_time", "node", "axis"), "m", "Node position", at_rest=True),
    "nodal_coordinates": Variable(_NODE, "m, 1", "Nodal coordinates", at_rest=True),
    "nodal_velocities": Variable(_NODE, "m/s, 1/s", "Nodal velocities", SHORT, core=False),
    "body_position": Variable(_BODY, "rad, m", "Body coordinate", core=False),
    "body_velocity": Variable(_BODY, "rad/s, m/s", "Body velocity", core=False),
    "belt_tension": Variable(_ELEMENT, "N", "Belt tension", at_rest=True),
    "tension_variation": Variable(
        _ELEMENT, "N", "Variation of the tension within an element", SHORT, core=False, at_rest=True
    ),
    "span_tension": Variable(_SPAN, "N", "Span tension", at_rest=True),
    "largest_span_tension": Variable(_SPAN, "N", "Largest tension of the span", core=False, at_rest=True),
    "least_span_tension": Variable(_SPAN, "N", "Least tension of the span", core=False, at_rest=True),
    "span_tension_at_start": Variable(_SPAN, "N", "Tension at the start of the span", core=False, at_rest=True),
    "span_tension_at_end": Variable(_SPAN, "N", "Tension at the end of the span", core=False, at_rest=True),
    "belt_speed": Variable(_SPAN, "m/s", "Belt speed"),
    "mid_span_displacement": Variable(_SPAN, "m", "Mid-span displacement", SHORT, core=False, at_rest=True),
    "normal_force": Variable(_POINT, "N/m", "Normal force on the belt", SHORT, at_rest=True),
    "friction_force": Variable(_POINT, "N/m", "Friction force on the belt", SHORT),
    "slip_velocity": Variable(_POINT, "m/s", "Slip velocity", SHORT),
    "nip_normal_force": Variable(_IN_NIP, "N/m", "Normal force of the roller beside the path", SHORT, core=False),
    "nip_friction_force": Variable(_IN_NIP, "N/m", "Friction force of the roller beside the path", SHORT, core=False),
    "nip_slip_velocity": Variable(_IN_NIP, "m/s", "Slip velocity on the roller beside the path", SHORT, core=False),
    "tooth_force": Variable(_TOOTH, "N", "Force of a tooth on the belt, along it", SHORT, core=False),
    "contact_position": Variable((*_POINT, "axis"), "m", "Contact point position", SHORT, at_rest=True),
    "contact_pulley": Variable(_POINT, "1", "Number of the pulley in contact, -1 where free", "int8", at_rest=True),
    "friction_work_on_arc": Variable(
        _ARC, "J", "Friction work on the arc since the previous output", SHORT, core=False
    ),
    "friction_work_on_belt": Variable(
        ("field_time", "pulley", "element"),
        "J",
        "Friction work on the belt since the previous output",
        SHORT,
        core=False,
    ),
    "kinetic_energy": Variable(_OVER_TIME, "J", "Kinetic energy"),
    "strain_energy": Variable(_OVER_TIME, "J", "Strain energy", at_rest=True),
    "penalty_energy": Variable(_OVER_TIME, "J", "Contact energy", at_rest=True),
    "spring_energy": Variable(_OVER_TIME, "J", "Tensioner and coupling energy", at_rest=True),
    "potential_energy": Variable(_OVER_TIME, "J", "Potential energy of weight and end forces", at_rest=True),
    "driver_work": Variable(_OVER_TIME, "J", "Work of the drivers"),
    "torque_work": Variable(_OVER_TIME, "J", "Work of applied torques"),
    "friction_loss": Variable(_OVER_TIME, "J", "Friction loss"),
    "damping_loss": Variable(_OVER_TIME, "J", "Contact damping loss"),
    "material_loss": Variable(_OVER_TIME, "J", "Belt material loss"),
    "stretch_loss": Variable(_OVER_TIME, "J", "Belt stretch loss", core=False),
    "bending_loss": Variable(_OVER_TIME, "J", "Belt bending loss", core=False),
    "compression_loss": Variable(_OVER_TIME, "J", "Belt compression loss", core=False),
    "tensioner_loss": Variable(_OVER_TIME, "J", "Tensioner loss"),
    "coupling_loss": Variable(_OVER_TIME, "J", "Coupling loss"),
    "carrying_loss": Variable(_OVER_TIME, "J", "Work on supports and goods", core=False),
    "numerical_loss": Variable(_OVER_TIME, "J", "Time integration loss"),
    "energy_closure": Variable(_OVER_TIME, "1", "Energy balance error"),
    "step_size": Variable(_OVER_TIME, "s", "Time step", core=False),
}

SPAN_TENSIONS = (
    "span_tension",
    *("largest_span_tension", "least_span_tension"),
    *("span_tension_at_start", "span_tension_at_end"),
)
"""The tension of a span: its mean, extremes, and values where the belt leaves a pulley and reaches the next one."""

SLIP_SAFETIES = MappingProxyType(
    {"slip_safety": "Slip safety", "own_load_safety": "Slip safety by the pulley's own load"}
)
"""Slip safety of pulleys, with labels: factor on all loads, and on the pulley's own. The lesser counts."""

SUBSTITUTES = MappingProxyType(dict.fromkeys(SPAN_TENSIONS[1:], SPAN_TENSIONS[0]) | {"own_load_safety": "slip_safety"})
"""Variable that results of earlier formats lack -> the one that stands for it."""

FILTERED = (
    *("pulley_speed", "shaft_speed", "pulley_torque", "shaft_torque", "hub_force", "tensioner_position"),
    *("span_tension", "belt_speed", "mid_span_displacement"),
)
"""Variables that are also recorded through a low-pass filter, for spectra, with the prefix ``filtered_``."""

FILTER_REACH = 12
"""Half-width of that filter, in output intervals."""

PASS_BAND = 0.5 - 1.5 / FILTER_REACH
"""Upper limit of the pass band over the output rate; amplitudes are kept to 0.02 %."""

STOP_BAND = 1.0 - PASS_BAND
"""Lower limit of the stop band over the output rate; less than 0.02 % (-75 dB) passes, which would alias below
`PASS_BAND`."""

VARIABLES = MappingProxyType(
    _OUTPUTS
    | {
        f"filtered_{name}": Variable(
            ("filtered_time", *_OUTPUTS[name].dims[1:]),
            _OUTPUTS[name].units,
            _OUTPUTS[name].long_name,
            SHORT,
            core=False,
        )
        for name in FILTERED
    }
)
"""Data variables of the dataset by name; those with a dimension of size zero are omitted."""

TIMES = ("field_time", "filtered_time", "time")
"""Dimensions along which results grow: outputs along the belt, filtered outputs, and all others."""

DERIVED = ("node_position",)
"""Variables that are parts of others: not stored, but added when a file is opened."""

RECORDED = MappingProxyType(
    {name: variable for name, variable in VARIABLES.items() if name not in DERIVED}
    | {name: COORDINATES[name] for name in TIMES}
)
"""Variables passed to a recorder, except those that `Layout.recorded` omits; `TIMES` come last, ``time`` last of "
"all."""

OPTIONAL = frozenset({"tensioner", "tooth", "carriage", "nip", "roll"})
"""Dimensions that may have size zero; they are then omitted with their variables."""

AUXILIARY_COORDINATES = MappingProxyType(
    {variable.dims[0]: name for name, variable in COORDINATES.items() if name != variable.dims[0]}
)
"""Dimension -> its coordinate of another name."""


# Display units of results

VARIOUS = "various"
"""Unit of a variable whose numbers have different ones, which another variable names."""
_MILLIMETRES = 0.1
"""Size of lengths, m, below which they are written in mm."""
_SHOWN = {**SHOWN_UNITS, **dict.fromkeys(("1", VARIOUS), ("", 1.0))}


def shown_unit(variable: "xr.DataArray") -> tuple[str, float]:
    """Give the display unit of a variable and its factor."""
    unit = str(variable.attrs.get("units", ""))
    if unit == "m" and not (abs(variable) >= _MILLIMETRES).any():
        return "mm", 1e3
    return _SHOWN.get(unit, (unit, 1.0))


def in_words(variable: "xr.DataArray") -> str:
    """Write a single value with its unit, such as "1500 rpm"; a text as it is."""
    if variable.dtype.kind != "f":
        return str(variable.item())
    unit, factor = shown_unit(variable)
    return f"{factor * float(variable):z.4g} {unit}".rstrip()


# What was recorded, by name: an xarray dataset, or a result file without the time that xarray takes to load


class Recorded(Protocol):
    """Variables by name, each an array with one row for each output, and global attributes."""

    @property
    def attrs(self) -> Mapping[Any, Any]:
        """Global attributes."""

    def __contains__(self, name: object, /) -> bool:
        """Whether a variable was recorded."""

    def __getitem__(self, name: str, /) -> Any:
        """A variable, which is read where it is indexed."""


def variable_of(dataset: "xr.Dataset", name: str) -> "xr.DataArray":
    """A variable, or in a result of an earlier format its substitute."""
    return dataset[name if name in dataset else SUBSTITUTES.get(name, name)]


def least_safeties(dataset: "xr.Dataset") -> "xr.DataArray":
    """The lesser slip safety of each pulley, NaN without load."""
    first, second = (variable_of(dataset, name) for name in SLIP_SAFETIES)
    return first.copy(data=np.fmin(first.values, second.transpose(*first.dims).values))


class InFile:
    """Variables of an open result file, read where they are indexed; of an earlier format with their `SUBSTITUTES`."""

    def __init__(self, file: "h5py.File") -> None:
        self._file = file
        self.attrs: Mapping[Any, Any] = file.attrs

    def __contains__(self, name: object, /) -> bool:
        """Whether a variable was recorded."""
        return name in self._file

    def __getitem__(self, name: str, /) -> Any:
        """A variable of the file."""
        return self._file[name if name in self._file else SUBSTITUTES.get(name, name)]


class InMemory:
    """Variables of a dataset as plain arrays, which are quicker to look at than labeled ones."""

    def __init__(self, dataset: "xr.Dataset") -> None:
        self._variables = dataset.variables
        self.attrs: Mapping[Any, Any] = dataset.attrs

    def __contains__(self, name: object, /) -> bool:
        """Whether a variable was recorded."""
        return name in self._variables

    def __getitem__(self, name: str, /) -> NDArray[Any]:
        """The values of a variable."""
        return np.asarray(self._variables[name].values)


def names(recorded: Recorded, dimension: str) -> list[str]:
    """Names along a dimension."""
    return [name.decode() if isinstance(name, bytes) else str(name) for name in np.asarray(recorded[dimension])]


def runs_steadily(recorded: Recorded) -> bool:
    """Whether it is steady running, in which nothing changes over time, in place of a run."""
    return "belt_parameter" in recorded.attrs


def attribute(recorded: Recorded, name: str, unknown: float) -> float:
    """Give an attribute that is a number."""
    return float(np.squeeze(recorded.attrs.get(name, unknown)))  # a file holds arrays of one number
