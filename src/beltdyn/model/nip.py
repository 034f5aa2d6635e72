"""A nip: two rollers that press the belt between them."""

from collections.abc import Sequence
from math import hypot, inf, pi
from typing import NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.machines.tensioners.sliding import SlidingTensioner
from beltdyn.machines.tensioners.tensioner import MovingTensioner, SpringTensioner, Tensioner
from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, fastest_rim
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Force, Name
from beltdyn.theory.nip import (
    equivalent_radius,
    force,
    half_width,
    hertz_compliance,
    indentation_of,
    line_force,
    nip_damping,
    series,
)

_MAX_COMPRESSION = 0.5
"""Largest compression of a cover or of the belt between two rollers, over its thickness."""
_GAP_TOLERANCE = 1e-9
"""Gap between a roller and the belt, over the radius of the roller, that counts as contact: it may be rounding."""
DAMPER_RESISTANCE = 1e-5
"""Rolling resistance by contact damping on each side of a nip, over its force: 0.1 % of a load of 2 % of that force."""
_LARGEST_LOSS_FACTOR = 2.0
"""Upper bound of the loss factor of a nip's damper: where little is lost by deformation, `DAMPER_RESISTANCE` would
require an arbitrarily large factor."""


class Nip(Part):
    """A roller beside the path of the belt that presses it against a pulley, by a force or to a gap.

    The center of the roller tells the direction in which it presses; its distance follows from `force`, `gap`, or the
    preload of a tensioner that carries it. Without them, the roller stays where its center is.

    Examples
    --------
    >>> bd.model.Nip(roller="press", pulley="drum", force="2 kN").force
    2000.0
    """

    roller: Name = Field(description="the pulley beside the path that presses, by its name")
    pulley: Name = Field(description="the pulley against which it presses the belt, by its name")
    force: Force | None = Field(None, gt=0, description="the force with which the roller presses, in N")
    gap: Coordinate | None = Field(
        None,
        description="the gap between both undeformed rollers, less than the thickness of the belt; negative where soft "
        "covers would overlap, in m",
    )

    @model_validator(mode="after")
    def _is_loaded_once(self) -> Self:
        if self.force is not None and self.gap is not None:
            raise ValueError("force and gap exclude each other: one follows from the other. Remove one of them")
        if self.roller == self.pulley:
            raise ValueError(f'roller and pulley are both "{self.roller}". Name two pulleys')
        return self


def check_nips(nips: Sequence[Nip], pulleys: Sequence[Pulley], belt: Belt) -> None:
    """Refuse nips whose rollers are not there, not on both faces of the belt, or not held in place."""
    names = [one.name for one in pulleys]
    rollers = [nip.roller for nip in nips]
    for number, nip in enumerate(nips, 1):
        for key in ("roller", "pulley"):
            name = getattr(nip, key)
            if name not in names:
                raise ValueError(
                    f'nip[{number}].{key} = "{name}" is not the name of a pulley. Choose one of {", ".join(names)}'
                )
        if nip.pulley in rollers:
            raise ValueError(
                f'nip[{number}].pulley = "{nip.pulley}" is itself the roller of a nip, on which the belt does not lie. '
                "Press against a pulley of the path"
            )
        if rollers.count(nip.roller) > 1:
            raise ValueError(
                f'nip[{number}].roller = "{nip.roller}" presses in {rollers.count(nip.roller)} nips. Give each nip a '
                "roller of its own"
            )
        roller, pulley = pulleys[names.index(nip.roller)], pulleys[names.index(nip.pulley)]
        if roller.side == pulley.side:
            other = "outside" if pulley.side == "inside" else "inside"
            raise ValueError(
                f'nip[{number}]: "{roller.name}" and "{pulley.name}" are both on the {pulley.side} of the belt, but a '
                f'nip has a roller on each face. Set side = "{other}" for "{roller.name}"'
            )
        if roller.surface is not None and roller.surface.kind != "circle":
            raise ValueError(f'nip[{number}].roller = "{roller.name}" is not a smooth circle. Omit its surface')
        if nip.gap is not None and nip.gap >= belt.thickness:
            raise ValueError(
                f"nip[{number}].gap = {nip.gap:.4g} m does not press the belt of {belt.thickness:.4g} m. Reduce it, or "
                "give force"
            )
    if nips and belt.teeth is not None:
        raise ValueError("[[nip]] is incompatible with a belt with teeth. Remove one of them")


