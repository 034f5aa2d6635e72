"""What sections 1 to 3 of the paper say of the element: rigid motion, mass, factors on stiffness, locking, a circle."""

from collections.abc import Mapping
from math import pi

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive
from beltdyn.state.static import find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.observe import observe
from beltdyn.system.state import State, at_rest, belt_section, straight
from validation.paper.numbers import power_of_ten
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, verdict

_HELD = ((0, 0), (0, 1), (0, 4), (0, 5))
"""A clamp holds place and section; the tangent is free to stretch and to shear against it."""

_ROUNDING = 1e-12
_SMALL = 1e-6
_FACTORS = (1e-3, 1.0, 1e3)
_THICKNESSES = (1e-1, 1e-2, 1e-3, 1e-4)
_POISSONS_RATIOS = (0.0, 0.3, 0.49)
_LOCKED = 0.01
_LARGE, _DEFLECTION = 10.0, 0.81061
"""P L^2 / E I of a large load, and the deflection over L that the elastica has under it (Mattiasson 1981)."""

_CLOSED = 5e-3
_MOTIONS = 1000


def cases() -> Mapping[str, Drive]:
    """Nothing is simulated over time."""
    return {}


def section(_: Runs) -> Section:
    """Single belts, moved and bent."""
    return Section(
        "element",
        "The element (Eqs. 1 to 16)",
        "A straight belt of 1 m with 4 elements, E = 10⁸ Pa and ν = 0.3, a hundred times as long as thick unless said "
        "otherwise; as a cantilever, its clamp holds place and section.",
        [_rigid_motion(), _constant_mass(), _no_locking(), _factors(), _circle()],
    )


def _belt(thickness: float = 1e-2, elements: int = 4, poissons_ratio: float = 0.3, **factors: float) -> Belt:
    return Belt(
        length=1.0,
        width=0.01,
        thickness=thickness,
        density=1000.0,
        youngs_modulus=1e8,
        poissons_ratio=poissons_ratio,
        shear_correction=10.0 * (1.0 + poissons_ratio) / (12.0 + 11.0 * poissons_ratio),
        elements=elements,
        **factors,
    )


def _cantilever(belt: Belt, force: tuple[float, float] = (0.0, 0.0), moment: float = 0.0) -> System:
    return belt_system(belt, closure="open", fixed=_HELD, forces=[(-1, force)], moments=[(-1, moment)])


def _bent(system: System, start: State | None = None) -> FloatArray:
    """Nodal coordinates in equilibrium, shape (nodes, 6)."""
    return find_equilibrium(system, start or straight(system)).state.nodes(system)


def _moved() -> tuple[System, FloatArray, FloatArray, FloatArray]:
    """A free belt in rigid motions: positions, velocities, shape (k, unknowns), and kinetic energies, J, by hand."""
    belt, rng = _belt(), np.random.default_rng(2006)
    system = belt_system(belt)
    vectors = straight(system).nodes(system).reshape(-1, 3, 2)
    angle, speed = rng.uniform(-pi, pi, _MOTIONS), rng.uniform(-100.0, 100.0, _MOTIONS)
    shift, drift = rng.uniform(-1.0, 1.0, (2, _MOTIONS, 1, 2))
    turn = np.stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)], axis=1).reshape(-1, 1, 2, 2)
    position = vectors @ turn
    velocity = speed[:, None, None, None] * np.stack([-position[..., 1], position[..., 0]], axis=-1)
    of_center = velocity[:, :, 0].mean(axis=1) + drift[:, 0]
    position[:, :, 0] += shift
    velocity[:, :, 0] += drift
    mass = belt.density * belt.area * belt.given_length
    inertia = mass * (belt.given_length**2 + belt.thickness**2) / 12.0
    by_hand = 0.5 * (mass * np.sum(of_center**2, axis=1) + inertia * speed**2)
    return system, position.reshape(_MOTIONS, -1), velocity.reshape(_MOTIONS, -1), by_hand


