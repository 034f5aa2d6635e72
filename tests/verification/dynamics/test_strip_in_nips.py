"""Verified: the draw of a web through nips, by a strip that is pressed on two foundations and rubs on both faces.

The strip is a beam under tension between two one-sided foundations, which give its penetrations d_1 and d_2.  Along it
Coulomb friction with linear creep acts on both faces, and the tension less the energy of the foundations changes by
that alone, from the end of the web, where it is known, to its beginning.  A face meets the surface of its roller with
v cos d', since the tension line is not parallel to it: where friction on both sides of the nip is nothing in all, v
is faster than the rim.
"""

from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import spsolve

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model.nip import side_stiffness

pytestmark = pytest.mark.slow

STIFFNESS, BENDING, MASS, FRICTION = 8e5, 0.01, 0.48, 0.3
ENTERS, LEAVES, DRAW = 400.0, 500.0, 2e-4
REACH, POINTS, ARC_POINTS = 0.012, 961, 1000
"""Half of the length of strip around a nip, m, and numbers of points there and on an arc."""


class Strip(NamedTuple):
    """A length of strip between the surfaces of a roller and the pulley below it."""

    step: float
    """m."""
    normal: FloatArray
    """Normal forces of pulley and roller, N/m, shape (n, 2); NaN of a pulley on which it is only wrapped."""
    energy: FloatArray
    """Of the foundations, N, shape (n,)."""
    slope: FloatArray
    """Cosines of the slopes against both surfaces, shape (n, 2)."""
    radius: float
    """Of the pulley, m."""


class Nip(NamedTuple):
    """A roller that presses the strip on a pulley, and turns with it."""

    place: float
    """On the arc, m."""
    pull: float
    """Of the roller on the strip, N."""
    strip: Strip


def pressed(prepared: Any, number: int, tension: float, tilted: bool) -> Nip:
    """The strip in a nip: E I d'''' - T d'' + k_1 d_1 = k_2 d_2 + T / R_1 with d_1 + d_2 = d - x^2 / 2 R."""
    path, (roller, pulley) = prepared.path, prepared.path.nips[number]
    outer, inner = abs(float(path.radii[roller])), abs(float(path.radii[pulley]))
    below, above = (
        side_stiffness(prepared.pulleys[one], prepared.belt, prepared.contact_stiffness) for one in (pulley, roller)
    )
    x = np.linspace(-REACH, REACH, POINTS)
    step = float(x[1] - x[0])
    curved = np.eye(POINTS, k=1) + np.eye(POINTS, k=-1) - 2.0 * np.eye(POINTS)
    curved[0, 1] = curved[-1, -2] = 2.0  # along the surface at both ends
    second = csr_array(curved / step**2)
    beam = BENDING * second @ second - tension * second

    def shape(depth: float) -> tuple[FloatArray, FloatArray]:
        between = depth - 0.5 * x**2 * (1.0 / inner + 1.0 / outer)
        one = np.full(POINTS, tension / inner / below)
        for _ in range(100):
            here, there = one > 0.0, between > one
            stiff = diags_array(below * here + above * there)
            before, one = one, spsolve((beam + stiff).tocsc(), above * there * between + tension / inner)
            if np.abs(one - before).max() < 1e-12:
                break
        return one, between - one

    force = float(prepared.drive.nips[number].force)
    depth = brentq(lambda d: step * above * np.maximum(shape(d)[1], 0.0).sum() - force, 5e-5, 1e-3, xtol=1e-10)
    ways = np.stack(shape(depth), axis=1)
    normal = np.maximum(ways, 0.0) * [below, above]
    slope = 1.0 - 0.5 * tilted * np.gradient(ways, step, axis=0) ** 2
    strip = Strip(step, normal, 0.5 * (normal**2 / [below, above]).sum(axis=1), slope, inner)
    pull = abs(float(prepared.drive.pulleys[roller].torque.at([0.0])[0])) / float(prepared.rolling_radii[roller])
    return Nip(float(path.nip_angles[number]) * inner, pull, strip)


def wrapped(length: float, radius: float) -> Strip:
    """The strip on an arc."""
    alone = np.stack([np.full(ARC_POINTS, np.nan), np.zeros(ARC_POINTS)], axis=1)
    return Strip(length / ARC_POINTS, alone, np.zeros(ARC_POINTS), np.ones((ARC_POINTS, 2)), radius)


def before(strip: Strip, behind: float, flow: float, rims: tuple[float, float], creep: float) -> tuple[float, float]:
    """Tension before a strip, N, from that behind it, and the pull of the roller, N."""
    tension, pull = behind, 0.0
    for (below, above), energy, slope in zip(
        strip.normal[::-1].tolist(), strip.energy[::-1].tolist(), strip.slope[::-1].tolist(), strict=True
    ):
        pressing = (tension - MASS * rims[0] ** 2) / strip.radius if np.isnan(below) else below
        limits = [strip.step * FRICTION * one for one in (pressing, above)]
        rates = [flow * cosine / rim for cosine, rim in zip(slope, rims, strict=True)]
        tension, gripped = _grip(tension, energy, limits, rates, creep)
        pull += gripped
    return tension, pull


