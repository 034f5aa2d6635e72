"""Sheets of conveyors and web lines, against resistances, draws, and Euler's formula by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import example
from beltdyn.show.sheet import as_text, sheet

TASKS = Path(__file__).parents[3] / "docs" / "tasks"


@pytest.mark.slow
def test_a_conveyor_has_the_pull_of_din_22101() -> None:
    """To 1 %: the sum of resistances against the pull of the head drum and the rise of tension of each span."""
    drive = example("conveyor_1km").replace(
        duty=[{"name": "full", "share": 0.9}, {"name": "empty", "share": 0.1, "load": 0.0}]
    )
    result = bd.sheet(drive)
    found = result.dataset
    # f C L g (m_R + m cos δ) and H g m of the upper strand, 1000.11 m long with a slope of 15 in 1000
    upper, lower = found.sel(span="tail-head"), found.sel(span="head-tail")
    rotating, carried = np.array([22.0 / 1.2, 22.0 / 1.2]), 25.0 + np.array([104.0, 0.0])
    friction = 1.09 * 0.02 * 9.81 * (1000.11 * rotating + 1000.0 * carried)
    np.testing.assert_allclose(upper.main_resistance + upper.secondary_resistance, friction, rtol=2e-3)
    np.testing.assert_allclose(upper.goods_resistance, [15.0 * 9.81 * 104.0, 0.0], rtol=0.02)  # rims add to the height
    parts = ("main_resistance", "secondary_resistance", "slope_resistance", "goods_resistance")
    total = found[list(parts)].to_dataarray().sum("variable")
    for one in (upper, lower):
        np.testing.assert_allclose(one.span_pull, total.sel(span=str(one.span.values)), rtol=0.01)
    pull = found.shaft_torque.sel(pulley="head") / 0.5
    np.testing.assert_allclose(pull, total.sum("span"), rtol=0.01)
    head = found.sel(pulley="head", row="full")
    wrap, least = float(head.wrap_angle), head.least_slack_tension.values
    expected = float(head.tension_before - head.tension_after) / np.expm1(np.array([0.7, 1.0, 1.3]) * 0.35 * wrap)
    np.testing.assert_allclose(least, expected + 25.0 * 3.998**2, rtol=1e-3)
    np.testing.assert_allclose(upper.sag[0] * upper.least_span_tension[0] * 8.0, 129.0 * 9.81 * 1.2, rtol=1e-3)
    # the start: belt, goods, idlers and tail drum at 0.1571 m/s^2; the tail drum takes half of the stretch up
    mass = 25.0 * 2001.4 + 1000.11 * (104.0 * np.array([1.0, 0.0]) + 22.0 / 1.2 + 18.0 / 3.0) + 60.0 / 0.4**2
    np.testing.assert_allclose(found.moved_mass, mass, rtol=2e-3)
    np.testing.assert_allclose(found.start_pull - found.running_pull, mass * 4.0 * np.pi / 80.0, rtol=3e-3)
    assert float(found.holdback_torque[0]) == pytest.approx(15.0 * 9.81 * 104.0 * 0.5, rel=0.02)
    behind = 1000.11 * (25.0 + 18.0 / 3.0) + 0.5 * 60.0 / 0.4**2
    more = found.start_slack_tension.sel(pulley="head") - found.tension_after.sel(pulley="head")
    np.testing.assert_allclose(more, -behind * 4.0 * np.pi / 80.0, rtol=0.01)
    travel = found.running_stretch / found.take_up_ratio
    assert float(travel[0] - travel[1]) == pytest.approx(
        float(found.tensioner_position[0, 0] - found.tensioner_position[1, 0]), rel=0.01
    )
    numbers = {one.key: one for one in bd.results.key_numbers(result)}
    assert numbers["largest_tension"].value == pytest.approx(float(head.tension_before), rel=1e-3)
    text = as_text(sheet(result))
    assert "Resistances of spans, operating point empty" in text
    assert "none" in text
    with pytest.raises(ModelError, match="no curves over speed"):
        bd.plot.sheet_tensions(result)
    assert bd.plot.line_tensions(result).get_legend_handles_labels()[1] == ["full", "empty"]


@pytest.mark.slow
def test_a_motor_starts_a_conveyor_by_its_breakdown_torque() -> None:
    """At fixed drums the belt keeps its stretch, and both strands share what the start adds."""
    found = bd.sheet(example("package_conveyor")).dataset.isel(row=0)
    radius, rotor = 0.5 * float(found.pitch_diameter[0]), 2.6
    moved = float(found.moved_mass)
    pull = float(found.running_pull)
    gain = (150.0 / radius - pull) / (moved + rotor / radius**2)
    assert float(found.acceleration) == pytest.approx(gain, rel=2e-3)
    assert float(found.start_pull) == pytest.approx(pull + moved * gain, rel=2e-3)
    assert float(found.holdback_torque) == 0.0
    assert float(found.start_stretch) == pytest.approx(float(found.running_stretch), rel=1e-3)
    assert float(found.stretch_at_rest) == pytest.approx(float(found.running_stretch), rel=1e-2)
    given = bd.sheet(example("package_conveyor"), acceleration="500 rad/s^2")
    assert any("drive slips in starts at operating point 1" in one for one in given.warnings)
    assert float(given.dataset.acceleration[0]) == pytest.approx(500.0 * radius, rel=1e-3)


@pytest.mark.slow
def test_a_web_line_has_the_strains_of_its_draws() -> None:
    """To 0.1 %: the draw of 0.02 % adds EA times it, and rolls turn with the moments of their tensions."""
    found = bd.sheet(bd.load(TASKS / "coater.toml"))
    dataset, stiffness = found.dataset, 4.5e9 * 1.2 * 50e-6
    spans = dataset.sel(row="1", span=["dancer-infeed", "infeed-coater"])
    assert float(spans.span_strain[1] - spans.span_strain[0]) == pytest.approx(2e-4, rel=2e-3)
    np.testing.assert_allclose(spans.span_tension, stiffness * spans.span_strain, rtol=1e-3)
    np.testing.assert_allclose(dataset.roll_torque[0], [120.0 * 0.4, 100.0 * 0.076], rtol=1e-6)
    titles = [part.title for part in sheet(found).parts]
    assert titles == ["", "Operating points", "Pulleys", "Grip", "Spans", "Tensioners", "Rolls"]
    assert any("coater slips at operating point 1 with 0.7 times the friction" in one for one in found.warnings)


@pytest.mark.slow
def test_a_nip_is_on_the_sheet() -> None:
    found = bd.sheet(bd.load(TASKS / "press_roller.toml")).dataset
    assert found.nip.values.tolist() == ["press"]
    assert float(found.nip_force[0, 0]) > 0.0


def test_options_of_closed_belts_are_refused() -> None:
    refused: tuple[tuple[dict[str, Any], str], ...] = (
        ({"speed": "1..2 rad/s"}, "speed = 1..2 rad/s is an option for belts between pulleys alone"),
        ({"full": True}, "full = True is an option"),
    )
    for options, said in refused:
        with pytest.raises(ModelError, match=said):
            bd.sheet(example("package_conveyor"), **options)
    with pytest.raises(ModelError, match="acceleration = 2 is an option"):
        bd.sheet(bd.load(TASKS / "coater.toml"), acceleration=2)
