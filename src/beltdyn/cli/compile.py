"""`beltdyn compile`."""

from pathlib import Path

from beltdyn.cli.console import show
from beltdyn.cli.progress import compilation_bar

_USUAL = ("alternator_drive",)
"""Examples that need the kernels of most drives."""
_SHORT = 0.01
"""Time of a run that compiles what all runs need, s."""


def compile_(*files: Path) -> None:
    """Compile kernels in advance, once on this machine, so that later commands start at once.

    Parameters
    ----------
    files
        Drive files, such as those with laws of your own; by default the kernels of usual drives are compiled.
    """
    from beltdyn.kernel import kernel_cache
    from beltdyn.model import example, load
    from beltdyn.state.installation import bring_to_rest
    from beltdyn.transient.simulate import simulate
    from beltdyn.vibration.modes import modes

    drives = [load(file) for file in files] or [example(name) for name in _USUAL]
    with compilation_bar():
        for drive in drives:
            outputs = {"output_interval": None, "field_interval": None, "start_at": None}
            short = drive.replace(simulation=drive.simulation.replace(duration=_SHORT, **outputs))
            simulate(short)
            bring_to_rest(drive)
            modes(drive)
    show(f"Kernels are compiled: {kernel_cache()}")
