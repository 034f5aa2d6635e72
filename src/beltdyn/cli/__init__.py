"""The command line."""

from beltdyn.signals import begin_program, end_program

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence


def main(arguments: "Sequence[str] | None" = None) -> None:
    """Run the command line and exit.

    The exit code is 0 for success, 2 for bad input, 3 for a simulation that could not continue, 4 for warnings under
    --strict, 5 for an internal error, and for an interruption 128 plus the number of the signal: 130 for Ctrl-C.
    Linear algebra uses one thread unless OMP_NUM_THREADS says otherwise: the matrices are too small for more.
    """
    if arguments is None:
        begin_program()
    import os
    import sys

    from beltdyn.cli.app import run

    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if arguments is None:  # what processes import and run never comes from the working folder
        os.environ |= {"PYTHONSAFEPATH": "1", "NoDefaultCurrentDirectoryInExePath": "1"}
    code = run(arguments)
    if arguments is None:
        end_program()
    sys.exit(code)
