"""Analyses: a simulation over time, of one drive or many, a run-up, steady running, and rest; and their solvers."""

from beltdyn.solve.batch import simulate_all
from beltdyn.solve.calibrate import calibrate
from beltdyn.solve.campbell import campbell
from beltdyn.solve.duty import duty
from beltdyn.solve.equilibrium import equilibrium
from beltdyn.solve.integrators.generalized_alpha import GeneralizedAlpha
from beltdyn.solve.integrators.standard import StandardIntegrator
from beltdyn.solve.integrators.stepwise import ErrorControl, FixedSteps, StepError, Stepwise
from beltdyn.solve.modes import modes
from beltdyn.solve.operating_map import operating_map
from beltdyn.solve.optimize import optimize
from beltdyn.solve.progress import BatchProgress, Progress
from beltdyn.solve.response import response
from beltdyn.solve.rest.installation import Rest, bring_to_rest
from beltdyn.solve.rest.static import Equilibrium, find_equilibrium
from beltdyn.solve.sensitivity import sensitivity
from beltdyn.solve.simulate import simulate
from beltdyn.solve.simulator import Simulator
from beltdyn.solve.steady import steady_state
from beltdyn.solve.study import study
from beltdyn.solve.sweep import sweep
from beltdyn.solve.tensioner_sheet import tensioner_sheet
from beltdyn.solve.traction import traction
from beltdyn.solve.worker import Ending

__all__ = [
    "BatchProgress",
    "Ending",
    "Equilibrium",
    "ErrorControl",
    "FixedSteps",
    "GeneralizedAlpha",
    "Progress",
    "Rest",
    "Simulator",
    "StandardIntegrator",
    "StepError",
    "Stepwise",
    "bring_to_rest",
    "calibrate",
    "campbell",
    "duty",
    "equilibrium",
    "find_equilibrium",
    "modes",
    "operating_map",
    "optimize",
    "response",
    "sensitivity",
    "simulate",
    "simulate_all",
    "steady_state",
    "study",
    "sweep",
    "tensioner_sheet",
    "traction",
]