def _grip(behind: float, energy: float, limits: list[float], rates: list[float], creep: float) -> tuple[float, float]:
    """Tension before a point and the friction of the roller there, by Newton's method with bisection, N."""
    low, high = behind - sum(limits) - 1e-9, behind + sum(limits) + 1e-9
    tension = behind
    while True:
        slips = [(rate * (1.0 + (tension + energy) / STIFFNESS) - 1.0) / creep for rate in rates]
        forces = [-limit * min(max(slip, -1.0), 1.0) for limit, slip in zip(limits, slips, strict=True)]
        off = tension - behind - sum(forces)
        low, high = (low, tension) if off > 0.0 else (tension, high)
        sticks = (limit * (abs(slip) < 1.0) * rate for limit, slip, rate in zip(limits, slips, rates, strict=True))
        change = off / (1.0 + sum(sticks) / creep / STIFFNESS)
        if abs(change) < 1e-8:
            return tension, forces[1]
        tension = tension - change if low <= tension - change <= high else 0.5 * (low + high)


def before_nip(nip: Nip, behind: float, flow: float, rim: float, creep: float) -> tuple[float, float]:
    """Tension before a nip, N, and the speed of its roller over that of the pulley, which its pull sets."""

    def through(faster: float) -> tuple[float, float]:
        return before(nip.strip, behind, flow, (rim, rim * (1.0 + faster)), creep)

    faster = brentq(lambda one: through(one)[1] - nip.pull, -2e-3, 2e-3, xtol=1e-9)
    return through(faster)[0], 1.0 + faster


def before_pulley(
    nips: list[Nip], arc: float, behind: float, flow: float, rim: float, creep: float
) -> tuple[float, list[float]]:
    """Tension before a pulley, N, and the speeds of the rollers on it over its own, the last first."""
    radius, ratios, tension = nips[0].strip.radius, list[float](), behind
    ends = [arc, *(one.place for one in reversed(nips)), 0.0]
    for (end, start), nip in zip(pairwise(ends), [*reversed(nips), None], strict=True):
        tension, _ = before(wrapped(end - start, radius), tension, flow, (rim, rim), creep)
        if nip is not None:
            tension, ratio = before_nip(nip, tension, flow, rim, creep)
            ratios.append(ratio)
    return tension, ratios


def between_steel_rollers(prepared: Any, tilted: bool) -> tuple[float, list[float]]:
    """Tension between the steel rollers of the calender, N, and speeds of its others over those of their pulleys."""
    creep, rim = prepared.friction_parameters.creep_ratio, 2.0 * np.pi * float(prepared.rolling_radii[0])
    nips = [pressed(prepared, number, ENTERS, tilted) for number in range(3)]
    arcs = (prepared.path.wrap_angles * np.abs(prepared.path.radii)).tolist()
    first = partial(before_pulley, nips[:2], arcs[0], rim=rim, creep=creep)
    second = partial(before_pulley, nips[2:], arcs[1], LEAVES, rim=rim * (1.0 + DRAW), creep=creep)
    nominal = rim / (1.0 + ENTERS / STIFFNESS)

    def off(faster: float) -> float:
        flow = nominal * (1.0 + faster)
        return float(first(second(flow=flow)[0], flow=flow)[0] - ENTERS)

    flow = nominal * (1.0 + brentq(off, -1e-4, 2e-4, xtol=1e-8))
    tension, last = second(flow=flow)
    return tension, [*first(tension, flow=flow)[1][::-1], *last]


def test_a_nip_passes_the_web_faster_than_its_rim() -> None:
    """The draw of the five-roller calender: 560 N by speeds alone, less 22 N by slopes, to a tenth of that."""
    drive = bd.load(Path(__file__).parents[3] / "docs" / "tasks" / "calender5.toml")
    run = bd.steady_state(drive)
    by_speeds, _ = between_steel_rollers(run.prepared, tilted=False)
    assert by_speeds == pytest.approx(ENTERS + STIFFNESS * DRAW * (1.0 + ENTERS / STIFFNESS), abs=0.2)
    expected, ratios = between_steel_rollers(run.prepared, tilted=True)
    last = run.dataset.isel(time=-1)
    found = float(last.span_tension.sel(span="first steel-second steel"))
    assert found == pytest.approx(expected, abs=0.1 * (by_speeds - expected))
    rims = np.abs(last.pulley_speed.values) * run.prepared.rolling_radii
    assert rims[[2, 3, 4]] / rims[[0, 0, 1]] == pytest.approx(ratios, abs=1e-5)
