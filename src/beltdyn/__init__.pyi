from . import errors, plot
from .errors import BeltdynError, ConvergenceError, ModelError
from .model import Belt, Contact, Drive, Pulley, Simulation, load, loads
from .results import Run, open_run
from .solve import equilibrium, simulate, simulate_all

__version__: str

__all__ = [
    "Belt",
    "BeltdynError",
    "Contact",
    "ConvergenceError",
    "Drive",
    "ModelError",
    "Pulley",
    "Run",
    "Simulation",
    "equilibrium",
    "errors",
    "load",
    "loads",
    "open_run",
    "plot",
    "simulate",
    "simulate_all",
]
