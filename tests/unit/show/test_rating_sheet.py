"""The tables of a rating: verdict first, then checks, parts and loads."""

import beltdyn as bd
from beltdyn.model import example
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Facts, Table, as_text


def test_the_verdict_comes_first_and_checks_have_units() -> None:
    result = bd.rating(example("alternator_drive"), service_factor=1.2)
    shown = sheet(result)
    first, checks = shown.parts[:2]
    assert isinstance(first, Facts)
    assert first.facts == (("verdict", str(result.dataset.attrs["verdict"])),)
    assert isinstance(checks, Table)
    rows = {row[0]: row[1:] for row in checks.rows}
    used = 100.0 * result.dataset.largest_utilization.item()
    assert rows["utilization of the rated power"] == (f"{used:.4g}", "at most", "100", "%", "met")
    assert rows["smallest pulley"][3] == "mm"
    assert "Pulleys as supplied" in as_text(shown)
    pulleys = next(part for part in shown.parts if isinstance(part, Table) and part.title == "Pulleys")
    hub = next(number for number, heading in enumerate(pulleys.headings) if heading.split() == ["Hub", "load", "N"])
    assert float(pulleys.rows[0][hub]) == round(float(result.dataset.hub_load[0]), 1)
