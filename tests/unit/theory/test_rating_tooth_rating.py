"""The rating of toothed belts, against makers' tables and the rule that the slack span stays tight."""

import numpy as np
import pytest

from beltdyn.theory.rating import (
    REST_SHARE,
    least_rest_tension,
    mesh_factor,
    pull_of_cords,
    speed_factor,
    whole_teeth,
)

T5 = {0: 24.70, 100: 22.28, 500: 18.45, 1000: 16.32, 1500: 15.00, 2000: 14.03, 3000: 12.65, 5000: 10.88, 10000: 8.44}
"""Tooth shear strength of Goodyear Elatech T5, N per cm of width, over rpm."""


def test_the_load_of_a_tooth_falls_with_speed_as_tabulated() -> None:
    speeds, tabulated = np.array(list(T5)), np.array(list(T5.values()))
    assert 24.70 * speed_factor(speeds, 0.324, 93.0) == pytest.approx(tabulated, rel=0.02)
    assert speed_factor(-500.0, 0.324, 93.0) == speed_factor(500.0, 0.324, 93.0)
    assert speed_factor(1e12, 0.324, 93.0) == 0.0


def test_only_whole_teeth_count_and_not_more_than_the_belt_can_load() -> None:
    assert mesh_factor([0.9, 3.0 - 1e-9, 5.99, 6.0, 11.0], 6).tolist() == pytest.approx([0.0, 0.5, 5 / 6, 1.0, 1.0])
    assert whole_teeth(6.999).item() == 6.0


def test_the_slack_span_keeps_a_tenth_of_the_pull_and_the_tight_span_the_allowed_tension() -> None:
    pull, mass, speed = 300.0, 0.1, 20.0
    rest = least_rest_tension(pull, mass, speed)
    assert rest - 0.5 * pull - mass * speed**2 == pytest.approx((REST_SHARE - 0.5) * pull)
    most = pull_of_cords(1000.0, mass, speed)
    assert least_rest_tension(most, mass, speed) + 0.5 * most == pytest.approx(1000.0)
