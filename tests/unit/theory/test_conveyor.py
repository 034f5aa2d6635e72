"""Smallest pulleys of conveyors against the table of DIN 22101, as a maker prints it."""

import pytest

from beltdyn.theory.conveyor import smallest_pulley, standard_diameter

TABLE = """
200 160 125 160 125 100 125 125 100
250 200 160 200 160 125 160 160 125
315 250 200 250 200 160 200 200 160
400 315 250 315 250 200 250 250 200
500 400 315 400 315 250 315 315 250
630 500 400 500 400 315 400 400 315
800 630 500 630 500 400 500 500 400
1000 800 630 800 630 500 630 630 500
1250 1000 800 1000 800 630 800 800 630
1400 1250 1000 1250 1000 800 1000 1000 800
1600 1250 1000 1250 1000 800 1000 1000 800
1800 1400 1250 1400 1250 1000 1250 1250 1000
2000 1600 1250 1600 1250 1000 1250 1250 1000
"""
"""Diameters of pulley groups A, B and C, mm, for uses of more than 60 %, of 30 to 60 %, and of less than 30 %."""


@pytest.mark.parametrize("line", TABLE.split("\n")[1:-1])
def test_the_table_of_smallest_pulleys(line: str) -> None:
    expected = [int(one) for one in line.split()]
    groups = ((3.1, True), (3.1, False), (0.4, True))
    diameters = [
        smallest_pulley(1e-3 * expected[0], used, wrap, high) for used in (0.9, 0.5, 0.2) for wrap, high in groups
    ]
    assert diameters == pytest.approx([1e-3 * one for one in expected])


def test_standard_diameters() -> None:
    """The next one up; the largest where there is none."""
    assert [standard_diameter(one) for one in (0.05, 0.2, 0.201, 1.3, 3.0)] == [0.1, 0.2, 0.25, 1.4, 2.0]
