"""Results of drives in steady running and at rest by name."""

from types import SimpleNamespace

import numpy as np
import pytest

from beltdyn.designs.found_state import Mode, Resting, Running
from beltdyn.model import Drive, prepare
from beltdyn.results import Run, summarize
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_state
from beltdyn.vibration.modes import modes
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def drive_under_load() -> Drive:
    return better(loaded_two_pulley())


@pytest.fixture(scope="module")
def running(drive_under_load: Drive) -> Running:
    return Running(steady_state(drive_under_load))


@pytest.fixture(scope="module")
def resting(drive_under_load: Drive) -> Resting:
    return Resting(bring_to_stand(prepare(drive_under_load)))


def test_modes_are_found_up_to_a_frequency(running: Running) -> None:
    frequencies, _ = running.modes_up_to(300.0)
    assert frequencies.max() > 300.0
    few = modes(running.run.drive, about=running.run, count=4).dataset.sortby("mode").frequency.values
    np.testing.assert_allclose(frequencies[: few.size], few, rtol=1e-6)


class Swinging(Running):
    """A drive of which one mode swings in a span, or none; notes how many modes were looked for."""

    def __init__(self, run: Run, number: int, total: int = 1000) -> None:
        super().__init__(run)
        self.number, self.total, self.counts = number, total, list[int]()

    def _first(self, count: int) -> list[Mode]:
        self.counts.append(count)
        found = [
            SimpleNamespace(number=k, frequency=float(k), kind="belt", span_share=[float(k == self.number), 0.0])
            for k in range(1, min(count, self.total) + 1)
        ]
        return found[::-1]  # type: ignore[return-value]


@pytest.mark.parametrize(("number", "largest"), [(5, 12), (13, 24), (100, 192), (300, 384), (500, 384)])
def test_modes_are_looked_for_in_ever_larger_numbers(running: Running, number: int, largest: int) -> None:
    """Up to more than 200 of them, or all that there are."""
    state = Swinging(running.run, number)
    mode = state._mode_of_span("driver-driven")
    assert (None if mode is None else mode.number) == (number if number <= largest else None)
    assert state.counts == [count for count in (12, 24, 48, 96, 192, 384) if count <= largest]
    state = Swinging(running.run, number)
    frequencies, kinds = state.modes_up_to(number - 0.5)
    assert len(frequencies) == len(kinds) == largest
    few = Swinging(running.run, number=0, total=30)
    assert few._mode_of_span("driver-driven") is None
    assert len(few.modes_up_to(1e3)[0]) == 30
    assert few.counts == [12, 24, 48, 12, 24, 48]


def test_results_of_steady_running(running: Running) -> None:
    summary = summarize(running.run)
    assert running.value("hub_load[driven]") == summary.pulleys[1].hub_load
    assert np.isnan(running.value("tensioner_position[driven]"))


def test_results_at_rest(resting: Resting, drive_under_load: Drive) -> None:
    """Those of the static equilibrium on equal elements, within what the mesh takes."""
    dataset = equilibrium(drive_under_load).dataset
    tension = float(dataset.span_tension.sel(span="driver-driven"))
    assert resting.value("span_tension[driver-driven]") == pytest.approx(tension, rel=0.01)
    load = float(np.linalg.norm(dataset.hub_force.sel(pulley="driven").values))
    assert resting.value("hub_load[driven]") == pytest.approx(load, rel=0.01)


def test_the_lowest_mode_of_a_span(resting: Resting) -> None:
    """A string of the span's length, within bending, the ends in contact, and the mass of the stretched belt."""
    drive = resting.drive
    length, mass = float(drive.path.span_lengths[0]), drive.belt.mass_per_length
    stretch = drive.path.length / drive.belt_length
    string = 0.5 / length * np.sqrt(resting.value("span_tension[driver-driven]") * stretch / mass)
    assert resting.value("frequency[driver-driven]") == pytest.approx(string, rel=0.02)
    assert resting.value("damping_ratio[driver-driven]") > 0.0


def test_a_neighbour_is_on_the_same_mesh(resting: Resting, drive_under_load: Drive) -> None:
    other = resting.neighbour(drive_under_load.with_({"belt.length": 1.2443 * (1.0 - 1e-6)}))
    assert isinstance(other, Resting)
    assert other.rest.system.nodes == resting.rest.system.nodes
    assert other.value("span_tension[driver-driven]") > resting.value("span_tension[driver-driven]")