def refuse_nips(nips: Sequence[Nip], what: str) -> None:
    """Make sure that what knows no nips is not asked of a drive that has some."""
    if nips:
        raise ModelError(
            f'{what} has a belt without thickness, which knows no nip, such as that of "{nips[0].roller}". Use '
            "`beltdyn steady-state`, `beltdyn modes`, `beltdyn operating-map` or `beltdyn simulate`, or remove "
            "its [[nip]]."
        )


def on_slides(nips: Sequence[Nip], pulleys: Sequence[Pulley]) -> tuple[tuple[Nip, ...], list[SlidingTensioner]]:
    """Nips without forces, and slides that press their rollers with these: over time and in vibrations they move."""
    free, slides = list[Nip](), list[SlidingTensioner]()
    for number, (nip, (one, other)) in enumerate(zip(nips, numbered(nips, pulleys), strict=True), 1):
        if nip.force is not None:
            if pulleys[one].mass == 0.0:
                raise ModelError(
                    f"nip[{number}].force = {nip.force:.4g} N moves the roller over time and in vibrations, but it has "
                    f'no mass. Give mass for the pulley "{nip.roller}", or gap, which `beltdyn.derived.nips` has of '
                    "steady running."
                )
            way = np.subtract(pulleys[other].center, pulleys[one].center).tolist()
            slides.append(SlidingTensioner(kind="sliding", pulley=nip.roller, direction=way, preload=nip.force))
        free.append(nip.replace(force=None))
    return tuple(free), slides


def tensioning(tensioners: Sequence[Tensioner], nips: Sequence[Nip]) -> list[MovingTensioner]:
    """Spring-loaded tensioners but those that press the rollers of nips."""
    rollers = [nip.roller for nip in nips]
    return [one for one in tensioners if isinstance(one, MovingTensioner) and one.pulley not in rollers]


def _force(nip: Nip, roller: Pulley, pulley: Pulley, tensioners: Sequence[Tensioner]) -> float | None:
    """Force of a nip, or that of the preload of what carries its roller, N."""
    carrier = next((one for one in tensioners if isinstance(one, MovingTensioner) and one.pulley == nip.roller), None)
    if carrier is None:
        return nip.force
    if not isinstance(carrier, SpringTensioner):
        raise ValueError(
            f'the tensioner of "{nip.roller}" presses the roller of a nip, but has no preload. Use one with a spring '
            "of constant rate, or give the force of the nip"
        )
    center, way = np.array(roller.center), np.subtract(pulley.center, roller.center)
    arm = 1.0 if not carrier.turns else carrier.reach(center)
    try:
        lever = abs(carrier.leverage(center, way / np.hypot(*way)))
    except ValueError:
        raise ValueError(
            f'the tensioner of "{nip.roller}" does not press it against "{nip.pulley}". Turn its direction, or move '
            "its pivot"
        ) from None
    found = carrier.preload / (arm * lever)
    if not found > 0.0:
        raise ValueError(
            f'the tensioner of "{nip.roller}" has preload = {carrier.preload:.4g}, but it is to press the roller of a '
            "nip. Give a positive one"
        )
    return float(found)


def numbered(nips: Sequence[Nip], pulleys: Sequence[Pulley]) -> tuple[tuple[int, int], ...]:
    """Numbers of roller and pulley of each nip."""
    names = [one.name for one in pulleys]
    return tuple((names.index(nip.roller), names.index(nip.pulley)) for nip in nips)


def touching_distance(roller: Pulley, pulley: Pulley, belt: Belt) -> float:
    """Distance of two centers at which the rollers touch the belt between them without pressing it, m."""
    return roller.radius + pulley.radius + belt.pitch_offset + belt.back_offset


