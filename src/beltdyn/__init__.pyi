from . import extend, model, results, theory
from .cosimulation import fmu
from .designs.batch import simulate_all
from .designs.calibrate import calibrate
from .designs.convergence import convergence
from .designs.drive_sheet import sheet
from .designs.optimize import optimize
from .designs.selection import select
from .designs.sensitivity import sensitivity
from .designs.study import study
from .errors import (
    BeltdynError,
    ConvergenceError,
    InternalError,
    ModelError,
)
from .model import (
    Belt,
    CalibrationStudy,
    Contact,
    Drive,
    Limits,
    OptimizationStudy,
    ParameterStudy,
    Pulley,
    Simulation,
    Steady,
    dumps,
    example,
    load,
    loads,
    read_catalogue,
)
from .points.belt_rating import rating
from .points.duty import duty
from .points.life import life
from .points.operating_points import operating_map
from .points.tensioner_sheet import tensioner_sheet
from .points.traction import traction
from .results import (
    Result,
    Run,
    derived,
    export,
    open_result,
    steady_comparison,
    summarize,
    write_csv,
)
from .show import plot
from .show.report import interactive, write_report
from .show.rest_sheet import check
from .state.equilibrium import equilibrium
from .state.release import release
from .state.steady import steady_state
from .transient.simulate import simulate
from .transient.simulator import Simulator
from .transient.sweep import sweep
from .vibration.campbell import campbell
from .vibration.modes import modes
from .vibration.response import response
from .vibration.stroke import stroke

__version__: str

__all__ = [
    "Belt",
    "BeltdynError",
    "CalibrationStudy",
    "Contact",
    "ConvergenceError",
    "Drive",
    "InternalError",
    "Limits",
    "ModelError",
    "OptimizationStudy",
    "ParameterStudy",
    "Pulley",
    "Result",
    "Run",
    "Simulation",
    "Simulator",
    "Steady",
    "calibrate",
    "campbell",
    "check",
    "convergence",
    "derived",
    "dumps",
    "duty",
    "equilibrium",
    "example",
    "export",
    "extend",
    "fmu",
    "interactive",
    "life",
    "load",
    "loads",
    "model",
    "modes",
    "open_result",
    "operating_map",
    "optimize",
    "plot",
    "rating",
    "read_catalogue",
    "release",
    "response",
    "results",
    "select",
    "sensitivity",
    "sheet",
    "simulate",
    "simulate_all",
    "steady_comparison",
    "steady_state",
    "stroke",
    "study",
    "summarize",
    "sweep",
    "tensioner_sheet",
    "theory",
    "traction",
    "write_csv",
    "write_report",
]
