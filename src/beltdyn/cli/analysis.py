"""Make the command of an analysis from its function: options, progress, tables, warnings and result files."""

import re
from collections.abc import Callable
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Annotated, Any, Union

from cyclopts import Parameter as Option
from cyclopts.validators import Number

from beltdyn.analyses import Analysis
from beltdyn.cli.output import Extras, analyse_to, doubt, ended, require_output
from beltdyn.cli.study import analyse_several, read_given, takes_runs
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Run

_TYPED = str, float, int, bool, Path, NoneType
"""Types that a word of a command line gives."""

_ABOUT = """
Several drives are computed in parallel on all cores. Ctrl-C, or a termination signal, ends the command and keeps the
results computed so far. Earlier results are replaced, but no other files.
"""

_PARAMETERS = """
output
    The result file; by default {file}, beside the drive file. For several drives, the folder of the result files.
jobs
    The number of drives to compute at a time; by default the number of cores.
csv
    Also write plain tables, to the folder FILE-tables beside the result file.
report
    Also write a report, one HTML page beside the result file, to read, mail and print.
strict
    Treat warnings as errors: exit with code 4 if there are any. The results are kept.
force
    Also replace files that beltdyn did not write.
"""


def analysis_command(analysis: Analysis) -> Callable[..., int]:
    """Make the command of an analysis: keyword arguments become options, the docstring its help."""
    from beltdyn.parts.options import options_of

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
                raise ModelError(f"A resumed run continues in its own file {file}, not in {output}. Omit --output.")
            drive, path, files = open_result(file).drive, file, ()
        else:
            drive, path = read_given(analysis, file), output or analysis.result_file(file)
        require_output(path, files, extras, force)
        result = analyse_to(analysis, drive, path, extras, force, **options)
        return ended(result) or (doubt(result.warnings) if strict else 0)

    own = {name: one.replace(annotation=_in_words(one.annotation)) for name, one in options_of(function).items()}
    common = [one for one in signature(command).parameters.values() if one.kind is not Parameter.VAR_KEYWORD]
    parameters = [*common[:2], *own.values(), *common[2:]]
    command.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {one.name: one.annotation for one in parameters}
    command.__name__ = analysis.name
    command.__doc__ = _help(analysis, own)
    return command


def _in_words(annotation: Any) -> Any:
    """The type of an option, without what no word of a command line gives: arrays, results and studies.

    Numbers may be words with a unit, such as "1 %", which the schema of options reads.
    """
    from beltdyn.parts.options import option_types

    return Union[tuple(one for one in option_types(annotation) if one in _TYPED)]  # noqa: UP007


def _help(analysis: Analysis, own: dict[str, Parameter]) -> str:
    """The docstring of a function of a drive as that of a command on drive files."""
    text = cleandoc(analysis.function.__doc__ or "")
    summary, _, rest = text.partition("\n\nParameters\n----------\n")
    entries = [entry for entry in re.split(r"\n(?=\S)", rest.partition("\n\n")[0]) if entry.partition("\n")[0] in own]
    shared = _PARAMETERS.strip().format(file=analysis.result_file(Path("FILE.toml")))
    run = " Or the result file of a run, whose drive is used." if takes_runs(analysis) else ""
    files = ["file", f"    The drive file, TOML.{run}", "more", "    More drive files."]
    return f"{summary}\n{_ABOUT}\nParameters\n----------\n" + "\n".join([*files, *entries, shared]) + "\n"
