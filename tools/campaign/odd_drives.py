"""Odd drives: layouts, masses, tensions, speeds, loads and machines far from what anybody builds."""

from random import Random
from typing import Any

from beltdyn.model import Drive

Part = dict[str, Any]

_POWERS = {
    "radius": (-3.0, 1.0),
    "tension": (-3.0, 6.0),
    "modulus": (4.0, 12.0),
    "density": (-1.0, 5.0),
    "thickness": (-4.5, -0.3),
    "inertia": (-12.0, 6.0),
    "speed": (-3.0, 5.0),
    "torque": (-3.0, 5.0),
    "stiffness": (1.0, 13.0),
    "length": (-2.0, 2.0),
    "mass_per_length": (-3.0, 5.0),
}
"""Powers of ten between which an odd number lies."""
_USUAL = {"radius": 0.06, "tension": 200.0, "modulus": 5e8, "density": 1100.0, "thickness": 0.003, "inertia": 1e-3}
_ODD = 0.15
"""Probability of an odd number."""


class _Numbers:
    """Numbers that are mostly usual."""

    def __init__(self, random: Random) -> None:
        self.random = random

    def of(self, name: str, usual: float | None = None) -> float:
        """A number, which is odd now and then."""
        if self.random.random() < _ODD:
            return float(f"{10.0 ** self.random.uniform(*_POWERS[name]):.4g}")
        return float(f"{(_USUAL.get(name, 1.0) if usual is None else usual) * self.random.uniform(0.5, 2.0):.4g}")

    def chance(self, part: float) -> bool:
        return self.random.random() < part


def odd_drive(seed: int, elements: int = 30) -> Drive:
    """A drive that is odd in some respects.

    Parameters
    ----------
    seed
        The same drive for the same number.
    elements
        Number of elements, which are few so that analyses are short.

    Raises
    ------
    ModelError
        If the layout is no drive.
    """
    numbers = _Numbers(Random(seed))
    pulleys = [_pulley(numbers, place) for place in range(numbers.random.choice((2, 2, 3, 3, 4)))]
    belt: Part = {
        "width": 0.02,
        "thickness": numbers.of("thickness"),
        "density": numbers.of("density"),
        "youngs_modulus": numbers.of("modulus"),
        "poissons_ratio": numbers.random.choice((0.0, 0.3, 0.49)),
        "installed_tension": numbers.of("tension"),
        "elements": elements,
    }
    if numbers.chance(0.2):
        belt["bending_loss_factor"] = 0.1
    simulation = {"duration": 0.02, "output_interval": 1e-3, "frame": "staying", "mesh": "uniform"}
    given: Part = {
        "belt": belt,
        "pulley": pulleys,
        "contact": {"friction": numbers.random.choice((0.0, 1e-6, 0.3, 0.5, 1.0, 8.0))},
        "simulation": simulation,
        "steady": {"mesh": "uniform"},
    }
    if numbers.chance(0.2):
        given["gravity"] = [0.0, -numbers.random.choice((9.81, 1e4))]
    if len(pulleys) > 2 and numbers.chance(0.5):
        given["tensioner"] = [_tensioner(numbers, pulleys[-1])]
    _carry(numbers, given)
    return Drive(**given)


def _carry(numbers: _Numbers, given: Part) -> None:
    """Give the contact's stiffness, the belt's length in place of its tension, or goods and idlers, now and then."""
    if numbers.chance(0.2):
        given["contact"]["stiffness"] = numbers.of("stiffness", 1e8)
    if numbers.chance(0.2):
        del given["belt"]["installed_tension"]
        given["belt"]["length"] = numbers.of("length", 1.4)
    span = [given["pulley"][0]["name"], given["pulley"][1]["name"]]
    if numbers.chance(0.2):
        given["goods"] = [{"span": span, "mass_per_length": numbers.of("mass_per_length", 5.0)}]
    if numbers.chance(0.2):
        given["support"] = [{"kind": "idlers", "span": span, "spacing": 0.1, "idler_mass": 1.0, "friction": 0.02}]


def _pulley(numbers: _Numbers, place: int) -> Part:
    """A pulley: the first one mostly drives."""
    random = numbers.random
    center = [(0.0, 0.0), (0.5, 0.0), (0.25, 0.35), (0.25, -0.3)][place]
    made: Part = {
        "name": f"p{place}",
        "center": [x * random.choice((1.0, 1.0, 1.0, 0.3, 100.0)) for x in center],
        "radius": numbers.of("radius"),
    }
    if place == 3 and numbers.chance(0.5):
        made |= {"side": "outside", "center": [0.25, 0.02]}
    if (place == 0) != numbers.chance(0.05):
        value = random.choice((1.0, 1.0, -1.0, 0.0)) * numbers.of("speed", 100.0)
        made["speed"] = {"kind": "constant", "value": value}
        if numbers.chance(0.3):
            made["harmonics"] = [{"order": 2, "amplitude": random.choice((0.02, 1.5))}]
        return made
    made["inertia"] = numbers.of("inertia")
    if numbers.chance(0.7):
        made["torque"] = {"kind": "constant", "value": random.choice((-1.0, 1.0)) * numbers.of("torque", 2.0)}
    if numbers.chance(0.3):
        made["load"] = [
            random.choice(
                (
                    {"kind": "resistance", "constant": numbers.of("torque", 1.0)},
                    {
                        "kind": "fan",
                        "rated_power": 100.0 * numbers.of("torque", 1.0),
                        "rated_speed": numbers.of("speed", 100.0),
                    },
                    {
                        "kind": "motor",
                        "breakdown_torque": numbers.of("torque", 5.0),
                        "breakdown_slip": 0.1,
                        "synchronous_speed": numbers.of("speed", 100.0),
                    },
                )
            )
        ]
    return made


def _tensioner(numbers: _Numbers, pulley: Part) -> Part:
    """A tensioner with a spring, along a line or on an arm."""
    spring = {"preload": numbers.of("tension", 200.0), "rate": numbers.of("tension", 2000.0), "pulley": pulley["name"]}
    if numbers.chance(0.3):
        spring["tensioning_friction"] = spring["yielding_friction"] = numbers.of("tension", 20.0)
    if numbers.chance(0.5):
        direction = numbers.random.choice(([0.0, 1.0], [0.0, -1.0], [1.0, 1.0]))
        return {"kind": "sliding", "direction": direction, "mass": numbers.of("inertia", 1.0), **spring}
    x, y = pulley["center"]
    pivot = [x + numbers.random.choice((0.1, -0.1, 1e-6)), y]
    return {"kind": "rotary", "pivot": pivot, "inertia": numbers.of("inertia", 1e-2), **spring}
