"""Figures and charts in HTML and SVG."""

import math
import re
from xml.etree import ElementTree

import pytest

from beltdyn.app.findings import Around, Column, Figure, Findings, Rows, Shape
from beltdyn.app.numbers_view import charts, number_in, tension_chart

AROUND = Around((0.0, 0.4, 0.6, 1.0), (100.0, 100.0, 300.0, 300.0), (("<fan>", 0.4, 0.6), ("motor", 0.9, 1.0)))


@pytest.mark.parametrize(
    ("value", "unit", "mm", "si"),
    [
        (1.514, "m", ("1514", "mm"), ("1.51", "m")),
        (2001.383, "m", ("2001383", "mm"), ("2001", "m")),
        (0.98801, "%", ("98.8", "%"), ("98.8", "%")),
        (2572.4, "W", ("2.57", "kW"), ("2.57", "kW")),
        (308.1, "W", ("308", "W"), ("308", "W")),
        (math.pi / 2, "rad", ("90", "°"), ("1.57", "rad")),
        (50 * math.pi, "rad/s", ("1500", "rpm"), ("157", "rad/s")),
        (math.nan, "N", ("–", ""), ("–", "")),
    ],
)
def test_numbers_are_in_the_units_of_the_page(
    value: float, unit: str, mm: tuple[str, str], si: tuple[str, str]
) -> None:
    assert (number_in(value, unit, "mm"), number_in(value, unit, "SI")) == (mm, si)


def test_the_tension_is_drawn_to_scale() -> None:
    """The axis begins at zero: a third of the tension is a third of the height."""
    svg = ElementTree.fromstring(tension_chart(AROUND, "mm"))
    line = next(one for one in svg.iter("path") if one.get("class") == "bd-line")
    points = [tuple(map(float, pair.split())) for pair in str(line.get("d"))[1:].split("L")]
    rules = {
        float(one.text or ""): float(str(one.get("y"))) - 3.5 for one in svg.iter("text") if one.text in ("0", "300")
    }
    assert points[-1][1] == pytest.approx(rules[300.0], abs=0.11)
    heights = [rules[0.0] - y for _, y in points]
    assert heights[0] / heights[-1] == pytest.approx(1 / 3, abs=0.005)
    assert (points[1][0] - points[0][0]) / (points[-1][0] - points[0][0]) == pytest.approx(0.4, abs=0.002)
    assert "1000 mm" in [one.text for one in svg.iter("text")]


def test_names_are_escaped_and_stand_once() -> None:
    svg = tension_chart(AROUND, "mm")
    assert svg.count("&lt;fan&gt;") == 1
    assert "<fan>" not in svg


def test_bars_are_as_long_as_their_numbers_and_low_ones_are_marked() -> None:
    rows = Rows("Pulleys", ("a", "b", "c"), (Column("slip safety", "", (0.5, 2.0, math.nan), 1.0),))
    found = charts(Findings(rows=(rows,)), "mm")
    assert re.findall(r'class="(bd-bar[^"]*)" style="width:(\d+)%"', found) == [
        ("bd-bar bd-low", "25"),
        ("bd-bar", "100"),
    ]
    assert 'class="bd-none">–' in found


def test_figures_come_first_and_modes_say_what_moves() -> None:
    shape = Shape(
        12.63, 0.0586, "rotational: <b>", (0.0, 0.0, 10.0, 5.0), "M0 0L1 1", "M0 0L2 1", ((1.0, 1.0, 0.5, 9.0),)
    )
    found = charts(Findings(figures=(Figure("lowest frequency", 12.63, "Hz"),), shapes=(shape,)), "mm")
    assert found.index("lowest frequency") < found.index("Mode shapes")
    assert "12.63<span> Hz" in found
    assert "damping ratio 5.86%" in found
    assert "rotational: &lt;b&gt;" in found
    assert charts(Findings(), "mm") == ""
