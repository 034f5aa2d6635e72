"""Fatigue data of belts: the S-N line of cords, and the law of rib fatigue."""

from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, CordFatigue, RibFatigue, read_catalogue

LINE: dict[str, Any] = {"cycles": [1e7, 1e8, 1e10], "forces": [500.0, 300.0, 200.0], "bending_force": 12.0}
LAW: dict[str, Any] = {"diameter": "50 mm", "tension": 100.0, "temperature": "80 °C"}
POUND, INCH = 4.4482216, 0.0254


def line(**changes: Any) -> CordFatigue:
    return CordFatigue(**LINE | {"source": "test"} | changes)


def law(**changes: Any) -> RibFatigue:
    return RibFatigue(**LAW | {"source": "test"} | changes)


def sold(**keys: Any) -> Belt:
    return Belt.model_validate({"installed_tension": 300.0} | keys)


def test_an_s_n_line_passes_through_its_points_and_is_straight_over_logarithms() -> None:
    np.testing.assert_allclose(line().cycles_to_failure([500.0, 300.0, 200.0]), [1e7, 1e8, 1e10])
    np.testing.assert_allclose(line().cycles_to_failure(np.sqrt([500.0 * 300.0, 300.0 * 200.0])), [10**7.5, 1e9])


def test_beyond_its_points_it_continues_the_last_pieces() -> None:
    steep, flat = (np.log10(ratio) for ratio in (500.0 / 300.0, 300.0 / 200.0))
    np.testing.assert_allclose(line().cycles_to_failure([600.0]), 1e7 * (600.0 / 500.0) ** (-1.0 / steep))
    np.testing.assert_allclose(line().cycles_to_failure([100.0]), 1e10 * (100.0 / 200.0) ** (-2.0 / flat))
    assert line().cycles_to_failure(0.0) == np.inf


