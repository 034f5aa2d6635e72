import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.parts.quantity import _USUAL, _registry, to_si, written_like


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("25 mm", "m", 0.025),
        ("81.25mm", "m", 0.08125),
        (" +1.5e1 cm ", "m", 0.15),
        ("720 rpm", "rad/s", 75.39822368615503),
        ("12 rad/s", "rad/s", 12.0),
        ("100 MPa", "Pa", 1e8),
        ("1.036 g/cm^3", "kg/m^3", 1036.0),
        ("1.036 g/cm³", "kg/m^3", 1036.0),
        ("10 N mm", "N*m", 0.01),
        ("10 N·mm", "N*m", 0.01),
        ("1e5 kg m^-1 s^-1", "kg/(m*s)", 1e5),
        ("1e5 kg/(m s)", "kg/(m*s)", 1e5),
        ("1 ms", "s", 1e-3),
        ("10 kN/m**2", "N/m^2", 1e4),
        ("-.5 m", "m", -0.5),
        ("12 Nm", "N*m", 12.0),
        ("1.2 kNm", "N*m", 1200.0),
        ("250 Nmm", "N*m", 0.25),
        ("0.3 Nm/rad", "N*m/rad", 0.3),
        ("720 U/min", "rad/s", 75.39822368615503),
        ("720 rev/min", "rad/s", 75.39822368615503),
        ("720 1/min", "rad/s", 75.39822368615503),
        ("720 min^-1", "rad/s", 75.39822368615503),
        ("720 min⁻¹", "rad/s", 75.39822368615503),
    ],
)
def test_units(text: str, unit: str, value: float) -> None:
    assert to_si(text, unit) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(("given_unit", "unit"), _USUAL)
def test_usual_units_are_those_of_the_library(given_unit: str, unit: str) -> None:
    expected = _registry().convert(3.7, given_unit, unit)
    assert to_si(f"3.7 {given_unit}", unit) == pytest.approx(expected, rel=1e-14)


def test_units_of_drive_engineers_are_added_without_a_word(caplog: pytest.LogCaptureFixture) -> None:
    """Nm is a unit of yarn in pint, which would tell each program that shows log messages of its redefinition."""
    _registry.cache_clear()
    assert to_si("12 Nm", "N*m") == 12.0
    assert caplog.messages == []


@given(st.text() | st.from_regex(r"[0-9]{1,3} ?[a-zA-Z*/^() 0-9.-]{1,20}", fullmatch=True))
def test_any_other_text_is_a_value_error(text: str) -> None:
    with contextlib.suppress(ValueError):
        to_si(text, "m")


@pytest.mark.parametrize(
    ("value", "like", "written"),
    [(0.0351, "35 mm", "35.1 mm"), (0.0351, 0.035, 0.0351), (0.035, "x mm", 0.035), (0.02, "1 nonsense", 0.02)],
)
def test_a_number_is_written_with_the_unit_of_another(value: float, like: object, written: float | str) -> None:
    assert written_like(value, like, "m") == written


def test_more_digits_are_written_where_they_are_asked_for() -> None:
    assert written_like(0.0123456789012, "1 mm", "m") == "12.34568 mm"
    assert written_like(0.0123456789012, "1 mm", "m", 10) == "12.3456789 mm"


@pytest.mark.parametrize(
    ("text", "like", "unit"),
    [
        *((text, "30 lbf ft", "N*m") for text in ("30 ft lb", "30 lb-ft", "30 ft-lbs", "30 lb ft")),
        ("10 oz in", "0.625 lbf in", "N*m"),
        ("30 lb", "30 lbf", "N"),
        ("5 lb/in", "5 lbf/in", "N/m"),
        ("30 lb", "30 pound", "kg"),
        ("120 kp", "120 kgf", "N"),
        ("10 PS", "7354.9875 kg m^2/s^3", "W"),
        ("300 fpm", "5 ft/s", "m/s"),
        ("8 kg cm2", "8 kg cm^2", "kg*m^2"),
        ("5 N/mm2", "5 MPa", "Pa"),
        ("35 °", "35 deg", "rad"),
    ],
)
def test_other_spellings_mean_the_same(text: str, like: str, unit: str) -> None:
    """Pounds are forces where a force is wanted."""
    assert to_si(text, unit) == pytest.approx(to_si(like, unit), rel=1e-12)


def test_a_decimal_comma_is_named() -> None:
    with pytest.raises(ValueError, match=r'decimal comma. Write "3.5 mm"'):
        to_si("3,5 mm", "m")
