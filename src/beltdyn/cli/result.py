"""A result on the screen: its sheet, and its warnings."""

from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_facts, show_table, show_warnings

if TYPE_CHECKING:
    from beltdyn.results import Result


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
    for part in parts:
        show()
        if isinstance(part, Table):
            show_table(*part)
        else:
            show_facts(part.facts)
    if result.warnings and not (parts and not isinstance(parts[-1], Table)):
        show()
    show_warnings(result.warnings)
