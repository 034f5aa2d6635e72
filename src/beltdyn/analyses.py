"""Analyses by name: each is a function of a drive, which gives a result, a command and the files that it writes."""

from collections.abc import Callable
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

RUN, STATIC = "run", "static"
"""Kinds of results that have a class of their own: those that grow over time, of any analysis, and those at rest."""

STUDY = "study"
"""Kind of the results of many analyses of drives that differ in some numbers."""


class Analysis(NamedTuple):
    """Where an analysis is found, without importing it.

    Attributes
    ----------
    name : str
        Name of the command, and of the kind of its results; those over time are of the kind `RUN`.
    place : str
        "MODULE:FUNCTION"; the function is ``beltdyn.FUNCTION`` too.
    purpose : str
        What it tells, in one line for the help of the command line.
    """

    name: str
    place: str
    purpose: str

    @property
    def public_name(self) -> str:
        """Name of the function."""
        return self.place.partition(":")[2]

    @property
    def function(self) -> Callable[..., Any]:
        """The function ``f(drive, *, ...) -> beltdyn.Result``."""
        module, _, name = self.place.partition(":")
        function: Callable[..., Any] = getattr(import_module(module), name)
        return function

    @property
    def grows(self) -> bool:
        """Whether results grow over time and are written as they come: the function has a parameter ``output``."""
        return "output" in signature(self.function).parameters

    @property
    def tells(self) -> bool:
        """Whether the function tells of its progress: it has a parameter ``progress``."""
        return "progress" in signature(self.function).parameters

    def result_file(self, drive_file: Path) -> Path:
        """The result file of a drive file where none is named.

        Parameters
        ----------
        drive_file : Path
            Such as ``drive.toml``.

        Returns
        -------
        Path
            ``drive.nc`` of a run, and ``drive-NAME.nc`` of other analyses.
        """
        return drive_file.with_name(f"{drive_file.stem}{'' if self.name == RUN else f'-{self.name}'}.nc")

    def write(self, drive: Any, path: Path, progress: Any = None, overwrite: bool = False, **options: Any) -> Any:
        """Analyse a drive, with the results in a file.

        A function that has a parameter ``output`` writes there as it goes, and takes ``overwrite`` too; what others
        give is saved at the end. One that has a parameter ``progress`` tells of it.

        Parameters
        ----------
        drive : Drive
            The drive.
        path : Path
            The result file.
        progress : callable, optional
            Called now and then with a `beltdyn.Progress`.
        overwrite : bool
            Replace any regular file, and not only results.
        **options
            Those of the function.

        Returns
        -------
        Result
            What the function gave.
        """
        function = self.function
        shared = {"output": path, "progress": progress, "overwrite": overwrite}
        taken = shared.keys() & signature(function).parameters.keys()
        result = function(drive, **{name: shared[name] for name in taken}, **options)
        if not self.grows:
            result.save(path, overwrite)
        return result


_ALL = (
    Analysis(RUN, "beltdyn.solve.simulate:simulate", "Simulate drives over time."),
    Analysis("sweep", "beltdyn.solve.sweep:sweep", "Run a drive up through a range of speeds."),
    Analysis(STATIC, "beltdyn.solve.equilibrium:equilibrium", "Find the static equilibrium of a drive at rest."),
    Analysis("steady", "beltdyn.solve.steady:steady_state", "Find the steady running of a drive."),
    Analysis("map", "beltdyn.solve.operating_map:operating_map", "Find operating points over speed and load."),
    Analysis("traction", "beltdyn.solve.traction:traction", "Find the slip of a pulley over its torque."),
    Analysis("duty", "beltdyn.solve.duty:duty", "Find the operating points of a duty table, and means over it."),
    Analysis("tensioner", "beltdyn.solve.tensioner_sheet:tensioner_sheet", "Find what a tensioner does to all belts."),
    Analysis(
        "sensitivity", "beltdyn.solve.sensitivity:sensitivity", "Find what results owe to each number of a drive."
    ),
    Analysis("modes", "beltdyn.solve.modes:modes", "Find the modes of a drive: frequencies, damping, shapes."),
    Analysis("optimize", "beltdyn.solve.optimize:optimize", "Find the numbers of a drive that are best for a goal."),
    Analysis("calibrate", "beltdyn.solve.calibrate:calibrate", "Fit numbers of a drive to measured results."),
    Analysis("campbell", "beltdyn.solve.campbell:campbell", "Find modes over speed, and critical speeds."),
    Analysis("response", "beltdyn.solve.response:response", "Find vibrations under harmonics, over speed."),
    # one line for each
)

STEADY_KINDS = ("map", "traction", "duty", "tensioner", "sensitivity", "modes", "campbell", "response")
"""Kinds of results about the belt at rest or in steady running on a mesh that stays."""

ANALYSES = {analysis.name: analysis for analysis in _ALL}
"""All analyses by name."""
