"""The command of an analysis, made of its function: options, tables, warnings, and a result file."""

import re
from collections.abc import Callable
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter as Option

from beltdyn.analyses import Analysis
from beltdyn.cli.console import show, show_table, show_warnings
from beltdyn.cli.output import require_output

if TYPE_CHECKING:
    from beltdyn.results import Result

_OUTPUT = """
output
    The result file; by default the drive file's name with the name of the analysis.
force
    Replace other files than results too.
"""


def analysis_command(analysis: Analysis) -> Callable[..., None]:
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

    def command(file: Path, /, *, output: Path | None = None, force: bool = False, **options: Any) -> None:
        from beltdyn.model import load

        drive = load(file)
        path = output or file.with_name(f"{file.stem}-{analysis.name}.nc")
        require_output(path, (file,), csv=False, force=force)
        result = function(drive, **options)
        show_result(result)
        result.save(path, force)
        show(f"\nResults: {path}")

    own = [one for one in signature(function, eval_str=True).parameters.values() if one.kind is Parameter.KEYWORD_ONLY]
    common = [
        Parameter("file", Parameter.POSITIONAL_ONLY, annotation=Path),
        Parameter(
            "output", Parameter.KEYWORD_ONLY, default=None, annotation=Annotated[Path | None, Option(alias="-o")]
        ),
        Parameter("force", Parameter.KEYWORD_ONLY, default=False, annotation=Annotated[bool, Option(negative="")]),
    ]
    command.__signature__ = signature(command).replace(parameters=[*common, *own])  # type: ignore[attr-defined]
    command.__annotations__ = {one.name: one.annotation for one in (*common, *own)}
    command.__name__ = analysis.name
    command.__doc__ = _help(function)
    return command


def _help(function: Callable[..., Any]) -> str:
    """The docstring of a function of a drive as that of a command on a drive file."""
    text = cleandoc(function.__doc__ or "")
    summary, _, rest = text.partition("\n\nParameters\n----------\n")
    entries = re.split(r"\n(?=\S)", rest.partition("\n\n")[0])[1:]  # the first is the drive
    parameters = "\n".join(["file", "    The drive file, TOML.", *entries, _OUTPUT.strip()])
    return f"{summary}\n\nParameters\n----------\n{parameters}\n"


def show_result(result: "Result") -> None:
    """Write a table for each dimension along which single numbers stand, and the warnings.

    Parameters
    ----------
    result
        The result.
    """
    dataset = result.dataset
    for dimension in dataset.dims:
        columns = [variable for variable in dataset.data_vars.values() if variable.dims == (dimension,)]
        if columns:
            labels = [str(label) for label in dataset[dimension].values]
            rows = zip(labels, *([f"{value:.5g}" for value in column.values] for column in columns), strict=True)
            headings = (f"{column.attrs['long_name']}\n{column.attrs['units']}" for column in columns)
            show_table("", (str(dataset[dimension].attrs.get("long_name", dimension)), *headings), rows)
    show_warnings(result.warnings)
