"""What studies watch beside results by name: modes near an order, and clearances."""

from typing import Any

import numpy as np
import pytest

from beltdyn.designs.batch import OperatingPoint, clearance, distance_from_order
from beltdyn.designs.found_state import Running
from beltdyn.model import Drive
from beltdyn.model.parameter_study import Obstacle, Order
from beltdyn.points.changed_drive import at_speed
from beltdyn.state.steady import steady_state
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def running() -> Running:
    return Running(steady_state(better(loaded_two_pulley())))


class Modes(Running):
    """Known modes in place of those of a drive."""

    def modes_up_to(self, frequency: float) -> Any:
        return np.array([8.0, 11.0, 30.0]), ["rotational", "span", "coupled"]


def test_distance_from_the_band_of_an_order() -> None:
    """Order 2 from 300 to 360 rpm is 10 to 12 Hz: a span at 11 Hz is in it, 8 Hz are 20 % below, 30 Hz 150 % above."""
    drive = better(loaded_two_pulley())
    rpm = np.pi / 30.0
    points = [OperatingPoint("a", 1.0, lambda one: at_speed(one, 0, 300.0 * rpm))]

    def distance(**kinds: Any) -> float:
        order = Order(order=2, least_speed=300.0 * rpm, largest_speed=360.0 * rpm, **kinds)
        return distance_from_order(order, drive, points).read(Modes(None))  # type: ignore[arg-type]

    assert distance() == pytest.approx(max(11 / 12 - 1, 1 - 11 / 10))
    assert distance(kinds=["rotational", "coupled"]) == pytest.approx(0.2)
    assert distance(kinds=["coupled"]) == pytest.approx(1.5)


def test_clearance_of_a_bolt_above_the_upper_span(running: Running) -> None:
    """The spans are parallel, and the surface is half a thickness above the middle of the belt."""
    drive: Drive = running.run.drive
    radius, above = 0.004, 0.02
    height = float(drive.radii[0]) + drive.belt.back_offset + above + radius
    bolt = Obstacle(name="bolt", center=(0.0, height), radius=radius, clearance=0.001)
    assert clearance(bolt, 1).read(running) == pytest.approx(above, abs=1e-12)
