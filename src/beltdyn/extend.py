"""What authors of analyses, figures and integrators need."""

from beltdyn.analyses import Analysis
from beltdyn.results.result import build_result
from beltdyn.results.schema import Variable
from beltdyn.show.plot.registry import figure
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.progress import BatchProgress, Progress
from beltdyn.solvers.standard import ErrorControl, FixedSteps, StandardIntegrator, StepError, Stepwise

__all__ = [
    "Analysis",
    "BatchProgress",
    "ErrorControl",
    "FixedSteps",
    "GeneralizedAlpha",
    "Progress",
    "StandardIntegrator",
    "StepError",
    "Stepwise",
    "Variable",
    "build_result",
    "figure",
]
