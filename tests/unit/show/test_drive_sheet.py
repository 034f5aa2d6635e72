"""The tables of a drive sheet."""

import beltdyn as bd
from beltdyn.model import example
from beltdyn.show.sheet import Table, as_text, sheet


def test_tables_say_what_suppliers_say() -> None:
    result = bd.sheet(example("alternator_drive"), points=3)
    titles = [part.title for part in sheet(result).parts if isinstance(part, Table)]
    assert titles == [
        *("Pulleys", "Spans at rest", "Tensioner of tensioner", "Operating points"),
        "Tension N (peak, with acceleration and vibration)",
        "Hub load N (peak), direction, slip safety",
        "First modes, at the largest power, with sliding tensioners",
        "Belts of standard length",
    ]
    text = as_text(sheet(result))
    assert "mm of path per degree" in text
    assert f"{float(result.dataset.state_tension.sel(state='mean')):.1f}" in text
