"""The command of an analysis, made of its function: options, progress, tables, warnings, and result files."""

import re
from collections.abc import Callable
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Union, get_args

from cyclopts import Parameter as Option
from cyclopts.validators import Number

from beltdyn.analyses import Analysis
from beltdyn.cli.batch import analyse_several
from beltdyn.cli.given import read_given, takes_runs
from beltdyn.cli.output import Extras, analyse_to, doubt, ended, require_output
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Run

SHARED = ("output", "progress", "overwrite", "start")
"""Parameters of functions that every command fills in itself, or leaves alone."""

_ABOUT = """
Several drives are computed side by side on all cores. Ctrl-C, or the signal to terminate, ends the command and keeps
what was computed. Earlier results are replaced, and no other files.
"""

_PARAMETERS = """
output
    The result file; by default {file}, beside the drive file. Of several drives, the folder for these.
jobs
    How many drives to compute at a time; by default as many as there are cores.
csv
    Write plain tables too, into a folder beside the result file, named after it with -tables.
report
    Write a report too: a page beside the result file, to mail, to look at and to print.
strict
    End with an error (exit code 4) where a warning makes results doubtful; they are kept.
force
    Replace other files too.
"""


def analysis_command(analysis: Analysis) -> Callable[..., int]:
    """Make the command of an analysis.

    Parameters
    ----------
    analysis
        The analysis; the keyword arguments of its function become options.

    Returns
    -------
    callable
        The command, with the help of the function in its docstring.
    """
    function = analysis.function

    def command(
        file: Path,
        /,
        *more: Path,
        output: Annotated[Path | None, Option(alias="-o")] = None,
        jobs: Annotated[int | None, Option(alias="-j", validator=Number(gte=1))] = None,
        csv: Annotated[bool, Option(negative="")] = False,
        report: Annotated[bool, Option(negative="")] = False,
        strict: Annotated[bool, Option(negative="")] = False,
        force: Annotated[bool, Option(negative="")] = False,
        **options: Any,
    ) -> int:
        files: tuple[Path, ...] = (file, *more)
        extras = Extras(csv, report)
        if more:
            return analyse_several(analysis, files, output, jobs, extras, strict=strict, force=force, **options)
        from beltdyn.results import open_result
        from beltdyn.results.atomic import target_of
        from beltdyn.results.dataset import is_result

        drive: Drive | Run
        if options.get("resume") and is_result(file):
            if output is not None and target_of(output) != target_of(file):
                raise ModelError(f"{file} goes on in its own file, and not in {output}. Leave --output out.")
            drive, path, files = open_result(file).drive, file, ()
        else:
            drive, path = read_given(analysis, file), output or analysis.result_file(file)
        require_output(path, files, extras, force)
        result = analyse_to(analysis, drive, path, extras, force, **options)
        return ended(result) or (doubt(result.warnings) if strict else 0)

    own = {
        name: one.replace(kind=Parameter.KEYWORD_ONLY, annotation=_in_words(one.annotation))
        for name, one in signature(function, eval_str=True).parameters.items()
        if one.kind is Parameter.KEYWORD_ONLY and name not in SHARED
    }
    common = [one for one in signature(command).parameters.values() if one.kind is not Parameter.VAR_KEYWORD]
    parameters = [*common[:2], *own.values(), *common[2:]]
    command.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {one.name: one.annotation for one in parameters}
    command.__name__ = analysis.name
    command.__doc__ = _help(analysis, own)
    return command


def _in_words(annotation: Any) -> Any:
    """The type of an option, without results and studies in a union, which no word of a command line gives."""
    from beltdyn.parts.part import Part
    from beltdyn.results import Result

    kept = [one for one in get_args(annotation) if not (isinstance(one, type) and issubclass(one, (Result, Part)))]
    return Union[tuple(kept)] if isinstance(annotation, UnionType) else annotation  # noqa: UP007


def _help(analysis: Analysis, own: dict[str, Parameter]) -> str:
    """The docstring of a function of a drive as that of a command on drive files."""
    text = cleandoc(analysis.function.__doc__ or "")
    summary, _, rest = text.partition("\n\nParameters\n----------\n")
    entries = [entry for entry in re.split(r"\n(?=\S)", rest.partition("\n\n")[0]) if entry.partition("\n")[0] in own]
    shared = _PARAMETERS.strip().format(file=analysis.result_file(Path("FILE.toml")))
    run = " Or the result file of a run, which stands for its drive." if takes_runs(analysis) else ""
    files = ["file", f"    The drive file, TOML.{run}", "more", "    More of them."]
    return f"{summary}\n{_ABOUT}\nParameters\n----------\n" + "\n".join([*files, *entries, shared]) + "\n"