def placed(
    nips: Sequence[Nip],
    pulleys: tuple[Pulley, ...],
    belt: Belt,
    stiffness: float,
    tensioners: Sequence[Tensioner] = (),
) -> tuple[Pulley, ...]:
    """Pulleys with the rollers of nips where gap, force, or the preload of what carries them put them.

    `stiffness` is that of contact, N/m^2; infinity places rollers that press by a force where they touch.
    """
    found = list(pulleys)
    for nip, (one, other) in zip(nips, numbered(nips, pulleys), strict=True):
        roller, pulley = pulleys[one], pulleys[other]
        x, y = np.subtract(roller.center, pulley.center).tolist()
        size = hypot(x, y)
        if size == 0.0:
            raise ValueError(
                f'"{roller.name}" has the center of "{pulley.name}", so that the direction in which it presses is '
                "unknown. Move it to the side at which it presses"
            )
        load = _force(nip, roller, pulley, tensioners)
        if nip.gap is not None:
            depth = belt.thickness - nip.gap
        elif load is not None:
            depth = 0.0
            if np.isfinite(stiffness):
                depth = Pair.of(roller, pulley, belt, stiffness).indentation_of(load)
        else:
            continue
        apart = touching_distance(roller, pulley, belt) - depth
        center = pulley.center[0] + apart * x / size, pulley.center[1] + apart * y / size
        found[one] = roller.replace(center=center)
    return tuple(found)


def _sizes(roller: Pulley, pulley: Pulley, belt: Belt) -> tuple[float, float]:
    """Effective radii of both, m."""
    return tuple(one.radius + belt.offset(one.side, one.teeth is not None) for one in (roller, pulley))  # type: ignore


class Pair(NamedTuple):
    """The rollers of a nip with the belt between them, as `theory.nip` sees them."""

    stiffness: float
    """K of the foundations on both sides in series, N/m^2."""
    radius: float
    """R, m."""
    hertz: float
    """A of solid rollers, m^3/N^2."""
    lasting: float = 0.0
    """Compression of the belt that stays behind the nip over the line force, m^2/N."""

    @classmethod
    def of(cls, roller: Pulley, pulley: Pulley, belt: Belt, stiffness: float) -> Self:
        """The pair of a nip, with the stiffness of contact, N/m^2."""
        sides = [side_stiffness(one, belt, stiffness) for one in (roller, pulley)]
        radius = equivalent_radius(*_sizes(roller, pulley, belt))
        modulus = series(*(inf if one.cover is None else one.cover.solid_modulus for one in (roller, pulley)))
        lasting = 2.0 * belt.compression_set / stiffness
        return cls(series(*sides), radius, hertz_compliance(modulus, radius, belt.width), lasting)

    def force(self, indentation: float) -> float:
        """Force at an indentation (m), N: half of those of a belt that is pressed, and of one that leaves."""
        pressed = force(indentation, self.stiffness, self.radius, self.hertz)
        if self.lasting == 0.0:
            return pressed
        left = indentation - self.lasting * self.peak(indentation)
        leaving = 1.0 / (1.0 / self.stiffness - self.lasting)
        return 0.5 * (pressed + force(left, leaving, self.radius, self.hertz))

    def indentation_of(self, load: float) -> float:
        """Indentation under a force (N), m."""
        found = indentation_of(load, self.stiffness, self.radius, self.hertz)
        if self.lasting == 0.0:
            return found
        from scipy.optimize import brentq

        return float(brentq(lambda depth: self.force(depth) - load, found, 2.0 * found, xtol=1e-15))

    def half_width(self, indentation: float) -> float:
        """Half of the width of the nip, m."""
        return half_width(max(indentation, 0.0), self.radius)

    def peak(self, indentation: float) -> float:
        """Line force on the line of centers, N/m."""
        return float(line_force(np.array(max(indentation, 0.0)), self.stiffness, self.hertz))

    def slope(self, indentation: float) -> float:
        """Growth of the force with the indentation, N/m."""
        step = 1e-4 * indentation
        return (self.force(indentation + step) - self.force(indentation - step)) / (2.0 * step)