@pytest.mark.parametrize(("exponent", "force"), [(0.0, 400.0), (1.0, 300.0), (0.5, np.sqrt(400.0 * 300.0))])
def test_cycles_count_by_their_largest_force_and_their_range(exponent: float, force: float) -> None:
    """Walker: the largest force alone, the range alone, or as Smith, Watson and Topper."""
    assert line(range_exponent=exponent).equivalent_force(100.0, 400.0) == pytest.approx(force)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"forces": [500.0, 300.0]}, "cycles has 3 numbers but forces has 2"),
        ({"cycles": [1e7, 1e7, 1e8]}, "cycles must increase"),
        ({"forces": [500.0, 500.0, 200.0]}, "forces must decrease, but 500 N follows 500 N"),
        ({"forces": [500.0, 300.0, 0.0]}, "must be positive"),
        ({"range_exponent": 2.0}, "range_exponent"),
        ({"survival": 1.0}, "survival"),
        ({"source": " "}, "source"),
    ],
)
def test_what_is_no_s_n_line(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        line(**changes)


def test_a_line_needs_a_source() -> None:
    with pytest.raises(ModelError, match="source"):
        CordFatigue(**LINE)


def test_exponents_of_rib_fatigue() -> None:
    """d^-5.6 (14 % more diameter doubles the life), T^1.13, half the life for 23 K, and 0.3 for the back."""
    reference = law().passages_at(100.0, 0.05)
    assert reference == 1.0
    assert law().passages_at(100.0, 0.10) == pytest.approx(2.0**-5.6, rel=1e-14)
    assert 1.0 / law().passages_at(100.0, 1.14 * 0.05) == pytest.approx(2.0, rel=0.05)
    assert law().passages_at(200.0, 0.05) == pytest.approx(2.0**1.13, rel=1e-14)
    assert law().passages_at(100.0, 0.05, 103.0) == pytest.approx(2.0, rel=1e-14)
    assert law().passages_at(100.0, 0.05, 57.0) == pytest.approx(0.5, rel=1e-14)
    np.testing.assert_allclose(law().passages_at(100.0, [0.05, 0.05], 80.0, ["outside", "inside"]), [0.3, 1.0])
    assert law().passages_at(-1.0, 0.05) == 0.0


def test_a_temperature_difference_is_no_temperature() -> None:
    assert law(halving_difference="23 K").halving_difference == 23.0
    with pytest.raises(ModelError, match="halving_difference"):
        law(halving_difference="23 °C")


@pytest.mark.parametrize(("survival", "name"), [(None, "life"), (0.9, "B10 life"), (0.5, "B50 life")])
def test_the_name_of_the_life(survival: float | None, name: str) -> None:
    assert line(survival=survival).life_name == law(survival=survival).life_name == name


def test_several_belts_share_the_force() -> None:
    one, three = (sold(profile="A", ribs=ribs) for ribs in (1, 3))
    assert one.cord_fatigue is not None
    assert three.cord_fatigue is not None
    np.testing.assert_allclose(three.cord_fatigue.forces, 3.0 * np.array(one.cord_fatigue.forces))
    assert three.cord_fatigue.bending_force == pytest.approx(3.0 * one.cord_fatigue.bending_force)
    narrow, wide = (sold(profile="PK", ribs=ribs) for ribs in (3, 6))
    assert narrow.rib_fatigue is not None
    assert wide.rib_fatigue is not None
    assert wide.rib_fatigue.passages_at(200.0, 0.06) == pytest.approx(narrow.rib_fatigue.passages_at(100.0, 0.06))


def test_data_of_a_belt_replace_those_of_its_profile() -> None:
    belt = sold(profile="A", ribs=2, cord_fatigue=LINE | {"source": "test"})
    assert belt.cord_fatigue == line()
    assert belt.replace(ribs=3).cord_fatigue == line()
    other = sold(profile="A", ribs=2).replace(profile="PK", ribs=6)
    assert other.cord_fatigue is None
    assert other.rib_fatigue is not None


CONSTANTS = {
    "A": (674.0, 11.089, 220.0),
    "B": (1193.0, 10.926, 576.0),
    "C": (2038.0, 11.173, 1600.0),
    "D": (4208.0, 11.105, 5680.0),
    "E": (6061.0, 11.100, 10850.0),
    "SPZ": (728.0, 12.464, 230.0),
    "SPB": (1654.0, 12.593, 1098.0),
}
"""K (lbf), b and K_b (lbf in) of Spotts' durability parameters, for 10^8 to 10^9 force peaks."""


@pytest.mark.parametrize("profile", CONSTANTS)
def test_v_belts_have_the_published_lines(profile: str) -> None:
    """(K/F)^b peaks to failure under F = T + K_b/d."""
    line, (k, b, bending) = read_catalogue()[profile].cord_fatigue, CONSTANTS[profile]
    assert line is not None
    low, high = k / 1e9 ** (1.0 / b), k / 1e8 ** (1.0 / b)
    forces = np.geomspace(low, high, 5)
    np.testing.assert_allclose(line.cycles_to_failure(POUND * forces), (k / forces) ** b, rtol=1e-3)
    assert line.bending_force / 0.05 == pytest.approx(bending * POUND * INCH / 0.1, rel=1e-4)
    assert (line.range_exponent, line.survival) == (0.0, None)


@pytest.mark.parametrize(("profile", "k", "b"), [("SPZ", 1062.0, 10.153), ("SPB", 2394.0, 10.283)])
def test_narrow_v_belts_have_a_second_piece(profile: str, k: float, b: float) -> None:
    """The published pieces meet at 10^9 peaks, within the rounding of their constants."""
    line = read_catalogue()[profile].cord_fatigue
    assert line is not None
    force = k / 3e9 ** (1.0 / b)
    assert line.cycles_to_failure(POUND * force) == pytest.approx(3e9, rel=0.01)


def test_profiles_without_a_source_have_no_data() -> None:
    entries = read_catalogue()
    assert {name for name, entry in entries.items() if entry.cord_fatigue} == set(CONSTANTS)
    assert {name for name, entry in entries.items() if entry.rib_fatigue} == {"PH", "PJ", "PK", "PL", "PM"}
    for entry in entries.values():
        for data in (entry.cord_fatigue, entry.rib_fatigue):
            assert data is None or (len(data.source) > 50 and data.survival is None)
