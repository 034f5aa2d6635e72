"""Numbers of spans against the belt's own elements, on heavy belts drawn at random: lifts, slopes, conveyors.

Whatever names a tension, in sheets, limits, tables and warnings, is the largest or least along the path.
"""

import re

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results import Run, key_numbers, summarize
from beltdyn.state.steady import steady_state
from tests.lumped.drawn_heavy import GRAVITY, drawn_heavy, tension_of_a_belt_as_long_as_its_path

QUICK, ALL = (0, 8), (2, 3, 4, 5, 6, 7, *range(9, 22), *range(23, 35), *range(36, 41))
"""Seeds whose belts have the installed tension with a length below that of the path."""
DEEP = (1, 22, 35)
"""Seeds whose belts hang so deep that the installed tension needs one longer than the path, which is refused."""
WITHIN = 2e-3
"""Of the largest tension: bending takes part of it from the last elements of a span."""


def elements_of(run: Run) -> dict[str, np.ndarray]:
    """Extremes of the tensions of free elements of each span, and of the first and last one."""
    last = run.dataset.isel(time=-1, field_time=-1)
    tension, count = last.belt_tension.values, last.sizes["element"]
    touched = last.contact_pulley.values.reshape(count, -1)
    free, on = (touched < 0).all(axis=1), touched.max(axis=1)
    begin = int(np.flatnonzero(~free)[0])
    order, span = (begin + np.arange(count)) % count, on[begin]
    rows: dict[int, list[int]] = {}
    for row in order.tolist():
        if free[row]:
            rows.setdefault(int(span), []).append(row)
        else:
            span = on[row]
    found = [tension[rows[number]] for number in range(len(rows))]
    return {
        "largest_span_tension": np.array([one.max() for one in found]),
        "least_span_tension": np.array([one.min() for one in found]),
        "span_tension_at_start": np.array([one[0] for one in found]),
        "span_tension_at_end": np.array([one[-1] for one in found]),
    }


@pytest.mark.parametrize("seed", [*QUICK, *(pytest.param(seed, marks=pytest.mark.slow) for seed in ALL)])
def test_every_number_of_a_span_is_that_of_its_elements(seed: int) -> None:
    run = steady_state(drawn_heavy(seed))
    expected, last = elements_of(run), run.dataset.isel(time=-1)
    scale = float(expected["largest_span_tension"].max())
    for name, values in expected.items():
        np.testing.assert_allclose(last[name].values, values, atol=WITHIN * scale, err_msg=name)
    summary = summarize(run)
    assert [one.highest for one in summary.spans] == pytest.approx(expected["largest_span_tension"], abs=WITHIN * scale)
    assert [one.lowest for one in summary.spans] == pytest.approx(expected["least_span_tension"], abs=WITHIN * scale)
    numbers = {one.key: one.value for one in key_numbers(run)}
    largest, least = scale, float(expected["least_span_tension"].min())
    assert numbers["largest_tension"] == pytest.approx(largest, abs=WITHIN * scale)
    assert numbers["least_tension"] == pytest.approx(least, abs=WITHIN * scale)
    table = bd.duty(run.drive.replace(duty=[{"share": 1.0}]))
    numbers = {one.key: one.value for one in key_numbers(table)}
    assert numbers["largest_tension"] == pytest.approx(largest, abs=WITHIN * scale)
    assert numbers["least_tension"] == pytest.approx(least, abs=WITHIN * scale)
    assert float(table.dataset.largest_tension[0]) == pytest.approx(largest, abs=WITHIN * scale)


@pytest.mark.slow
@pytest.mark.parametrize("seed", DEEP)
def test_a_belt_longer_than_its_path_is_refused_with_the_least_tension(seed: int) -> None:
    """That of a belt as long as the path, by the parabolas of its strands; slopes and arcs make 5 %."""
    drive = drawn_heavy(seed)
    with pytest.raises(ConvergenceError, match="as long as the path around the pulleys, still has") as caught:
        bd.equilibrium(drive)
    stated = re.search(r"still has (\S+) N", str(caught.value))
    assert stated
    least = tension_of_a_belt_as_long_as_its_path(drive)
    assert float(stated[1]) == pytest.approx(least, rel=0.05)
    assert float(stated[1]) > (drive.belt.installed_tension or 0.0)


