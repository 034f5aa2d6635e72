"""An analysis by formulas, which fails at points and leaves out results at random, for figures of studies."""

import math
from random import Random

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result


def formula(drive: Drive, *, seed: int = 0, failing: float = 0.0, unknown: float = 0.0) -> Result:
    """Give two results; a share of drives fails, and of the others a share of the results is not known."""
    width, radius, modulus = drive.belt.width, drive.pulleys[1].radius, drive.belt.youngs_modulus or 0.0
    random = Random(f"{seed} {width} {radius} {modulus} {drive.belt.temperature} {drive.contact.friction_law}")
    if random.random() < failing:
        raise ModelError("the belt slips. Give more tension.")
    values = {"stiffness": modulus * width, "speed": width / radius, "level": 3.0}
    known = {name: math.nan if random.random() < unknown else value for name, value in values.items()}
    return build_result("formula", drive, {name: (Variable((), "N", name), one) for name, one in known.items()}, {})
