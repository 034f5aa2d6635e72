"""The drive: validated, immutable, read from and written to drive files."""

from beltdyn.machines import (
    AngleSpeedTable,
    AngleTable,
    BandBrake,
    Brake,
    Constant,
    CosineRamp,
    CosineRampPublished,
    Fan,
    FixedTensioner,
    FrictionClutch,
    FunctionLoad,
    Generator,
    Goods,
    Guide,
    Harmonic,
    Holdback,
    Idlers,
    InductionMotor,
    Isolator,
    LoadTable,
    Motor,
    MovingTensioner,
    OneWayClutch,
    PositionTable,
    PowerTable,
    Profile,
    Pump,
    Ramp,
    Resistance,
    RotaryTensioner,
    SCurve,
    ServoMotor,
    SlidingTensioner,
    SpeedTrim,
    Step,
    Table,
    TorqueTrim,
    Trapezoid,
)
from beltdyn.machines.carrying.support import SUPPORTS
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads.load import LOADS
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.machines.tensioners.tensioner import TENSIONERS
from beltdyn.model.advice import advise, describe_time, off_the_stop, unstable_balance
from beltdyn.model.alignment import Alignment, alignment
from beltdyn.model.belt import Belt
from beltdyn.model.catalogue import Entry, read_catalogue
from beltdyn.model.contact import Contact
from beltdyn.model.drive import Drive
from beltdyn.model.end import Carriage, FixedEnd, PulledEnd, WeightEnd
from beltdyn.model.installation import Installation
from beltdyn.model.nip import Nip
from beltdyn.model.parameter_study import CalibrationStudy, DutyPoint, OptimizationStudy, ParameterStudy
from beltdyn.model.path import Path
from beltdyn.model.prepared import Prepared, install, prepare, tensioner_balances
from beltdyn.model.pulley import Cover, Pulley
from beltdyn.model.rating import CordFatigue, Rating, RibFatigue
from beltdyn.model.resolution import ERROR_LIMITS, Running, elements_needed, layer_lengths, mesh_errors, unresolved
from beltdyn.model.rest_estimate import estimate_at_rest
from beltdyn.model.sheet_head import SheetHead
from beltdyn.model.simulation import Limits, Simulation, Steady
from beltdyn.model.static_estimate import TensionerBalance
from beltdyn.model.toml import dumps, example, json_schema, load, loads
from beltdyn.model.toothing import Toothing
from beltdyn.model.web import Roll, Unwinder, Winder

__all__ = [
    "ERROR_LIMITS",
    "Alignment",
    "AngleSpeedTable",
    "AngleTable",
    "BandBrake",
    "Belt",
    "Brake",
    "CalibrationStudy",
    "Carriage",
    "Constant",
    "Contact",
    "CordFatigue",
    "CosineRamp",
    "CosineRampPublished",
    "Cover",
    "Drive",
    "DutyPoint",
    "Entry",
    "Fan",
    "FixedEnd",
    "FixedTensioner",
    "FrictionClutch",
    "FunctionLoad",
    "Generator",
    "Goods",
    "Guide",
    "Harmonic",
    "Holdback",
    "Idlers",
    "InductionMotor",
    "Installation",
    "Isolator",
    "Limits",
    "LoadTable",
    "Motor",
    "MovingTensioner",
    "Nip",
    "OneWayClutch",
    "OptimizationStudy",
    "ParameterStudy",
    "Path",
    "PositionTable",
    "PowerTable",
    "Prepared",
    "Profile",
    "PulledEnd",
    "Pulley",
    "Pump",
    "Ramp",
    "Rating",
    "Resistance",
    "RibFatigue",
    "Roll",
    "RotaryTensioner",
    "Running",
    "SCurve",
    "ServoMotor",
    "SheetHead",
    "Simulation",
    "SlidingTensioner",
    "SpeedTrim",
    "Steady",
    "Step",
    "Table",
    "TensionerBalance",
    "Toothing",
    "TorqueTrim",
    "Trapezoid",
    "Unwinder",
    "WeightEnd",
    "Winder",
    "advise",
    "alignment",
    "describe_time",
    "dumps",
    "elements_needed",
    "estimate_at_rest",
    "example",
    "install",
    "json_schema",
    "layer_lengths",
    "load",
    "loads",
    "mesh_errors",
    "off_the_stop",
    "prepare",
    "read_catalogue",
    "tensioner_balances",
    "unresolved",
    "unstable_balance",
]

for _family in (LINKS, LOADS, PROFILES, SUPPORTS, TENSIONERS):
    for _kind in _family.values():
        if _kind.__name__ not in __all__:  # of a file that was added to the package
            globals()[_kind.__name__] = _kind
            __all__ += [_kind.__name__]