def side_stiffness(pulley: Pulley, belt: Belt, stiffness: float) -> float:
    """Stiffness of a pulley's cover and the belt on it in series, N/m^2, with that of contact without a cover."""
    return stiffness if pulley.cover is None else series(pulley.cover.stiffness(belt.width), stiffness)


def foundations(pulleys: Sequence[Pulley], belt: Belt, stiffness: float) -> FloatArray:
    """Stiffness of contact with each pulley over that of a pulley without cover, shape (n,)."""
    return np.array([side_stiffness(one, belt, stiffness) / stiffness for one in pulleys])


def has_losses(pulleys: Sequence[Pulley], belt: Belt) -> bool:
    """Whether covers or the belt lose by compression in nips."""
    return any([belt.compression_loss_factor, *(one.cover.loss_factor for one in pulleys if one.cover is not None)])


def damping_ratios(path: Path, pulleys: Sequence[Pulley], belt: Belt, contact: Contact | None) -> FloatArray:
    """Damping over stiffness of contact with each pulley against that of the law, shape (n,).

    A damper c on a foundation k takes 2 c v a^3 / 3 R^2 of the line of centers where a nip of the half width a passes
    with v, in place of the loss pi / 4 eta k d^2 of hysteresis with d = a^2 / 2 R. Without loss factors a nip resists
    rolling by `DAMPER_RESISTANCE` at most.
    """
    found, speed, is_lossy = np.ones(len(pulleys)), fastest_rim(pulleys, np.abs(path.radii)), has_losses(pulleys, belt)
    damping = 0.0 if contact is None else contact.given("damping")
    if contact is None or not (is_lossy or damping * speed > 0.0):
        return found
    if damping == 0.0:
        raise ModelError(
            "contact.damping = 0 leaves no damper for the loss factors of covers and belt in nips. Omit it, or the "
            "loss factors."
        )
    stiffness = contact.given("stiffness")
    for pair, depth in zip(path.nips, path.indentations.tolist(), strict=True):
        rollers = [pulleys[one] for one in pair]
        both = Pair.of(rollers[0], rollers[1], belt, stiffness)
        for one, solid in zip(pair, (both.hertz, 0.0), strict=True):
            linear = 1.0 / side_stiffness(pulleys[one], belt, stiffness)
            curved = 4.0 / 3.0 * solid * both.peak(depth)
            share = curved / (linear + curved)
            if is_lossy:
                lost = (1.0 - share) * _loss_factor(pulleys[one], belt, stiffness) + share * _solid_loss_factor(rollers)
            else:
                lost = _loss_factor_of_damper(both, depth, (1.0 - share) / 4.0 + share / 3.0, linear + curved)
            ratio = nip_damping(lost, both.half_width(depth), speed, share) * stiffness / damping
            found[one] = ratio if is_lossy else min(ratio, 1.0)
    return found


def _loss_factor_of_damper(pair: Pair, depth: float, form: float, compliance: float) -> float:
    """Loss factor at which a side of a nip has `DAMPER_RESISTANCE`, for its compliance (m^2/N) and form of losses."""
    lost = pi * form * compliance * pair.peak(depth) ** 2
    return min(DAMPER_RESISTANCE * pair.force(depth) / lost, _LARGEST_LOSS_FACTOR) if lost > 0.0 else 0.0


def _solid_loss_factor(pair: Sequence[Pulley]) -> float:
    """Loss factor of the solid rollers of a nip, by their shares of the energy."""
    solid = [one.cover for one in pair if one.cover is not None and one.cover.thickness is None]
    compliances = [1.0 / one.solid_modulus for one in solid]
    lost = sum(one.loss_factor * own for one, own in zip(solid, compliances, strict=True))
    return lost / sum(compliances) if solid else 0.0


def _loss_factor(pulley: Pulley, belt: Belt, stiffness: float) -> float:
    """Loss factor of a pulley's cover and the belt on it in series, by their shares of the energy."""
    side = side_stiffness(pulley, belt, stiffness)
    of_cover = 0.0 if pulley.cover is None else pulley.cover.loss_factor * side / pulley.cover.stiffness(belt.width)
    return of_cover + belt.compression_loss_factor * side / stiffness