def _rigid_motion() -> Statement:
    system, position, velocity, by_hand = _moved()
    seen, belt = observe(system, np.zeros(_MOTIONS), position, velocity), _belt()
    strain = float(np.sqrt(2.0 * seen.strain_energy.max() / (belt.axial_stiffness * belt.given_length)))
    energy = float(np.max(np.abs(seen.kinetic_energy / by_hand - 1.0)))
    numbers = [
        Number("rigid motions, at random", _MOTIONS),
        Number("largest strain", strain),
        Number("kinetic energy less that of a rigid bar, at most", energy, "%"),
    ]
    return Statement(
        name="rigid-motion",
        title="Rigid motion is exact and strains nothing",
        quote="exact modeling of the rigid body inertia resulting in zero strains must be obtained. … The absolute "
        "coordinate formulation leads to an exact description of an arbitrary rigid body motion",
        page=240,
        criterion="Turned by any angle, shifted and moving, the belt has no strain energy, and the kinetic energy of a "
        "rigid bar, both to rounding: a strain, and a part, of 10⁻¹².",
        findings=[Finding("as published", numbers, verdict(max(strain, energy) < _ROUNDING))],
        remark="The strain is √(2U/EAL), that of a uniform stretch with the same energy.",
    )


def _constant_mass() -> Statement:
    system, position, velocity, _ = _moved()
    rng = np.random.default_rng(1)
    deformed = position * (1.0 + 0.2 * rng.standard_normal(position.shape))
    same = np.broadcast_to(velocity[0], velocity.shape)
    energies = observe(system, np.zeros(_MOTIONS), deformed, np.ascontiguousarray(same)).kinetic_energy
    spread = float(np.ptp(energies) / energies.mean())
    numbers = [
        Number("deformed places, at random", _MOTIONS),
        Number("range of the kinetic energy over its mean", spread, "%"),
    ]
    return Statement(
        name="constant-mass-matrix",
        title="The mass matrix is constant",
        quote="M is the constant mass matrix of the system",
        page=247,
        criterion="Nodal velocities have the same kinetic energy in whatever place and shape the belt is, to rounding.",
        findings=[Finding("as published", numbers, verdict(spread < _ROUNDING))],
    )


def _no_locking() -> Statement:
    errors = {}
    for thickness in _THICKNESSES:
        for ratio in _POISSONS_RATIOS:
            belt = _belt(thickness, poissons_ratio=ratio)
            cross_section, load = belt_section(belt), _SMALL * belt.bending_stiffness
            timoshenko = load / (3.0 * cross_section.bending) + load / cross_section.shear
            errors[thickness, ratio] = abs(_bent(_cantilever(belt, (0.0, load)))[-1, 1] / timoshenko - 1.0)
    small = [
        Number(f"h/L = {power_of_ten(thickness)}, ν = {ratio:g}: deflection, error", errors[thickness, ratio], "%")
        for thickness in _THICKNESSES
        for ratio in (_POISSONS_RATIOS[0], _POISSONS_RATIOS[-1])
    ]
    large, worst = [], 0.0
    for elements in (4, 8, 16):
        for thickness in _THICKNESSES[1:3]:
            error = _large_deflection(thickness, elements) / _DEFLECTION - 1.0
            worst = max(worst, abs(error)) if elements > 4 else worst
            large.append(Number(f"{elements} elements, h/L = {power_of_ten(thickness)}: error", error, "%"))
    return Statement(
        name="no-shear-or-poisson-locking",
        title="There is no shear locking and no Poisson locking",
        quote="the capability of accurately predicting the nonlinear deformations without suffering from shear or "
        "Poisson’s locking",
        page=241,
        criterion="A small force at the tip of the cantilever bends it as in Timoshenko’s theory, to 1 %, however thin "
        "it is and whatever ν. Second table: under P L² / EI = 10, where it deflects by 0.81 L, 8 elements "
        "and more are within 1 % of the elastica.",
        findings=[
            Finding("4 elements, small load", small, verdict(max(errors.values()) < _LOCKED)),
            Finding("large load", large, verdict(worst < _LOCKED)),
        ],
        remark="The second table gets worse as the belt gets thinner: a cubic that is bent far has to stretch. That is "
        "membrane locking, of which the sentence does not speak, and which raises the tensions of coarse meshes below.",
        departures=("nodal-shear", "shear-correction", "tension-on-coarse-meshes"),
    )


