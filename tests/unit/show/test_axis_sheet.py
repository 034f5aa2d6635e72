"""Sheets, figures and key numbers of an axis: the carriage first, and nothing of slip or of losses at standstill."""

import re

import pytest

import beltdyn as bd
from beltdyn.results import Run
from beltdyn.results.limits import key_numbers
from beltdyn.show.plot.figures import chosen_by_default
from beltdyn.show.report.report import write_report
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Facts, Table
from beltdyn.theory.input_shaping import EI_TOLERANCE

MOVE = {"kind": "s_curve", "times": [0.01], "angles": ["0.2 turn"], "speed": "5 turn/s", "acceleration": "200 turn/s^2"}


def moved(duration: float) -> Run:
    """The axis of a printer, which moves by 8 mm from 10 to 80 ms, and then stands."""
    axis = bd.example("printer_axis")
    motor = axis.pulleys[0].replace(speed=MOVE | {"jerk": "20000 turn/s^3"})
    settings = {"duration": duration, "rtol": 1e-3, "output_interval": 1e-3}
    return bd.simulate(axis.replace(pulley=[motor, axis.pulleys[1]], simulation=settings))


@pytest.fixture(scope="module")
def run() -> Run:
    return moved(0.12)


def tables(run: Run) -> dict[str, Table]:
    return {part.title: part for part in sheet(run).parts if isinstance(part, Table)}


def test_the_carriage_comes_first_and_nothing_slips(run: Run) -> None:
    shown = tables(run)
    assert next(iter(shown)) == "Carriage"
    assert not any("slip" in heading or "safety" in heading for table in shown.values() for heading in table.headings)
    error = run.dataset.carriage_error.values[:, 0]
    first = shown["Carriage"].rows[0][1]
    assert float(first.split()[0]) == pytest.approx(1e6 * abs(error).max(), rel=5e-3)
    numbers = key_numbers(run)
    assert numbers[0].key == "largest_carriage_error"
    assert numbers[0].value == pytest.approx(1e6 * abs(error).max())
    assert not {"largest_slip", "least_slip_safety"} & {one.key for one in numbers}


def test_the_limit_of_the_error_is_judged(run: Run) -> None:
    largest = abs(run.dataset.carriage_error.values).max()
    for factor, passes in ((1.1, True), (0.9, False)):
        limited = run.drive.replace(limits={"largest_carriage_error": factor * largest})
        judged = next(one for one in key_numbers(Run(run.dataset, limited)) if one.key == "largest_carriage_error")
        assert judged.passes is passes


def test_means_of_a_standstill_give_way_to_peaks(run: Run) -> None:
    shown = tables(run)
    peaks, spans = shown["Pulleys, largest of the run"], shown["Spans, extremes of the run"]
    assert float(peaks.rows[0][1]) == pytest.approx(300.0, rel=1e-3)
    least = min(float(row[1]) for row in spans.rows)
    assert least == pytest.approx(float(run.dataset.least_span_tension.min()), rel=1e-3)


def test_a_move_may_end_within_the_averaging_window() -> None:
    run = moved(0.086)
    assert "Pulleys, largest of the run" in tables(run)
    assert "losses" not in chosen_by_default([run])


def test_jumps_have_a_verdict(run: Run) -> None:
    facts = dict(fact for part in sheet(run).parts if isinstance(part, Facts) for fact in part.facts)
    margin = next(one.value for one in key_numbers(run) if one.key == "least_jump_margin")
    assert facts["jumps"].startswith(f"none: the least margin is {margin:.3g}, on motor")
    assert not {"power", "losses"} & set(facts)


def test_figures_begin_with_the_error_and_leave_out_slip_and_losses(run: Run) -> None:
    figures = chosen_by_default([run])
    assert figures[0] == "carriage_error"
    assert not {"slip", "slip_safety", "losses"} & set(figures)


def test_the_page_defines_jumps_and_not_slip(run: Run, tmp_path: object) -> None:
    page = write_report(run, f"{tmp_path}/axis.html").read_text(encoding="utf-8")
    defined = set(re.findall(r"<dt>(.*?)</dt>", page))
    assert "Margin to a jump" in defined
    assert not {"Slip", "Slip safety", "Efficiency", "Sliding and elastic creep"} & defined


def test_the_shortest_shaper_that_fits_is_named() -> None:
    """Near the middle all fit; over 220 mm none does, and the one that leaves least is named."""
    axis = bd.example("printer_axis")
    for places, fits in (("-2, 2 mm", True), ("-110, 0, 110 mm", False)):
        found = bd.stroke(axis, places=places)
        facts = dict(fact for part in sheet(found).parts if isinstance(part, Facts) for fact in part.facts)
        left = found.dataset.shaper_residual
        assert (float(left[0]) <= EI_TOLERANCE) is fits
        name = "ZV" if fits else str(left.shaper.values[left.values.argmin()])
        assert f"{name} at " in facts["input shaper"]
        assert facts["input shaper"].startswith("none") is not fits
        assert f"{name} at " in found.dataset.attrs["answer"]
        needed = float(found.dataset.recommended_tension)
        assert facts["recommended tension"].startswith(f"at least {needed:.3g} N")
