"""What a machine does whose numbers are left out: nothing, but for documented scales of smoothing and shares."""

from importlib import import_module
from math import pi
from pkgutil import walk_packages

import numpy as np
import pytest
from pydantic import BaseModel

from beltdyn import machines
from beltdyn.machines import Goods
from beltdyn.machines.tensioners import tensioner_force, tensioner_row
from beltdyn.model import RotaryTensioner, SlidingTensioner

SCALES = {
    ("Idlers", "friction"): 0.02,
    ("Idlers", "secondary_factor"): 1.0,
    ("Brake", "backward_ratio"): 1.0,
    ("InductionMotor", "frequency"): 50.0,
    ("_OverAngle", "cycle"): 2.0 * pi,
    ("CrankSpeed", "cycle"): 2.0 * pi,
    ("Trim", "largest_trim"): 0.1,
    ("TorqueTrim", "largest_trim"): 1.0,
    ("Trim", "lag"): 1e-3,
    ("ServoMotor", "lag"): 1e-3,
    ("RotaryTensioner", "center_of_mass"): 0.5,
}
"""Defaults that are not zero, as the reference has them."""
CREEP_SPEEDS = {
    "Idlers": 0.01,
    "Guide": 0.01,
    "Holdback": 1e-3,
    "MovingTensioner": 1e-3,
    "RotaryTensioner": 0.01,
    "SlidingTensioner": 1e-3,
}
"""Speeds at which smoothed dry friction reaches 76 %; of loads on shafts 0.1 rad/s."""


def parts() -> list[type[BaseModel]]:
    modules = [import_module(each.name) for each in walk_packages(machines.__path__, "beltdyn.machines.")]
    values = [(module, value) for module in modules for value in vars(module).values()]
    return [
        value
        for module, value in values
        if isinstance(value, type) and issubclass(value, BaseModel) and value.__module__ == module.__name__
    ]


def test_numbers_left_out_are_zero_or_documented() -> None:
    for part in parts():
        for name, field in part.model_fields.items():
            if (
                name in part.__annotations__
                and isinstance(field.default, int | float)
                and not isinstance(field.default, bool)
            ):
                smooth = CREEP_SPEEDS.get(part.__name__, 0.1) if name == "creep_speed" else 0.0
                assert field.default == SCALES.get((part.__name__, name), smooth), f"{part.__name__}.{name}"


BOUND = ("ge", "gt", "le", "lt")
BOUNDS = {("Idlers", "secondary_factor"): {1.0}, ("InductionMotor", "breakdown_ratio"): {1.0}}
"""Least numbers that are not zero: secondary resistances only add to the main ones, and motors have reserves."""


def test_numbers_may_be_as_small_as_zero_and_shares_as_large_as_one() -> None:
    for part in parts():
        for name, field in part.model_fields.items():
            if name in part.__annotations__:
                bounds = {kind: getattr(item, kind) for item in field.metadata for kind in BOUND if hasattr(item, kind)}
                least = BOUNDS.get((part.__name__, name), {0.0})
                lower = {float(value) for kind, value in bounds.items() if kind in {"ge", "gt"}}
                upper = {float(value) for kind, value in bounds.items() if kind in {"le", "lt"}}
                assert lower <= least | {-pi}, f"{part.__name__}.{name}"
                assert upper <= {1.0, pi}, f"{part.__name__}.{name}"


@pytest.mark.parametrize("speed", [0.0, 3.0, -3.0])
def test_a_tensioner_with_a_preload_alone_is_a_constant_force_without_loss(speed: float) -> None:
    arm = RotaryTensioner(kind="rotary", pulley="idler", pivot=(0.1, 0.1), preload=5.0)
    slide = SlidingTensioner(kind="sliding", pulley="idler", direction=(1.0, 0.0), preload=5.0)
    for tensioner in (arm, slide):
        row = tensioner_row(
            tensioner, 0, np.array([0.4, 0.5]), np.array([-0.4, 0.3]) if tensioner is arm else np.ones(2)
        )
        force = tensioner_force(row, 0.7, speed)
        assert (force.force, force.by_position, force.by_velocity, force.loss) == (5.0, 0.0, 0.0, 0.0)
        assert force.energy == pytest.approx(-0.7 * 5.0)


@pytest.mark.parametrize(("sense", "side"), [("counter-clockwise", 1.0), ("clockwise", -1.0)])
def test_a_spring_may_say_its_sense_if_that_tensions_the_belt(sense: str, side: float) -> None:
    """An arm along (0.6, 0.8), whose end goes along (-0.8, 0.6) counter-clockwise."""
    arm = RotaryTensioner(kind="rotary", pulley="idler", pivot=(0.1, 0.1), preload=5.0, sense=sense)
    center, gradient = np.array([0.4, 0.5]), np.array([-0.4, 0.3])
    assert arm.leverage(center, side * gradient) == pytest.approx(side * 0.5, rel=1e-12)
    with pytest.raises(ValueError, match="its spring would slacken the belt"):
        arm.leverage(center, -side * gradient)


@pytest.mark.parametrize(("batch", "fits"), [((1.0, 2.0), True), ((2.0, 1.0), False), ((1.0, 1.0), False)])
def test_a_batch_has_its_front_before_its_rear(batch: tuple[float, float], fits: bool) -> None:
    if fits:
        assert Goods(span=("tail", "head"), mass_per_length=5.0, batch=batch).batch == batch
    else:
        with pytest.raises(ValueError, match="must be the rear and the front"):
            Goods(span=("tail", "head"), mass_per_length=5.0, batch=batch)
