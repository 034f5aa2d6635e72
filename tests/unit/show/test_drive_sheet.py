"""The tables of a drive sheet."""

import beltdyn as bd
from beltdyn.model import example
from beltdyn.show.sheet import Table, as_text, sheet


def test_tables_say_what_suppliers_say() -> None:
    result = bd.sheet(example("alternator_drive"), points=3)
    titles = [part.title for part in sheet(result).parts if isinstance(part, Table)]
    assert titles == [
        *("Pulleys", "Tensioner of tensioner", "Belts of standard length", "Operating points"),
        "Largest tension N (peak, with acceleration and vibration)",
        "Hub load N (peak), direction, slip safety",
        "Spans at rest",
        "First modes, at the largest power, with sliding tensioners",
    ]
    text = as_text(sheet(result))
    assert "mm of path per degree" in text
    assert f"{float(result.dataset.state_tension.sel(state='mean')):.1f}" in text


def test_spans_have_what_alignment_allows_and_angles_if_pulleys_are_out_of_line() -> None:
    drive = example("alternator_drive")
    aligned, skewed = (
        next(part for part in sheet(bd.sheet(one, points=2)).parts if isinstance(part, Table) and "Spans" in part.title)
        for one in (drive, drive.with_({"pulley[alternator].tilt": ["0 ± 0.1 deg", "0.2 deg"]}))
    )
    words = [" ".join(heading.split()) for heading in skewed.headings]
    assert words[2:7] == ["tension mean N", "min N", "max N", "at start N", "at end N"]
    assert words[7:10] == ["deflection mm", "at rest Hz", "at rest N"]
    assert words[10:] == ["fleeting leaving", "angle reaching", "worst, with tolerances", "offset allowed mm"]
    assert [len(row) for row in aligned.rows] == [11] * 3
    less = [float(row[-1]) < float(other[-1]) for row, other in zip(skewed.rows, aligned.rows, strict=True)]
    assert less == [False, True, True]
