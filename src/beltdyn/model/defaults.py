"""Default numerical parameters of a drive: those of contact, and the number of elements.

Contact is a penalty, and the creep of friction a regularization: both belong to the computation, unless the belt's
own compressibility is known.  They are chosen so that a result does not show them, and no run pays for more.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.model.resolution import (
    PRESSURES,
    Laid,
    Running,
    elements_needed,
    fewest,
    graded_mesh,
    layer_length,
    layer_lengths,
)
from beltdyn.parts.messages import listing

TENSION_LOST = 0.005
"""Share of the tension lost by penetration."""
DEPTH_OF_THICKNESS, DEPTH_OF_RADIUS = 0.02, 0.001
"""Largest penetrations at rest over the belt's thickness and over the effective radius."""
DAMPING_RATIO = 0.5
"""Contact damping over the critical damping, which stabilizes a sliding belt."""
STANDSTILL = 0.05
"""Share of the largest speed below which the creep velocity is constant: steeper friction spoils the start."""
GUIDING = 0.5
"""The same share where pulleys are guides that stand still, over which the whole belt breaks away at once."""
CREEP_LENGTHS = 16.0
"""Length of the smallest adhesion arc at the tension at rest, over the length of e-fold growth of slip velocity."""
RESOLVED = {"tension": 0.005, "slip": 0.015}
"""Quantities that the mesh resolves, and their largest estimated errors; pressures at arc ends need more elements."""
OF_SINGLE_TEETH = {"tension": 0.02, "slip": 0.015}
"""The same with single teeth, from one to the next of which the tension varies by more."""
FEWEST, MOST = 40, 2000
"""Least and largest default number of elements."""


class Choice(NamedTuple):
    """A default chosen for an open value."""

    key: str
    """Its key in a drive file, such as "contact.stiffness"."""
    value: float
    unit: str
    """SI unit, empty for a dimensionless number."""
    reason: str
    """The reason in a few words."""

    @property
    def words(self) -> str:
        """The value with its unit, and the reason."""
        return f"{self.value:.4g} {self.unit.replace('*', ' ')}".strip() + f": {self.reason}"


class OnPath(NamedTuple):
    """A belt on its path, for `beltdyn.model.resolution`."""

    belt: Belt
    belt_length: float
    """m."""
    radii: FloatArray
    """Effective radii, shape (n,), m."""
    contact_stiffness: float
    """N/m^2."""


def stiffness_for_tension(path: Path, belt: Belt) -> float:
    """Contact stiffness for the loss of tension `TENSION_LOST` by penetration, N/m^2.

    A belt under T sinks by d = T / (R k_p), which shortens its path by the wrap angle times d, and it loses the tension
    E A / L times that.
    """
    sinking = float(np.sum(path.wrap_angles / np.abs(path.radii)))
    return belt.axial_stiffness * sinking / (TENSION_LOST * path.length)


def choose_stiffness(path: Path, belt: Belt, tension: float) -> Choice:
    """Choose the contact stiffness: that of the belt if known and hard enough.

    Slip is taken at the rim, and penetration does not change the radius at which a belt runs: a soft one spoils slip.
    """
    radius = float(np.min(np.abs(path.radii)))
    shallow, thin = DEPTH_OF_RADIUS * radius, DEPTH_OF_THICKNESS * belt.thickness
    reasons = {
        f"penetration reduces the tension by {TENSION_LOST:.1%}": stiffness_for_tension(path, belt),
        f"penetration is {DEPTH_OF_RADIUS:.1%} of the smallest radius": tension / (radius * shallow),
        f"penetration is {DEPTH_OF_THICKNESS:.0%} of the belt thickness": tension / (radius * thin),
        "compressibility of the belt": belt.contact_stiffness or 0.0,
    }
    reason = max(reasons, key=lambda name: reasons[name])
    return Choice("contact.stiffness", reasons[reason], "N/m^2", reason)


def critical_damping(stiffness: float, mass_per_length: float) -> float:
    """Critical damping 2 sqrt(k_p m) of a belt pressed on a pulley, N s/m^2."""
    return 2.0 * math.sqrt(stiffness * mass_per_length)


def choose_damping(stiffness: float, belt: Belt) -> Choice:
    """Choose the contact damping for a stiffness, N/m^2."""
    critical = critical_damping(stiffness, belt.mass_per_length)
    return Choice("contact.damping", DAMPING_RATIO * critical, "N*s/m^2", f"{DAMPING_RATIO:.0%} of critical")


def choose_creep_ratio(pulleys: Sequence[Pulley], grips: FloatArray, strain: float) -> Choice:
    """Choose the creep ratio of friction from grips mu phi of the pulleys and the strain T / EA at rest.

    Below the cap a slip velocity grows e-fold along an arc within the angle s EA / (mu T). At the rim's entry the belt
    creeps by what is left of it there, which elastic creep does not know. Pulleys without speed, torque, load and hub
    transmit next to nothing and do not count.
    """
    working = np.array([bool(one.speed or one.torque or one.load or one.hub) for one in pulleys])
    grip = float(np.min(grips[working & (grips > 0.0)], initial=math.pi))
    return Choice("contact.creep_ratio", grip * strain / CREEP_LENGTHS, "", "adds less than 3% to elastic creep")


def choose_standstill_creep(creep_ratio: float, speed: float, pulleys: Sequence[Pulley]) -> Choice:
    """Choose the creep velocity on pulleys at a standstill."""
    guides = [one.name for one in pulleys if one.stands_still]
    share = GUIDING if guides else STANDSTILL
    reason = f"as at {share:.0%} of the largest speed, {speed:.3g} m/s"
    reason += f"; {listing(guides)} stand{'s' * (len(guides) == 1)} still" if guides else ""
    return Choice("contact.standstill_creep", share * creep_ratio * speed, "m/s", reason)


def choose_elements(belt: OnPath, tension: float) -> Choice:
    """Choose the number of elements."""
    limits = OF_SINGLE_TEETH if belt.belt.has_single_teeth else RESOLVED
    needed = {name: fewest(belt, Running(tension), name, limit) for name, limit in limits.items()}
    name = max(needed, key=lambda name: needed[name])
    number = min(max(needed[name], FEWEST), MOST)
    reason = (
        f"estimated error of {name} {limits[name]:.1%}"
        if number == needed[name]
        else f"{needed[name]} would resolve speeds and tensions"
        if number == FEWEST
        else f"upper limit; {needed[name]} would resolve {name}"
    )
    finer = max(elements_needed(belt, Running(tension))[name] for name in PRESSURES)
    more = f"; contact pressures need {finer}" if finer > number else ""
    teeth = belt.belt.teeth
    if teeth is not None and belt.belt.has_single_teeth:
        number = teeth * math.ceil(number / teeth)
        more = f"; a whole number of them to a tooth{more}"
    return Choice("belt.elements", number, "", reason + more)


def choose_graded_elements(belt: OnPath, path: Path, tension: float, fineness: float) -> Choice:
    """Choose the number of elements of a staying mesh."""
    layer = layer_length(*layer_lengths(belt, tension))
    arcs = Laid.on(path, belt.belt_length, path.longest_span).arcs()
    number = graded_mesh(belt.belt_length, arcs, layer, fineness).size
    reason = f"a staying mesh with short elements within {1e3 * layer:.2g} mm of the ends of arcs"
    return Choice("belt.elements", min(number, MOST), "", reason if number <= MOST else f"upper limit; {reason}")
