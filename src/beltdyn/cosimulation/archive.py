"""Export of a drive as a functional mock-up unit (FMU)."""

import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any

from beltdyn.cosimulation.component import DRIVE_FILE, Component, Interface, choose_inputs, choose_outputs
from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps
from beltdyn.model.simulation import EarlierRun
from beltdyn.results.atomic import atomic_path, is_marked, require_replaceable
from beltdyn.solvers.run_progress import Report

_MAKERS = MappingProxyType({"2.0": ("pythonfmu", "beltdyn_fmi2"), "3.0": ("pythonfmu3", "beltdyn_fmi3")})
"""Package that makes units, and the module that a unit begins with, by the version of FMI."""

_ABILITIES = (
    "canHandleVariableCommunicationStepSize",
    *("canGetAndSetFMUstate", "canSerializeFMUstate", "canGetAndSetFMUState", "canSerializeFMUState"),
)
"""What units can do, as either version of FMI spells it."""


def fmu(
    drive: Drive,
    path: Path | str,
    inputs: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    fmi: str = "2.0",
    progress: Report | None = None,
    overwrite: bool = False,
) -> Path:
    """Export a drive as a functional mock-up unit (FMU) for co-simulation.

    The unit contains the drive as written by `dumps`, with the tables of its file, and a `Simulator`. The host needs a
    Python with beltdyn; see the page on FMUs.

    Parameters
    ----------
    drive : Drive
        The drive.
    path : Path or str
        The file, ``.fmu``.
    inputs : sequence of str, optional
        Inputs set by the host: ``pulley[NAME].speed`` of pulleys whose speed is prescribed, in rad/s, and
        ``pulley[NAME].torque`` of others, in N m. By default all that the drive file gives. Inputs that the host never
        sets keep their course in the drive file.
    outputs : sequence of str, optional
        Outputs read by the host: names of `Simulator.outputs`, or their part before the brackets, such as
        "pulley_speed" for all pulleys. By default all.
    fmi : str
        Version of FMI, "2.0" or "3.0".
    progress : callable, optional
        Called with a `Progress` while the initial state is computed.
    overwrite : bool
        Overwrite any regular file, not only those of beltdyn.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If a name or the version is unknown, the drive has Python functions or another integrator than
        "generalized_alpha", pythonfmu is missing, or the file cannot be written or would replace a file of another
        program.
    ConvergenceError
        If no initial state is found.

    Examples
    --------
    >>> bd.fmu(drive, "drive.fmu", ["pulley[driver].speed"], ["shaft_torque"]).name
    'drive.fmu'
    """
    path = Path(path)
    builder, module = _maker(fmi)
    if path.suffix != ".fmu":
        raise ModelError(f"{path} must end in .fmu. Rename it.")
    require_replaceable(path, is_marked, overwrite)
    text, settings = dumps(drive), drive.simulation
    if isinstance(settings.start, EarlierRun):
        raise ModelError(
            f"simulation.start = {settings.start}: a functional mock-up unit runs on other machines, which do "
            'not have that file. Set simulation.start = "equilibrium" or "steady".'
        )
    interface = Interface(
        title=drive.title,
        identifier=_identifier(path.stem),
        begin=settings.begin,
        end=settings.end,
        interval=settings.output_interval,
        tolerance=settings.rtol,
        inputs=choose_inputs(drive, inputs),
        outputs=choose_outputs(drive, outputs),
    )
    Component(drive, interface).begin(progress)  # what keeps it from beginning is told here
    with atomic_path(path, is_marked, overwrite) as temporary, TemporaryDirectory() as folder:
        drive_file = Path(folder, DRIVE_FILE)
        drive_file.write_text(text, encoding="utf-8")
        files = [drive_file, interface.write(Path(folder))]
        with _imports_undone():
            script = Path(__file__).with_name(f"{module}.py")
            made = builder.build_FMU(script, Path(folder, "made"), files, **dict.fromkeys(_ABILITIES, True))
        copyfile(made, temporary)
    return path


def _maker(fmi: str) -> tuple[Any, str]:
    """What builds units of a version of FMI, and the name of the module that they begin with."""
    if fmi not in _MAKERS:
        raise ModelError(f"fmi = {fmi!r} is not a supported FMI version. Choose 2.0 or 3.0.")
    package, module = _MAKERS[fmi]
    try:
        return import_module(package).FmuBuilder, module
    except ModuleNotFoundError:
        raise ModelError(
            f"{package} is not installed, but is needed for FMI {fmi}. Install beltdyn with its extra beltdyn[fmu]"
        ) from None


def _identifier(name: str) -> str:
    """A name of letters, digits and underscores, as that of a function in C."""
    kept = re.sub(r"\W", "_", name, flags=re.ASCII)
    return kept if kept[:1].isalpha() else f"drive_{kept}"


@contextmanager
def _imports_undone() -> Iterator[None]:
    """Leave paths and modules as they were: the packages that make units import the module of a unit by its path."""
    paths, modules = list(sys.path), set(sys.modules)
    try:
        yield
    finally:
        sys.path[:] = paths
        for name in set(sys.modules) - modules:
            if name in (module for _, module in _MAKERS.values()):
                del sys.modules[name]
