"""Strands that are heavier than their tension, and tensioners that are heavier than their springs hold."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model.carrying import hanging_parts
from beltdyn.model.path import Path
from beltdyn.model.prepared import Prepared
from beltdyn.parts.messages import Finding, beyond, listing, plain


def least_strand_tensions(prepared: Prepared, path: Path) -> FloatArray:
    """Tension at mid-span below which each strand hangs slack, N, shape (s,).

    A strand that hangs freely over the horizontal length a sags by w a^2 / 8 T, an eighth of a where it weighs as much
    as it pulls; and where it rises by h, its lower end has w h / 2 less than its middle. Supported strands hang from
    idler to idler. Goods count where they lie.
    """
    gravity = np.array(prepared.gravity, dtype=float)
    along = np.abs(path.span_directions @ gravity)
    across = np.abs(path.span_directions @ np.array([-gravity[1], gravity[0]]))
    hanging = [
        max(_mass(prepared, span, start, end) for start, end in parts)
        for span, parts in enumerate(hanging_parts(prepared.supports, prepared.spans, path))
    ]
    for support in prepared.supports:
        span, _, _, start, end = prepared.stretch(support)
        on_spacing = _mass(prepared, span, start, end) * support.free_length / (end - start)
        hanging[span] = max(hanging[span], on_spacing)
    halves = [
        max(_mass(prepared, span, 0.0, 0.5 * length), _mass(prepared, span, 0.5 * length, length))
        for span, length in enumerate(path.span_lengths.tolist())
    ]
    return np.asarray(np.maximum(np.array(hanging) * across, np.array(halves) * along))


def _mass(prepared: Prepared, span: int, start: float, end: float) -> float:
    """Mass of belt and goods on a part of a span (m), kg."""
    mass = prepared.belt.mass_per_length * (end - start)
    for goods in prepared.goods:
        lying = prepared.stretch(goods)
        if lying.span == span:
            mass += goods.mass_per_length * max(min(end, lying.end) - max(start, lying.start), 0.0)
    return mass


def slack_strands(prepared: Prepared, path: Path, tension: FloatArray) -> Finding | None:
    """Strands that weigh more than their tension (N, shape (s,)), with the least tension that they need."""
    needed = least_strand_tensions(prepared, path)
    slack = np.flatnonzero((np.nan_to_num(tension, nan=np.inf) < needed) & (needed > 0.0)).tolist()
    if not slack:
        return None
    each = [
        f"{prepared.spans[span][0]} to {prepared.spans[span][1]} with {plain(tension[span])} N, which needs "
        f"{plain(beyond(tension[span], needed[span], 4))} N"
        for span in slack
    ]
    enough = beyond(float(tension[slack].max()), float(needed[slack].max()), 3)
    return Finding(
        f"strands are heavier than their tension and hang slack: {listing(each)}.",
        "They sag by more than an eighth of their length, or have no tension at their lower end; tensions, wrap angles "
        "and frequencies are not those of straight spans, and no equilibrium may be found.",
        f"Increase their tension to {plain(enough)} N or more, or support them.",
    )


def heavy_tensioner(prepared: Prepared) -> Finding | None:
    """A tensioner whose weight overcomes its spring, with the preload that it needs."""
    gravity = np.array(prepared.gravity, dtype=float)
    for carrier, position in zip(prepared.carriers, prepared.installation.tensioner_positions.tolist(), strict=True):
        tensioner, pushes = carrier.tensioner, carrier.force(position)
        mass = tensioner.weighing_mass(prepared.pulleys[carrier.pulley].mass)
        pulls = -mass * float(gravity @ carrier.place(position)[1])
        if carrier.presses or not pulls > max(pushes, 0.0):
            continue
        unit, needed = tensioner.force_unit, beyond(carrier.force(0.0), carrier.force(0.0) + pulls, 3)
        return Finding(
            f'the weight of the tensioner of "{tensioner.pulley}" pulls it from the belt with {plain(pulls)} {unit}; '
            f"where the belt has its tension, its spring pushes with {plain(pushes)} {unit}.",
            "The belt hangs slack, or no equilibrium is found.",
            f"Give it preload = {plain(needed)} {unit}, or turn it so that its weight tightens the belt.",
        )
    return None


@contextmanager
def naming_heavy_parts(prepared: Prepared) -> Iterator[None]:
    """Add what is too heavy at rest to the message where a search for equilibrium or steady running fails."""
    try:
        yield
    except ConvergenceError as error:
        at_rest = prepared.installation
        findings = slack_strands(prepared, at_rest.path, at_rest.span_tensions), heavy_tensioner(prepared)
        text = str(error)
        for finding in findings:
            if finding is not None and finding.fault not in text:
                text += f" At rest {finding.fault} {finding.remedy}"
        if text == str(error):
            raise
        raise ConvergenceError(text) from error
