"""The variables of a result: their dimensions, units and meaning, in one table."""

from dataclasses import dataclass
from types import MappingProxyType

FORMAT = (1, 3)
"""Version of the result file. The first number grows when earlier readers would misread a file, the second when a file
holds more than before."""

AXIS_NAMES = ("x", "y")
"""Names of the two directions of the plane."""


SHORT = "float32"
"""Type of what is precise enough with 24 binary digits: rounding changes it by up to 6e-8 of its value."""


@dataclass(frozen=True, slots=True)
class Variable:
    """What a reader needs to know about one variable.

    Attributes
    ----------
    dims : tuple of str
        Dimensions in order. ``time`` or ``field_time`` comes first where it occurs.
    units : str
        SI units, "1" for a pure number.
    long_name : str
        The meaning in words, fit for the label of a figure's axis.
    dtype : str
        NumPy data type; "str" for names.
    core : bool
        Whether a file without it is no result: summary, warnings and the essential figures need it.
    at_rest : bool
        Whether a drive in static equilibrium has it, too.

    Examples
    --------
    >>> tension = bd.results.VARIABLES["span_tension"]
    >>> tension.long_name, tension.units, tension.dims
    ('Span tension', 'N', ('time', 'span'))
    """

    dims: tuple[str, ...]
    units: str
    long_name: str
    dtype: str = "float64"
    core: bool = True
    at_rest: bool = False

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
_ARC = ("field_time", "pulley", "arc_part")
_TENSIONER = ("time", "tensioner")

COORDINATES = MappingProxyType(
    {
        "time": Variable(("time",), "s", "Time"),
        "field_time": Variable(("field_time",), "s", "Time of what is recorded along the belt"),
        "filtered_time": Variable(("filtered_time",), "s", "Time of what is recorded for spectra"),
        "pulley": Variable(("pulley",), "1", "Pulley", "str"),
        "span": Variable(("span",), "1", "Span, from pulley or end to pulley or end", "str"),
        "body": Variable(("body",), "1", "Body beside the belt, with a coordinate of its own", "str", core=False),
        "tensioner": Variable(("tensioner",), "1", "Tensioner, by the pulley it carries", "str"),
        "axis": Variable(("axis",), "1", "Direction in the plane", "str"),
        "coordinate": Variable(("coordinate",), "1", "Nodal coordinate", "str"),
        "node_coordinate": Variable(("node",), "m", "Belt coordinate of the node, unstretched"),
        "element_coordinate": Variable(("element",), "m", "Belt coordinate of the element's middle, unstretched"),
        "arc_share": Variable(("arc_part",), "1", "Share of the arc from the inlet", core=False),
        "belt_coordinate": Variable(("contact_point",), "m", "Belt coordinate of the contact point, unstretched"),
    }
)
"""Coordinates of the dataset by name; those along a dimension of size zero are left out."""

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
    "sliding_speed": Variable(_PULLEY, "m/s", "Velocity at which the whole arc slides", SHORT),
    "sliding_share": Variable(_PULLEY, "1", "Share of the arc that slides", SHORT),
    "friction_power": Variable(_PULLEY, "W", "Power lost in friction"),
    "contact_damping_power": Variable(_PULLEY, "W", "Power lost in contact damping"),
    "tensioner_position": Variable(_TENSIONER, "m, rad", "Tensioner position", at_rest=True),
    "tensioner_speed": Variable(_TENSIONER, "m/s, rad/s", "Tensioner speed", core=False),
    "node_position": Variable(("field_time", "node", "axis"), "m", "Node position", at_rest=True),
    "nodal_coordinates": Variable(_NODE, "m, 1", "Nodal coordinates", at_rest=True),
    "nodal_velocities": Variable(_NODE, "m/s, 1/s", "Nodal velocities", SHORT, core=False),
    "body_position": Variable(_BODY, "rad, m", "Coordinate of a body", core=False),
    "body_velocity": Variable(_BODY, "rad/s, m/s", "Rate of the coordinate of a body", core=False),
    "belt_tension": Variable(_ELEMENT, "N", "Belt tension", at_rest=True),
    "tension_variation": Variable(
        _ELEMENT, "N", "Variation of the tension within an element", SHORT, core=False, at_rest=True
    ),
    "span_tension": Variable(_SPAN, "N", "Span tension", at_rest=True),
    "belt_speed": Variable(_SPAN, "m/s", "Belt speed"),
    "mid_span_displacement": Variable(_SPAN, "m", "Mid-span displacement", SHORT, core=False, at_rest=True),
    "normal_force": Variable(_POINT, "N/m", "Normal force on the belt", SHORT, at_rest=True),
    "friction_force": Variable(_POINT, "N/m", "Friction force on the belt", SHORT),
    "slip_velocity": Variable(_POINT, "m/s", "Slip velocity", SHORT),
    "contact_position": Variable((*_POINT, "axis"), "m", "Position of the contact point", SHORT, at_rest=True),
    "contact_pulley": Variable(_POINT, "1", "Pulley in contact by number, -1 where free", "int8", at_rest=True),
    "friction_work_on_arc": Variable(
        _ARC, "J", "Work of friction since the output before, on the arc", SHORT, core=False
    ),
    "friction_work_on_belt": Variable(
        ("field_time", "pulley", "element"),
        "J",
        "Work of friction since the output before, on the belt",
        SHORT,
        core=False,
    ),
    "kinetic_energy": Variable(_OVER_TIME, "J", "Kinetic energy"),
    "strain_energy": Variable(_OVER_TIME, "J", "Strain energy", at_rest=True),
    "penalty_energy": Variable(_OVER_TIME, "J", "Energy of contact", at_rest=True),
    "spring_energy": Variable(_OVER_TIME, "J", "Energy of tensioners and couplings", at_rest=True),
    "potential_energy": Variable(_OVER_TIME, "J", "Potential energy of weight and forces at ends", at_rest=True),
    "driver_work": Variable(_OVER_TIME, "J", "Work of the drivers"),
    "torque_work": Variable(_OVER_TIME, "J", "Work of the applied torques"),
    "friction_loss": Variable(_OVER_TIME, "J", "Loss in friction"),
    "damping_loss": Variable(_OVER_TIME, "J", "Loss in contact damping"),
    "material_loss": Variable(_OVER_TIME, "J", "Loss in the belt's material"),
    "stretch_loss": Variable(_OVER_TIME, "J", "Loss in the belt's stretch", core=False),
    "bending_loss": Variable(_OVER_TIME, "J", "Loss in the belt's bending", core=False),
    "compression_loss": Variable(_OVER_TIME, "J", "Loss in the belt's compression on pulleys", core=False),
    "tensioner_loss": Variable(_OVER_TIME, "J", "Loss in tensioners"),
    "coupling_loss": Variable(_OVER_TIME, "J", "Loss in couplings"),
    "numerical_loss": Variable(_OVER_TIME, "J", "Loss in time integration"),
    "energy_closure": Variable(_OVER_TIME, "1", "Closure error of the energy account"),
    "step_size": Variable(_OVER_TIME, "s", "Time step", core=False),
}

