"""Belts that sag between idlers."""

from typing import Any

import numpy as np

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.parts.messages import beyond
from beltdyn.results.checks.evidence import Evidence
from beltdyn.results.checks.machines import _on_support, sagging_belt

RAMP = {"kind": "cosine_ramp", "start": 0.2, "end": 0.8, "value": 1.0}
DRIVE = bd.Drive(
    gravity=[0.0, -9.81],
    belt={"profile": "flat-polyester-fabric", "width": "400 mm", "installed_tension": "2 kN"},
    pulley=[
        {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "speed": 5.0},
        {"name": "tail", "center": [20.0, 0.0], "radius": 0.2, "inertia": 0.15},
    ],
    support=[{"kind": "idlers", "span": ["tail", "head"], "spacing": 1.0}],
    goods=[{"span": ["tail", "head"], "mass_per_length": 30.0, "start": 5.0, "end": 15.0, "schedule": RAMP}],
    contact={"friction": 0.3},
    simulation={"duration": 1.0},
)
PREPARED = bd.model.prepare(DRIVE)
FULL = (DRIVE.belt.mass_per_length + 30.0) * 9.81 / 8.0
"""Tension times sag over spacing, N, under goods."""


def said(tension: FloatArray) -> list[str]:
    """What is said of tensions at 0 and 1 s along the belt."""
    place = np.linspace(0.0, PREPARED.belt_length, tension.shape[1], endpoint=False)
    recorded: Any = {"field_time": np.array([0.0, 1.0]), "belt_tension": tension, "element_coordinate": place}
    evidence: Any = Evidence(recorded, PREPARED, None, tuple)  # type: ignore[arg-type]
    return [str(one) for one in sagging_belt(evidence)]


def test_a_belt_under_goods_sags_by_their_weight_over_its_tension() -> None:
    """1 % at the tension of the rule; goods are there at 1 s alone."""
    assert not said(np.full((2, 400), 1.01 * FULL / 0.01))
    (text,) = said(np.full((2, 400), FULL / 0.02))
    assert text.startswith("the belt sags between idlers by 0.02 of the spacing of support[1], tail-head, at t = 1 s")
    least = beyond(0.0, FULL / 0.01, 3)
    assert f"Raise the least tension to {least:g} N" in text
    assert least >= FULL / 0.01
    assert f"place idlers {beyond(1.0, 0.5 * DRIVE.supports[0].free_length, 3):g} m apart in support[1]" in text


def test_a_tension_that_needs_no_change_is_not_advised_to_change() -> None:
    """Sag of 1.005 %: 0.5 % more tension is none."""
    assert not said(np.full((2, 400), FULL / 0.01005))


def test_where_nothing_is_carried_on_idlers_a_belt_may_hang() -> None:
    place = np.linspace(0.0, PREPARED.belt_length, 400, endpoint=False)
    first = (PREPARED.laid.path.span_start(1) - PREPARED.laid.start) / PREPARED.laid.stretch % PREPARED.belt_length
    away = (place - first) % PREPARED.belt_length > 20.1
    assert not said(np.where(away, 1.0, 1e6) * np.ones((2, 1)))


def test_a_batch_sags_where_it_is() -> None:
    """5 m of goods, which the belt carries by 1 m in a second: under its middle after, and not before."""
    batch = DRIVE.goods[0].replace(start=0.0, end=20.0, schedule=None, batch=[5.0, 10.0])
    prepared = bd.model.prepare(DRIVE.replace(goods=[batch]))
    place = np.linspace(0.0, prepared.belt_length, 400, endpoint=False)
    speeds = np.ones((2, 2))
    recorded: Any = {"field_time": np.array([0.0, 1.0]), "element_coordinate": place, "belt_speed": speeds}
    evidence: Any = Evidence(recorded | {"time": np.array([0.0, 1.0])}, prepared, None, tuple)  # type: ignore[arg-type]
    on, weight = _on_support(evidence, prepared.supports[0], np.array([0.0, 1.0]))
    laid = prepared.laid
    along = (laid.start + laid.stretch * place[on] - laid.path.span_start(1)) % laid.path.length
    for row, rear in enumerate((5.0, 6.0)):
        under = weight[row] > 100.0
        np.testing.assert_allclose([along[under].min(), along[under].max()], [rear, rear + 5.0], atol=0.15)