def _large_deflection(thickness: float, elements: int) -> float:
    """Deflection of the tip over the length under the large load, which grows in steps."""
    belt, state = _belt(thickness, elements), None
    for load in np.linspace(0.0, _LARGE, 6)[1:]:
        system = _cantilever(belt, (0.0, float(load) * belt.bending_stiffness))
        state = find_equilibrium(system, state or straight(system)).state
    assert state is not None
    return float(state.nodes(system)[-1, 1])


def _factors() -> Statement:
    def stiffnesses(axial: float, bending: float) -> tuple[float, float]:
        """E A and E I that a small pull and a small moment at the tip find, over E A and E I without factors."""
        belt, whole = _belt(axial_factor=axial, bending_factor=bending), _belt()
        pull, moment = _SMALL * whole.axial_stiffness * axial, _SMALL * whole.bending_stiffness * bending
        stretch = _bent(_cantilever(belt, (pull, 0.0)))[-1, 0] - 1.0
        deflection = _bent(_cantilever(belt, moment=moment))[-1, 1]
        return pull / stretch / whole.axial_stiffness, 0.5 * moment / deflection / whole.bending_stiffness

    found = {(one, two): stiffnesses(one, two) for one in _FACTORS for two in _FACTORS}
    numbers, worst = [], 0.0
    for kind, name in enumerate(("EA / α₁", "EI / α₂")):
        for factor in _FACTORS:
            parts = [value[kind] / pair[kind] - 1.0 for pair, value in found.items() if pair[kind] == factor]
            off = max(parts, key=abs)
            worst = max(worst, abs(off))
            label = f"α{'₁₂'[kind]} = {factor:g}, any α{'₂₁'[kind]}"
            numbers.append(Number(f"{label}: {name} off by at most", off, "%"))
    return Statement(
        name="factors-act-linearly",
        title="α₁ and α₂ act linearly on the axial and the bending stiffness",
        quote="In case of small strains, parameters α1 and α2 linearly affect the axial and bending stiffness of the "
        "element.",
        page=243,
        criterion="A pull and a moment that strain the cantilever by 10⁻⁶ find α₁ EA and α₂ EI to 10⁻⁵, for factors "
        "from 10⁻³ to 10³, whatever the other factor.",
        findings=[Finding("as published", numbers, verdict(worst < 10.0 * _SMALL))],
        remark="What is left of EA is 1.5 times the strain: the measure of strain is quadratic.",
        departures=("eq-11",),
    )


def _circle() -> Statement:
    def finding(elements: int) -> Finding:
        belt = _belt(elements=elements)
        system = _cantilever(belt, moment=2.0 * pi * belt.bending_stiffness)
        angles = np.linspace(0.0, 2.0 * pi, elements + 1)
        places = np.stack([np.sin(angles), 1.0 - np.cos(angles)], axis=1) / (2.0 * pi)
        tangents = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        normals = np.stack([-tangents[:, 1], tangents[:, 0]], axis=1)
        nodes = _bent(system, at_rest(system, np.hstack([places, tangents, normals])))
        turns = np.unwrap(np.arctan2(-nodes[:, 4], nodes[:, 5]), period=2.0 * pi)
        gap = float(np.hypot(*nodes[-1, :2])) * pi
        numbers = [
            Number("the tip turns by", float(turns[-1]) / (2.0 * pi), "%", digits=4),
            Number("distance of the ends over the diameter", gap, "%"),
            Number("a cubic misses the circle by, over the diameter", 0.5 * (2.0 * pi / elements) ** 4 / 384.0, "%"),
        ]
        return Finding(f"{elements} elements", numbers, verdict(gap < _CLOSED))

    return Statement(
        name="four-elements-make-a-circle",
        title="Four elements bend into a circle",
        quote="It is shown in Ref. [12] that the use of only four elements enables the bending of a cantilever beam "
        "into a circle when a certain concentrated moment is applied at the free end.",
        page=244,
        criterion="Under M = 2π EI / L the ends meet to 0.5 % of the circle’s diameter, the width of a line in a "
        "figure. The percentage of the turn is that of 360°.",
        findings=[finding(elements) for elements in (4, 8, 16)],
        remark="With four elements the cantilever bends into a ring whose ends stay visibly apart. The figure of "
        "Ref. [12] was not at hand.",
        departures=("moments", "tension-on-coarse-meshes"),
    )
