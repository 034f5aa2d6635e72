"""The command `beltdyn`, and how it reports errors."""

import shlex
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Final

from cyclopts import App, CycloptsError, UnknownCommandError, UnusedCliTokensError

from beltdyn import __version__
from beltdyn.analyses import ANALYSES, Analysis
from beltdyn.cli.analysis import analysis_command
from beltdyn.cli.catalogue import catalogue, select
from beltdyn.cli.check import check
from beltdyn.cli.console import show_error, take_any_terminal
from beltdyn.cli.new import keys, new, schema
from beltdyn.cli.services import app as page
from beltdyn.cli.services import compile_, fmu
from beltdyn.cli.show import demo, export, plot, report
from beltdyn.cli.study import study
from beltdyn.errors import classified
from beltdyn.signals import ending_in_order, exit_code, interrupted

_BAD_INPUT_EXIT_CODE = 2
"""Exit code for bad input, also for a command line that is not understood, as usual for shell commands."""

app = App(
    name="beltdyn",
    version=__version__,
    help="Simulate belt drives: speeds, torques, tensions, slip and contact forces, from one drive file.",
    help_epilogue="Start with `beltdyn demo`, or `beltdyn new`, `beltdyn check drive.toml` and "
    "`beltdyn simulate drive.toml`.",
    suppress_keyboard_interrupt=False,
)
_COMMANDS: tuple[Callable[..., object] | Analysis, ...] = (
    *(new, select, check),
    *ANALYSES.values(),
    *(study, plot, report, export, fmu, page, demo, catalogue, keys, schema, compile_),
)
for position, one in enumerate(_COMMANDS):
    if isinstance(one, Analysis):
        app.command(App(name=one.command, help=one.purpose, sort_key=position))
    else:
        app.command(one, sort_key=position)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line: its exit code, see `beltdyn.cli.main`."""
    warnings.formatwarning = _warning_line
    take_any_terminal()
    with ending_in_order():
        try:
            return _exit_code(arguments)
        except KeyboardInterrupt:  # again, while it was reported
            return exit_code()


def _exit_code(arguments: Sequence[str] | None) -> int:
    try:
        words = sys.argv[1:2] if arguments is None else arguments[:1]
        for one in (one for one in ANALYSES.values() if one.command in words):
            if app[one.command].default_command is None:  # its function is imported here, where it is used
                app[one.command].default(analysis_command(one))
                app[one.command].help = None  # that of the function says more
        action: Final = "return_int_as_exit_code_else_zero"
        return app(arguments, print_error=False, exit_on_error=False, result_action=action) or 0
    except CycloptsError as error:
        show_error(_usage(error))
        return _BAD_INPUT_EXIT_CODE
    except OSError as error:
        show_error(f"{error.filename or 'a file'} cannot be read or written: {error.strerror or error}.")
        return _BAD_INPUT_EXIT_CODE
    except Exception as error:
        if not interrupted():
            told = classified(error, shlex.join(["beltdyn", *(sys.argv[1:] if arguments is None else arguments)]))
            show_error(str(told))
            return told.exit_code
    except KeyboardInterrupt:
        pass
    show_error("interrupted")  # which other code may have taken for an error
    return exit_code()


_with_source = warnings.formatwarning


def _warning_line(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, line: str | None = None
) -> str:
    """A warning of ours without the line of the source that it comes from, which says nothing to a user."""
    if category.__module__.startswith("beltdyn."):
        return f"warning: {message}\n"
    return _with_source(message, category, filename, lineno, line)


_MEANT = {"run": "simulate", "solve": "simulate", "tension": "tensioner-sheet", "figure": "plot"}
"""Commands by other words for them."""


def _usage(error: CycloptsError) -> str:
    """What is wrong with the words of a command."""
    command = " ".join(("beltdyn", *(error.command_chain or ())))
    if isinstance(error, UnusedCliTokensError):
        words = ", ".join(f'"{word}"' for word in error.unused_tokens or ())
        return f"{command} takes no argument {words}. See {command} --help."
    if isinstance(error, UnknownCommandError) and error.unused_tokens:
        word = error.unused_tokens[0]
        named = [name for name in app.resolved_commands() if word in (*name.split("-"), name[: len(word)])]
        meant = _MEANT.get(word, named[0] if len(named) == 1 else None)
        if meant is not None:
            return f'Unknown command "{word}". Did you mean "{meant}"? See beltdyn --help.'
    return str(error)
