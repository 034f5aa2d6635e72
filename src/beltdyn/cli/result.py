"""A result on the screen: its sheet, and its warnings."""

from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_facts, show_table, show_warnings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from beltdyn.results import Result
    from beltdyn.results.sheet_parts import Facts, Table


def show_result(result: "Result") -> None:
    """Write tables and facts of a result: 100 columns, and as few lines as a drive of seven pulleys needs to fit.

    Parameters
    ----------
    result
        The result.
    """
    from beltdyn.results.sheet import sheet
    from beltdyn.results.sheet_parts import Table

    title, parts = sheet(result)
    if title:
        show(f"\n{title}")
    if parts:
        show()
    show_parts(parts)
    if result.warnings and not (parts and not isinstance(parts[-1], Table)):
        show()
    show_warnings(result.warnings)


def show_parts(parts: "Sequence[Table | Facts]") -> None:
    """Write the parts of a sheet, with a line between."""
    from beltdyn.results.sheet_parts import Table

    for number, part in enumerate(parts):
        if number:
            show()
        if isinstance(part, Table):
            show_table(*part)
        else:
            if part.title:
                show(part.title)
            show_facts(part.facts)
