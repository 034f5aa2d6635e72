"""The analyses by name, each with its function, command and result files."""

from collections.abc import Callable
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

from beltdyn.kinds import Registry, register
from beltdyn.signals import closing

RUN, EQUILIBRIUM = "run", "equilibrium"
"""Kinds of results with a class of their own: results over time of any analysis, and results at rest."""

STUDY = "study"
"""Kind of the results of a parameter study."""

SIMULATE = "simulate"
"""Name of the analysis whose result file has the name of the drive file alone."""


class Analysis(NamedTuple):
    """The location of an analysis, without importing it."""

    place: str
    """"MODULE:FUNCTION"; the function is ``beltdyn.FUNCTION`` too."""
    purpose: str
    """What it computes, in one line for the help of the command line."""
    stays: bool = False
    """Whether its results at rest or in steady running are of a staying mesh."""

    @property
    def name(self) -> str:
        """Name of the function, and of the kind of its results unless they are over time, of the kind `RUN`."""
        return self.place.partition(":")[2]

    @property
    def command(self) -> str:
        """The word of the command line, and of the names of result files."""
        return self.name.replace("_", "-")

    @property
    def function(self) -> Callable[..., Any]:
        """The function ``f(drive, *, ...) -> beltdyn.Result``."""
        module, _, name = self.place.partition(":")
        function: Callable[..., Any] = getattr(import_module(module), name)
        return function

    @property
    def grows(self) -> bool:
        """Whether results are written while they are computed: the function has a parameter ``output``."""
        return "output" in signature(self.function).parameters

    @property
    def tells(self) -> bool:
        """Whether the function reports its progress: it has a parameter ``progress``."""
        return "progress" in signature(self.function).parameters

    def result_file(self, drive_file: Path) -> Path:
        """The default result file of a drive file."""
        return drive_file.with_name(f"{drive_file.stem}{'' if self.name == SIMULATE else f'-{self.command}'}.nc")

    def write(self, drive: Any, path: Path, progress: Any = None, overwrite: bool = False, **options: Any) -> Any:
        """Analyze a drive and write the results to a file.

        A function with a parameter ``output`` writes there while it computes, and takes ``overwrite`` too; results of
        other functions are saved at the end. A function with a parameter ``progress`` reports it.
        """
        function = self.function
        shared = {"output": path, "progress": progress, "overwrite": overwrite}
        taken = shared.keys() & signature(function).parameters.keys()
        result = function(drive, **{name: shared[name] for name in taken}, **options)
        if not self.grows:
            with closing():
                result.save(path, overwrite)
        return result


ANALYSES = Registry[Analysis]("analysis", Analysis)
"""All analyses by name."""

for _analysis in (
    Analysis("beltdyn.transient.simulate:simulate", "Simulate drives over time."),
    Analysis("beltdyn.transient.sweep:sweep", "Simulate a run-up through a range of speeds."),
    Analysis("beltdyn.state.equilibrium:equilibrium", "Find the static equilibrium of a drive."),
    Analysis("beltdyn.state.release:release", "Compute the shape of the belt released from its pulleys."),
    Analysis("beltdyn.state.steady:steady_state", "Compute the steady running of a drive."),
    Analysis("beltdyn.points.operating_points:operating_map", "Compute operating points over speed and load.", True),
    Analysis("beltdyn.points.traction:traction", "Compute the traction curve of a pulley: slip or tooth loads.", True),
    Analysis("beltdyn.points.duty:duty", "Compute the operating points of a duty cycle, and their means.", True),
    Analysis("beltdyn.points.life:life", "Compute fatigue damage and life of the belt, with shares of pulleys.", True),
    Analysis(
        "beltdyn.points.tensioner_sheet:tensioner_sheet",
        "Compute tensioner positions and tensions over the range of belt lengths.",
        True,
    ),
    Analysis(
        "beltdyn.designs.drive_sheet:sheet",
        "Compute the drive sheet: positions, tensions, hub loads, slip safety, peaks, modes, belts.",
    ),
    Analysis("beltdyn.points.belt_rating:rating", "Rate the belt: rated power, utilization, belts needed.", True),
    Analysis("beltdyn.designs.sensitivity:sensitivity", "Compute the sensitivity of results to each input.", True),
    Analysis("beltdyn.designs.convergence:convergence", "Compute errors and orders over meshes and tolerances."),
    Analysis("beltdyn.vibration.modes:modes", "Compute natural modes: frequencies, damping, shapes.", True),
    Analysis("beltdyn.designs.optimize:optimize", "Optimize parameters of a drive for a goal."),
    Analysis("beltdyn.designs.calibrate:calibrate", "Fit parameters of a drive to measured results."),
    Analysis("beltdyn.vibration.campbell:campbell", "Compute natural modes over speed, and critical speeds.", True),
    Analysis("beltdyn.vibration.response:response", "Compute forced vibrations under harmonics, over speed.", True),
    Analysis("beltdyn.vibration.stroke:stroke", "Compute stiffness and modes of a linear axis over its stroke."),
    # one line each
):
    register(_analysis)
