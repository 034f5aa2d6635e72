"""What the page shows of results, in numbers."""

import pickle

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.app.findings import at_rest, findings_of
from beltdyn.model import estimate_at_rest, prepare
from beltdyn.results import Run


@pytest.fixture(scope="module")
def run(drive_text: str) -> Run:
    return bd.steady_state(bd.loads(drive_text))


def test_a_drive_at_rest_has_its_tension_all_around() -> None:
    given = bd.example("accessory_drive")
    prepared, installation = estimate_at_rest(prepare(given))
    found = at_rest(prepared.drive, installation)
    figures = {one.name: one for one in found.figures}
    assert figures["tension at rest"].value == pytest.approx(300.0)
    loads = np.linalg.norm(installation.hub_loads, axis=1)
    assert figures["largest hub load"].value == pytest.approx(loads.max())
    assert figures["largest hub load"].of == given.pulleys[int(loads.argmax())].name
    assert found.tensions == tuple(installation.span_tensions)
    around = found.around
    assert around is not None
    assert around.tensions == pytest.approx([300.0] * len(around.places))
    assert around.places[-1] == pytest.approx(installation.path.length)
    turned = {name: end - begin for name, begin, end in around.arcs}
    arcs = installation.path.wrap_angles * np.abs(installation.path.radii)
    assert [turned[one.name] for one in given.pulleys] == pytest.approx(arcs.tolist())


def test_steady_running_has_the_numbers_of_its_summary(run: Run) -> None:
    found, summary = findings_of(run), bd.summarize(run)
    figures = {one.name: one.value for one in found.figures}
    assert figures["power"] == summary.balance.power_in
    assert ("efficiency" in figures) == (summary.balance.power_out > 0.0)
    assert figures["largest hub load"] == max(one.hub_load for one in summary.pulleys)
    columns = {one.name: one.values for one in found.rows[0].columns}
    assert columns["slip"] == tuple(one.slip for one in summary.pulleys)
    assert found.tensions == tuple(one.tension for one in summary.spans)


def test_the_tension_around_the_belt_is_that_of_spans_between_arcs(run: Run) -> None:
    """Between pulleys the tension is that of a span: a small run has no vibration in steady running."""
    found = findings_of(run)
    around = found.around
    assert around is not None
    places, tensions = np.array(around.places), np.array(around.tensions)
    (_, on, off), (_, on_again, _) = around.arcs
    middle = tensions[np.abs(places - 0.5 * (off + on_again)).argmin()]
    assert tensions[0] == pytest.approx(found.tensions[0], rel=0.01)
    assert middle == pytest.approx(found.tensions[1], rel=0.01)
    assert on < off < on_again


def test_modes_are_drawn_with_what_moves(run: Run) -> None:
    result = bd.modes(run.drive, about=run, count=4)
    found = findings_of(result)
    damping = result.dataset["damping_ratio"].values
    assert 0 < len(found.shapes) <= 6
    assert all(one.damping < 0.5 for one in found.shapes)
    lightest = result.dataset.isel(mode=int(damping.argmin()))
    figures = {one.name: one.value for one in found.figures}
    assert figures["least damping ratio"] == pytest.approx(float(lightest["damping_ratio"]))
    one = found.shapes[0]
    assert one.belt != one.rest
    left, top, width, height = one.extent
    for x, y, radius, _ in one.pulleys:
        assert left <= x - radius < x + radius <= left + width
        assert top <= y - radius < y + radius <= top + height
    assert pickle.loads(pickle.dumps(found)) == found


@pytest.mark.slow
def test_other_results_have_no_charts_of_their_own(drive_text: str) -> None:
    found = findings_of(bd.traction(bd.loads(drive_text), points=3))
    assert (found.figures, found.rows, found.shapes) == ((), (), ())