FILTERED = (
    *("pulley_speed", "shaft_speed", "pulley_torque", "shaft_torque", "hub_force", "tensioner_position"),
    *("span_tension", "belt_speed", "mid_span_displacement"),
)
"""Variables that are recorded for spectra too, through a low-pass filter, with ``filtered_`` before their names."""

FILTER_REACH = 12
"""Reach of that filter before and after an output, in intervals of outputs."""

PASS_BAND = 0.5 - 1.5 / FILTER_REACH
"""Highest frequency, over the rate of outputs, whose amplitude the filter keeps to 0.02 %."""

STOP_BAND = 1.0 - PASS_BAND
"""Frequency, over the rate of outputs, from which on it leaves less than 0.02 % (-75 dB): these would fold back below
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
"""Data variables of the dataset by name; those with a dimension of size zero are left out."""

TIMES = ("field_time", "filtered_time", "time")
"""Dimensions along which results grow: of what is recorded along the belt, of what is filtered, and of all else."""

DERIVED = ("node_position",)
"""Variables that are parts of others: they are in no file, and added when it is opened."""

RECORDED = MappingProxyType(
    {name: variable for name, variable in VARIABLES.items() if name not in DERIVED}
    | {name: COORDINATES[name] for name in TIMES}
)
"""What a recorder is given but for what `Layout.recorded` leaves out; `TIMES` come last, ``time`` last of all."""

OPTIONAL = frozenset({"tensioner"})
"""Dimensions that may be of size zero, and are left out then with all that lies along them."""

AUXILIARY_COORDINATES = MappingProxyType(
    {variable.dims[0]: name for name, variable in COORDINATES.items() if name != variable.dims[0]}
)
"""Dimension -> the coordinate that is laid along it under another name."""
