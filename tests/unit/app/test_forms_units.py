"""Units of the page."""

import math
from typing import Any

import pytest

from beltdyn.app.forms import System, in_units, shown, unit_in, with_unit
from beltdyn.parts.quantity import to_si


@pytest.mark.parametrize(
    ("value", "si", "in_mm", "in_si"),
    [
        ("28 mm", "m", "28", "0.028"),
        (0.028, "m", "28", "0.028"),
        ("1.5 kg cm^2", "kg*m^2", "1.5", "0.00015"),
        (["140 mm", 0.085], "m", "140, 85", "0.14, 0.085"),
        (math.pi / 4, "rad", "45", "0.7853982"),
        ("300 N", "N", "300", "300"),
        ("5 bar", "Pa", "0.5", "500000"),
        ("12 ± 0.1 mm", "m", "12 ± 0.1 mm", "12 ± 0.1 mm"),  # a tolerance stays as it is given
        ("800 rpm clockwise", "rad/s", "800 rpm clockwise", "800 rpm clockwise"),
        ("28 kg", "m", "28 kg", "28 kg"),  # a wrong one is shown as it is
        (6, "", "6", "6"),
        (None, "m", "", ""),
    ],
)
def test_values_are_shown_in_the_units_of_the_page(value: Any, si: str, in_mm: str, in_si: str) -> None:
    assert (shown(value, si, "mm"), shown(value, si, "SI")) == (in_mm, in_si)


@pytest.mark.parametrize("system", ["mm", "SI"])
@pytest.mark.parametrize("si", ["m", "m^2", "m^3", "rad", "rad/s", "kg*m^2", "N/m", "Pa", "N", "N*m", "kg", "s"])
def test_what_is_typed_is_shown_again(si: str, system: System) -> None:
    text = with_unit("2.5", si, system)
    assert shown(text if unit_in(system, si).written else float(text), si, system) == "2.5"


def test_numbers_get_the_unit_of_the_page_and_units_stay() -> None:
    assert [with_unit(text, "m", "mm") for text in ("30", "-1.5e1", "30 cm", "wide")] == [
        *("30 mm", "-1.5e1 mm", "30 cm", "wide")
    ]
    assert with_unit("30", "m", "SI") == "30"
    assert to_si(with_unit("1500", "rad/s", "mm"), "rad/s") == pytest.approx(50.0 * math.pi)


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("the path is 0.75 m long", "the path is 750 mm long"),
        ("12 N m, 3 m/s, 9.81 m/s^2 and 5 N m/rad", "12 N m, 3 m/s, 9.81 m/s^2 and 5 N m/rad"),
        ("0.5 kg m^2 at 100 rad/s, 0.2 rad apart.", "5000 kg cm² at 954.93 rpm, 11.459 ° apart."),
        ("pulley[a2].radius = 0.05 m must", "pulley[a2].radius = 50 mm must"),
        ("beyond its stroke, -0.12 to 0.12 m. Shorten", "beyond its stroke, -120 to 120 mm. Shorten"),
        ("stroke = [-0.12, 0.12] m is longer", "stroke = [-120, 120] mm is longer"),
        ("at 0.5 or 1e-3 m; 3 belts and 2 m", "at 500 or 1 mm; 3 belts and 2000 mm"),
        (
            "radius = -0.05 must be greater than 0. Give the radius, in m; of a toothed one, teeth.",
            "radius = -50 must be greater than 0. Give the radius, in mm; of a toothed one, teeth.",
        ),
        (
            "width = 30.0 must be at most 2. Give the width, in m. Or 3 ribs.",
            "width = 30000 must be at most 2000. Give the width, in mm. Or 3 ribs.",
        ),
        ("ribs = 0 must be at least 1. Give the number.", "ribs = 0 must be at least 1. Give the number."),
        ("the radius, in m", "the radius, in mm"),
        ('"50 kg" must be in units of m, not "kg".', '"50 kg" must be in units of mm, not "kg".'),
        ("the torque, in N*m; none", "the torque, in N*m; none"),
    ],
)
def test_messages_have_the_units_of_the_page(sentence: str, shown: str) -> None:
    assert in_units(sentence, "mm") == shown
    assert in_units(sentence, "SI") == sentence