@pytest.mark.parametrize("seed", [QUICK[1], *(pytest.param(seed, marks=pytest.mark.slow) for seed in ALL)])
def test_torque_and_hub_load_follow_from_the_tensions_at_the_arc(seed: int) -> None:
    """Their difference, with the weight of the belt on the arc, is the torque; with its weight they pull the hub."""
    run = steady_state(drawn_heavy(seed))
    last, prepared = run.dataset.isel(time=-1, field_time=-1), run.prepared
    grip = [one.own_load_safety for one in summarize(run).pulleys]
    touched, places = last.contact_pulley.values, last.contact_position.values
    weight = prepared.belt.mass_per_length * GRAVITY
    scale = float(last.largest_span_tension.max())
    for pulley in range(2):
        arc = np.flatnonzero(touched == pulley)
        gap = int(np.argmax(np.diff(arc, append=arc[0] + touched.size))) + 1
        rows = np.roll(arc, -gap)
        rise = float(places[rows[-1], 1] - places[rows[0], 1])
        before, after = last.span_tension_at_end.values[pulley - 1], last.span_tension_at_start.values[pulley]
        torque = float(last.pulley_torque[pulley]) / float(prepared.radii[pulley])
        assert after - before - weight * rise == pytest.approx(torque, abs=5e-3 * scale)
    assert np.isnan(grip[1]) == (abs(float(last.shaft_torque[1])) < 1e-9)


def elevator(**more: object) -> Drive:
    """Belt and buckets of 20 kg/m over 30 m: at a mean of 6 kN the head carries 8.94 kN, the boot 3.06 kN."""
    return Drive(
        gravity=[0.0, -9.81],
        belt={
            "installed_tension": "6 kN",
            "width": 0.4,
            "thickness": 0.01,
            "axial_stiffness": 2e6,
            "bending_stiffness": 1.0,
            "mass_per_length": 20.0,
            "friction": 0.35,
        },
        pulley=[
            {"name": "head", "center": [0.0, 30.0], "radius": 0.4, "speed": 4.0},
            {"name": "boot", "center": [0.0, 0.0], "radius": 0.4, "inertia": 20.0},
        ],
        simulation={"duration": 1.0},
        **more,
    )


def test_limits_judge_where_the_weight_makes_the_tension_worst() -> None:
    drive = elevator(limits={"largest_tension": "7 kN", "least_tension": "4 kN"})
    for result, error in ((steady_state(drive), 2e-3), (bd.equilibrium(drive), 0.01)):
        numbers = {one.key: one for one in key_numbers(result)}
        assert numbers["largest_tension"].value == pytest.approx(8943.0, rel=error)
        assert numbers["least_tension"].value == pytest.approx(3057.0, rel=2.0 * error)
        assert numbers["largest_tension"].passes is False
        assert numbers["least_tension"].passes is False


def test_the_creep_of_a_heavy_belt_is_elastic() -> None:
    """5.87 kN over 2 MN, and no fault of the friction law."""
    run = steady_state(elevator())
    boot = summarize(run).pulleys[1]
    assert boot.elastic_creep == pytest.approx(boot.slip, rel=0.05)
    assert not any("friction law" in one for one in run.warnings)


def test_the_sheet_knows_the_weight_of_the_belt() -> None:
    """The hub of the head carries both strands and its arc, that of the boot what is left."""
    sheet = bd.sheet(elevator()).dataset
    head, boot = (float(sheet.hub_load.sel(pulley=name)[0]) for name in ("head", "boot"))
    run = steady_state(elevator())
    expected = [one.hub_load for one in summarize(run).pulleys]
    assert [head, boot] == pytest.approx(expected, rel=0.01)
    assert head - boot == pytest.approx(2.0 * 5886.0 + 0.8 * np.pi * 20.0 * 9.81, rel=0.01)
    assert float(sheet.peak_tension.max()) == pytest.approx(8943.0, rel=3e-3)