def beside_the_path(path: Path, pulleys: Sequence[Pulley], belt: Belt, stiffness: float) -> dict[str, FloatArray]:
    """What rollers of nips have more than pulleys, shapes (n,): Hertz of the pair, and the set of the belt."""
    found = {"hertz": np.zeros(len(pulleys)), "lasting": np.zeros(len(pulleys)), "unloading": np.ones(len(pulleys))}
    for (roller, pulley), depth in zip(path.nips, path.indentations.tolist(), strict=True):
        pair = Pair.of(pulleys[roller], pulleys[pulley], belt, stiffness)
        found["hertz"][roller] = pair.hertz
        found["lasting"][roller] = pair.lasting * pair.peak(depth)
        found["unloading"][roller] = 1.0 / (1.0 - pair.lasting * side_stiffness(pulleys[roller], belt, stiffness))
    return found


def refuse_set(belt: Belt, nips: Sequence[Nip], what: str) -> None:
    """Make sure that a belt with a lasting compression is only asked for steady running."""
    if nips and belt.compression_set > 0.0:
        raise ModelError(
            f"belt.compression_set = {belt.compression_set:g} is that of a belt that runs steadily through its nips, "
            f"and {what} would need its history. Compute it with `beltdyn steady-state`, or omit compression_set."
        )


def rim_ratios(pairs: Sequence[tuple[int, int]], pulleys: Sequence[Pulley], radii: FloatArray) -> FloatArray:
    """Radius at which the tension line rolls off over the effective radius, shape (n,): 1 but of rollers of nips.

    The face of a belt bent on a pulley of the effective radius r moves faster than the tension line, by 1 + o / r at
    the distance o.
    """
    found = np.ones(len(pulleys))
    for roller, pulley in pairs:
        own = pulleys[roller].radius
        found[roller] = own / (radii[roller] * (1.0 + (radii[roller] - own) / radii[pulley]))
    return found


def check_places(nips: Sequence[Nip], path: Path, pulleys: Sequence[Pulley], belt: Belt) -> None:
    """Refuse rollers that press where no belt lies, that do not reach it, or that leave it no room."""
    for number, (nip, (one, other), depth, angle) in enumerate(
        zip(nips, path.nips, path.indentations.tolist(), path.nip_angles.tolist(), strict=True), 1
    ):
        roller, pulley, wrap = pulleys[one], pulleys[other], float(path.wrap_angles[other])
        if angle > wrap:
            beyond = min(angle - wrap, 2.0 * pi - angle)
            raise ValueError(
                f'nip[{number}]: the belt does not lie on "{pulley.name}" where "{roller.name}" presses; its arc ends '
                f"{np.degrees(beyond):.3g}° before. Move the center of the roller"
            )
        if depth < -_GAP_TOLERANCE * roller.radius:
            raise ValueError(
                f'nip[{number}]: "{roller.name}" does not reach the belt on "{pulley.name}": it is {-depth:.4g} m '
                "away. Move its center, or give force or gap"
            )
        covers = [each.cover for each in (roller, pulley) if each.cover is not None]
        room = belt.thickness + sum(roller.radius if one.thickness is None else one.thickness for one in covers)
        if depth > _MAX_COMPRESSION * room:
            asked = "" if nip.force is None else f" by a force of {nip.force:.4g} N"
            raise ValueError(
                f'nip[{number}] is too tight: "{roller.name}" and "{pulley.name}" would be pressed together by '
                f"{depth:.4g} m{asked}, beyond {_MAX_COMPRESSION:.0%} of the {room:.4g} m of belt and covers between "
                "them. Reduce force, open the gap, or give a thicker or harder cover"
            )
        half = half_width(max(depth, 0.0), equivalent_radius(*np.abs(path.radii[[one, other]]).tolist()))
        if half > min(angle, wrap - angle) * abs(float(path.radii[other])):
            raise ValueError(
                f'nip[{number}]: the nip of "{roller.name}" is {2.0 * half:.4g} m wide and reaches beyond the arc on '
                f'"{pulley.name}". Move the center of the roller to the middle of the arc'
            )
