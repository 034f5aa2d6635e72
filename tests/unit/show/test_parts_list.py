"""The parts list: the belt as it is ordered, and pulleys as they are supplied."""

from typing import Any

import pytest

from beltdyn.model import example, loads, prepare
from beltdyn.show.parts_list import parts_list
from beltdyn.show.tables import Facts, Table

_TWO_PULLEYS = """
[belt]
{belt}

[[pulley]]
name = "motor"
center = [0, 0]
{motor}
speed = "1485 rpm"

[[pulley]]
name = "fan"
center = ["{distance} mm", 0]
{fan}
inertia = "1 kg m^2"

[sheet]
customer = "Mill"
"""


def listed(text: str, **sizes: Any) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    facts, table = parts_list(prepare(loads(text.format(**sizes))))
    assert isinstance(facts, Facts)
    assert isinstance(table, Table)
    headings = [" ".join(heading.split()) for heading in table.headings[1:]]
    return dict(facts.facts), {row[0]: dict(zip(headings, row[1:], strict=True)) for row in table.rows}


def test_v_belts_have_datum_and_outside_diameters_and_catalogue_face_widths() -> None:
    """A published drive: 8 belts SPB 4000 on 280 and 500 mm; DIN 2211 has 158 mm for 8 grooves, and 3.5 mm above."""
    facts, pulleys = listed(
        _TWO_PULLEYS,
        belt='profile = "SPB"\nribs = 8\nnominal_length = "4000 mm"',
        motor='diameter = "280 mm"',
        fan='diameter = "500 mm"',
        distance=1383.5,
    )
    assert facts["customer"] == "Mill"
    assert facts["to order"] == "8 × SPB 4000, datum length 4000 mm"
    assert facts["standard length"] == "yes"
    assert pulleys["motor"] == {
        "diameter mm": "280.00",
        "kind": "datum",
        "pitch diameter mm": "280.00",
        "outside diameter mm": "287",
        "grooves": "8",
        "face width mm": "158",
    }
    assert pulleys["fan"]["outside diameter mm"] == "507"


@pytest.mark.parametrize(
    ("profile", "grooves", "width"),
    [("SPZ", 3, 40), ("SPA", 6, 95), ("SPC", 8, 212.5), ("XPC", 4, 110.5), ("Z", 2, 28), ("D", 10, 381)],
)
def test_face_widths_are_those_printed_in_catalogues(profile: str, grooves: int, width: float) -> None:
    """Of the table of DIN 2211 and DIN 2217 that Optibelt prints, and of its computed SPC 400-8."""
    small = {"D": 355, "SPC": 224, "XPC": 224}.get(profile, 160)
    belt = f'profile = "{profile}"\nribs = {grooves}\ninstalled_tension = "1 kN"'
    diameter = f'diameter = "{small} mm"'
    _, pulleys = listed(_TWO_PULLEYS, belt=belt, motor=diameter, fan=diameter, distance=5 * small)
    assert float(pulleys["motor"]["face width mm"]) == width


def test_toothed_and_other_belts_are_named_by_what_they_are_sold_by() -> None:
    facts, pulleys = listed(
        _TWO_PULLEYS,
        belt='profile = "HTD 5M"\nteeth = 120\nwidth = "15 mm"',
        motor="teeth = 20",
        fan="teeth = 40",
        distance=225,
    )
    assert facts["to order"] == "1 × HTD 5M, 120 teeth, 600 mm long, 15 mm wide"
    assert pulleys["motor"]["teeth"] == "20"
    assert "face width mm" not in pulleys["motor"]
    flat, _ = listed(
        _TWO_PULLEYS,
        belt='profile = "flat-polyamide"\nwidth = "50 mm"\nnominal_length = "2000 mm"',
        motor='diameter = "100 mm"',
        fan='diameter = "150 mm"',
        distance=805,
    )
    assert flat["to order"] == "1 × flat-polyamide, 50 mm wide, inside length 2000 mm"
    material = parts_list(prepare(example("two_pulley")))[0]
    assert isinstance(material, Facts)
    assert "long without tension" in dict(material.facts)["belt"]


def test_a_computed_length_is_told_from_a_standard_one() -> None:
    facts, pulleys = listed(
        _TWO_PULLEYS,
        belt='profile = "PK"\nribs = 6\ninstalled_tension = "800 N"',
        motor='diameter = "160 mm"',
        fan='diameter = "120 mm"',
        distance=503,
    )
    assert facts["standard length"].startswith("no; the next ones are ")
    assert pulleys["motor"]["pitch diameter mm"] == "163.00"
    assert pulleys["motor"]["grooves"] == "6"
    assert facts["to order"].startswith("1 × PK ")
    assert "6 ribs, effective length" in facts["to order"]
