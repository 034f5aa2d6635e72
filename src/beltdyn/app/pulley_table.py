"""A table of pulleys, from a CSV file or a spreadsheet, as a drive file."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from nicegui import ui
from nicegui.events import UploadEventArguments

from beltdyn.app.draft import draft
from beltdyn.app.placing import DRIVER, inertia_of_disk
from beltdyn.app.session import Document
from beltdyn.app.workspace import EMPTY
from beltdyn.errors import ModelError
from beltdyn.model.belt import read_side
from beltdyn.parts.quantity import is_unit, to_si
from beltdyn.parts.table_file import NUMERIC, decoded, row_of_units, rows_of
from beltdyn.parts.text_file import LONGEST_TABLE, parse_toml, shorten
from beltdyn.parts.toml_edits import Edit

EXAMPLE = """\
name, x [mm], y [mm], diameter [mm], side
crank, 0, 0, 160, inside
idler, 70, 140, 70, outside
alternator, 0, 270, 56, inside
"""
"""A table that can be read."""

_HEADING = re.compile(r"\s*(?P<what>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*")
_WITHOUT_HEADINGS = ("name", "x", "y", "diameter", "side")


class _Column(NamedTuple):
    key: str
    """What it gives."""
    si: str
    """Its SI unit; empty for texts."""
    usual: str
    """Unit of its numbers where neither heading nor a row of units gives one."""


_NAME, _SIDE = _Column("name", "", ""), _Column("side", "", "")
_X, _Y = _Column("x", "m", "mm"), _Column("y", "m", "mm")
_COLUMNS: Mapping[str, _Column] = MappingProxyType(
    {
        **dict.fromkeys(("name", "pulley", "item", "component"), _NAME),
        **dict.fromkeys(("x", "x center", "center x", "x position"), _X),
        **dict.fromkeys(("y", "y center", "center y", "y position"), _Y),
        **dict.fromkeys(("diameter", "effective diameter", "d", "dia", "od"), _Column("diameter", "m", "mm")),
        **dict.fromkeys(("radius", "r"), _Column("radius", "m", "mm")),
        **dict.fromkeys(("side", "belt side", "contact"), _SIDE),
        **dict.fromkeys(("inertia", "j"), _Column("inertia", "kg*m^2", "kg m^2")),
        **dict.fromkeys(("speed", "n"), _Column("speed", "rad/s", "rpm")),
        **dict.fromkeys(("torque", "load"), _Column("torque", "N*m", "N m")),
    }
)
_MAX_OUTSIDE_PULLEYS = 3
"""Pulleys on the back of the belt that are tried at most: the number of combinations grows steeply with them."""
_KNOWN = "name, x, y, diameter or radius, side, inertia, speed, torque"


def drive_from_table(text: str) -> str:
    """The text of a drive file whose pulleys are those of a table, in the order in which the belt meets them.

    Columns are found by their headings, in any order; lengths are in mm and speeds in rpm unless a heading or a row of
    units says otherwise. Without headings they are name, x, y, diameter and side. Where no side is given, as few
    pulleys are on the back of the belt as its path needs. Without speeds the first pulley drives.

    Raises
    ------
    ModelError
        With the line that cannot be read.
    """
    try:
        rows = rows_of(text).rows
    except ValueError as error:
        raise ModelError(f"the table {error}.") from error
    if not rows:
        raise ModelError("the table is empty. Paste lines such as those of the example.")
    columns, lines = _headed([cell.strip() for cell in rows[0].cells], rows)
    pulleys = [_pulley(columns, row.line, row.cells) for row in lines]
    if not any("side" in one for one in pulleys):
        for number in _on_back(pulleys):
            pulleys[number]["side"] = "outside"
    document = Document(EMPTY)
    drives = any("speed" in one for one in pulleys)
    edits = [
        Edit("insert", ("pulley", place), _completed(one, place == 0 and not drives))
        for place, one in enumerate(pulleys)
    ]
    document.apply(edits)
    return document.text


def _headed(first: Sequence[str], rows: Sequence[Any]) -> tuple[list[tuple[_Column, str] | None], Sequence[Any]]:
    """The columns with their units, and the lines below headings and units."""
    if sum(bool(NUMERIC.match(cell)) for cell in first) >= 2:
        return [(_COLUMNS[key], _COLUMNS[key].usual) for key in _WITHOUT_HEADINGS[: len(first)]], rows
    rows = rows[1:]
    units = row_of_units(rows[0].cells) if rows else None
    columns = list[tuple[_Column, str] | None]()
    for place, cell in enumerate(first):
        match = _HEADING.fullmatch(cell)
        column = _COLUMNS.get(match["what"].lower().replace("_", " ")) if match else None
        given = (match["unit"] if match else "") or (units[place] if units and place < len(units) else "")
        if column is not None and column.si and given and not is_unit(given):
            raise ModelError(f'the unit "{shorten(given)}" below "{shorten(cell)}" is unknown. Write for example "mm".')
        columns.append(None if column is None else (column, given or column.usual))
    known = {one[0].key for one in columns if one is not None}
    missing = [key for key in ("x", "y") if key not in known]
    if missing or not known & {"diameter", "radius"}:
        lacks = " and ".join([*missing, *(["diameter"] if not known & {"diameter", "radius"} else [])])
        raise ModelError(f"the table has no column {lacks}. Its first line must name columns: {_KNOWN}.")
    return columns, rows[1:] if units else rows


def _pulley(columns: Sequence[tuple[_Column, str] | None], line: int, cells: Sequence[str]) -> dict[str, Any]:
    """A line of the table as keys of a pulley, with x and y apart."""
    found = dict[str, Any]()
    for column, cell in zip(columns, cells, strict=False):
        if column is None or not cell.strip():
            continue
        (key, si, _), unit = column
        found[key] = _number(line, key, cell.strip(), si, unit) if si else cell.strip()
    for key in ("x", "y", "diameter"):
        if key not in found and not (key == "diameter" and "radius" in found):
            raise ModelError(f"line {line} of the table has no {key}. Complete the line.")
    if "side" in found:
        found["side"] = read_side(found["side"])
        if found["side"] not in ("inside", "outside"):
            raise ModelError(
                f'line {line} of the table: side = "{shorten(found["side"])}" must be "inside" or "outside", the back '
                "of the belt. Correct this line."
            )
    return {"name": f"pulley {line}", **found}


def _number(line: int, key: str, cell: str, si: str, unit: str) -> str:
    """A cell as text with its unit."""
    text = f"{cell} {unit}" if re.fullmatch(r"[-+\d.eE]+", cell) else cell
    try:
        if not math.isfinite(to_si(text, si)):
            raise ValueError("must be a finite number")
    except ValueError as error:
        raise ModelError(f'line {line} of the table: {key} = "{shorten(cell)}" {error}. Correct this line.') from error
    return text


def _on_back(pulleys: Sequence[Mapping[str, Any]]) -> tuple[int, ...]:
    """Numbers of the fewest pulleys on the back with which a belt runs around all; none if no such are found."""
    data = parse_toml(EMPTY)
    for count in range(min(len(pulleys), _MAX_OUTSIDE_PULLEYS) + 1):
        for chosen in combinations(range(len(pulleys)), count):
            tried = [{**one, **({"side": "outside"} if place in chosen else {})} for place, one in enumerate(pulleys)]
            completed = [_completed(one, place == 0) for place, one in enumerate(tried)]
            if draft({**data, "pulley": completed}, Path(), only_laid_out=True).drive is not None:
                return chosen
    return ()


def _radius(one: Mapping[str, Any]) -> float:
    return to_si(one["radius"], "m") if "radius" in one else 0.5 * to_si(one["diameter"], "m")


def _completed(one: Mapping[str, Any], drives: bool) -> dict[str, Any]:
    """A pulley of a drive file: driven ones turn freely, with the inertia of an aluminum disk where none is given."""
    pulley = {key: one[key] for key in ("name",)} | {"center": [one["x"], one["y"]]}
    pulley |= {key: one[key] for key in ("diameter", "radius", "side", "inertia") if key in one}
    if pulley.get("side") == "inside":
        del pulley["side"]
    if drives or "speed" in one:
        return pulley | {"speed": DRIVER | {"value": one.get("speed", DRIVER["value"])}}
    if "torque" in one:
        pulley["torque"] = {"kind": "constant", "value": one["torque"]}
    return pulley if "inertia" in pulley else pulley | {"inertia": inertia_of_disk(_radius(one))}


_ABOUT = (
    "Paste cells of a spreadsheet, or choose a CSV file: a line for each pulley, in the order in which the belt meets "
    "them. Lengths are in mm unless a heading or a row of units says otherwise; further columns are inertia, speed and "
    "torque."
)


class TableDialog:
    """Opens at once; `begin` is called with the text of the drive file."""

    def __init__(self, begin: Callable[[str], None]) -> None:
        self._begin = begin
        with ui.dialog(value=True) as self._dialog, ui.card().classes("bd-dialog"):
            ui.label("Drive from a table of pulleys").classes("bd-heading-plain")
            ui.label(_ABOUT).classes("bd-state")
            self._table = ui.textarea(placeholder=EXAMPLE).classes("w-full bd-code").mark("pasted")
            self._table.props('outlined autofocus rows=9 aria-label="table of pulleys"')
            self._told = ui.label().classes("bd-message").mark("wrong-table")
            self._told.set_visibility(False)
            with ui.row().classes("w-full items-center gap-2"):
                ui.button("Use", on_click=self._use).props("no-caps unelevated").mark("use-table")
                ui.button("Cancel", on_click=self._dialog.close).props("flat no-caps")
                ui.space()
                file = ui.upload(on_upload=self._read, auto_upload=True, max_file_size=LONGEST_TABLE)
                file.props('accept=".csv,.txt,.tsv"').classes("hidden").mark("table-file")
                pick = ui.button("CSV file …", icon="upload_file", on_click=lambda: file.run_method("pickFiles"))
                pick.props("flat no-caps")
        self._dialog.on("hide", self._dialog.delete)

    async def _read(self, event: UploadEventArguments) -> None:
        try:
            self._table.value = decoded(await event.file.read())
            self._told.set_visibility(False)
        except UnicodeDecodeError:
            self._say(f"{event.file.name} is not a text file. Save it as CSV in UTF-8.")

    def _use(self) -> None:
        try:
            text = drive_from_table(self._table.value or "")
        except ModelError as error:
            self._say(str(error))
            return
        self._dialog.close()
        self._begin(text)

    def _say(self, wrong: str) -> None:
        self._told.text = wrong
        self._told.set_visibility(True)
