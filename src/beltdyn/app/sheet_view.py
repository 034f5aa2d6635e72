"""Tables and facts of a sheet on the page."""

from collections.abc import Iterable, Sequence
from html import escape

from nicegui import ui

from beltdyn.results.sheet_parts import Facts, Table


def show_parts(parts: Iterable[Table | Facts]) -> None:
    """Show the parts of a sheet one below the other."""
    for part in parts:
        if part.title:
            ui.label(part.title).classes("text-weight-medium q-mt-sm")
        ui.html(table_html(part), sanitize=False).classes("bd-tables")


def table_html(part: Table | Facts) -> str:
    """A table or facts as HTML; all text is escaped."""
    if isinstance(part, Table):
        head, rows, kind = f"<thead>{_row('th', part.headings)}</thead>", part.rows, "bd-table"
    else:
        head, rows, kind = "", part.facts, "bd-table bd-facts"
    return f'<table class="{kind}">{head}<tbody>{"".join(_row("td", row) for row in rows)}</tbody></table>'


def _row(tag: str, cells: Sequence[str]) -> str:
    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"
