from typing import TYPE_CHECKING

if TYPE_CHECKING:  # type checkers take these last: kinds of the package import from here what stands above them
    from beltdyn.analyses import Analysis
    from beltdyn.arrays import record, records
    from beltdyn.contact.friction.law import FrictionLaw
    from beltdyn.contact.normal.law import NormalForce, NormalLaw
    from beltdyn.contact.surface.kind import Gap, SurfaceKind
    from beltdyn.elements.kind import ElementKind
    from beltdyn.kernel import kernel
    from beltdyn.kinds import Parameter, register
    from beltdyn.machines.carrying.support import LineForce, Support
    from beltdyn.machines.links.link import HubLink, LinkTorque
    from beltdyn.machines.loads.load import Load, LoadTorque, SensorSlope, ShaftState, StateRate, nearer_kink
    from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
    from beltdyn.machines.tensioners.tensioner import (
        SPRING,
        Center,
        Direction,
        MovingTensioner,
        SpringTensioner,
        TensionerForce,
        spring_force,
    )
    from beltdyn.model.simulation import IntegratorKind
    from beltdyn.parts.quantity import quantity
    from beltdyn.results.result import build_result
    from beltdyn.results.schema import Variable
    from beltdyn.show.plot.figures import figure
    from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
    from beltdyn.solvers.run_progress import BatchProgress, Progress
    from beltdyn.solvers.standard import ErrorControl, FixedSteps, StandardIntegrator, StepError, Stepwise
    from beltdyn.stretch.law import Stretching, StretchLaw

__all__ = [
    "SEGMENT",
    "SPRING",
    "Analysis",
    "BatchProgress",
    "Center",
    "Direction",
    "ElementKind",
    "ErrorControl",
    "FixedSteps",
    "FrictionLaw",
    "Gap",
    "GeneralizedAlpha",
    "HubLink",
    "IntegratorKind",
    "LineForce",
    "LinkTorque",
    "Load",
    "LoadTorque",
    "MovingTensioner",
    "NormalForce",
    "NormalLaw",
    "Parameter",
    "Profile",
    "Progress",
    "SensorSlope",
    "ShaftState",
    "SpringTensioner",
    "StandardIntegrator",
    "StateRate",
    "StepError",
    "Stepwise",
    "StretchLaw",
    "Stretching",
    "Support",
    "SurfaceKind",
    "TensionerForce",
    "Value",
    "Variable",
    "build_result",
    "figure",
    "kernel",
    "nearer_kink",
    "quantity",
    "record",
    "records",
    "register",
    "spring_force",
]
