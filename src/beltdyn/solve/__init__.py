"""Analyses: a simulation over time, of one drive or many, a run-up, steady running, and rest; and their solvers."""

from beltdyn.solve.batch import simulate_all
from beltdyn.solve.equilibrium import equilibrium
from beltdyn.solve.generalized_alpha import GeneralizedAlpha
from beltdyn.solve.installation import Rest, bring_to_rest
from beltdyn.solve.progress import BatchProgress, Progress
from beltdyn.solve.simulate import simulate
from beltdyn.solve.standard import StandardIntegrator
from beltdyn.solve.static import Equilibrium, find_equilibrium
from beltdyn.solve.steady import steady_state
from beltdyn.solve.stepwise import ErrorControl, FixedSteps, StepError, Stepwise
from beltdyn.solve.sweep import sweep
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
    "StandardIntegrator",
    "StepError",
    "Stepwise",
    "bring_to_rest",
    "equilibrium",
    "find_equilibrium",
    "simulate",
    "simulate_all",
    "steady_state",
    "sweep",
]
