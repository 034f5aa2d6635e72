"""Spans that no support carries sag by their weight: longer than straight, and turned where they meet pulleys."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared
from beltdyn.model.path import wrap_angles
from beltdyn.results.mechanics import SpanTension

_SLACK = 0.25
"""Least tension that presses, over the weight across a span, of which the sag is taken: a belt hangs deeper below."""
_PLACES, _WEIGHTS = (0.5 * (values + shift) for values, shift in zip(leggauss(8), (1.0, 0.0), strict=True))
"""Gauss points and weights along a span."""


class Sag(NamedTuple):
    """How spans sag, each of shape (n, spans)."""

    longer: FloatArray
    """Length beyond that of the straight line, m."""
    start: FloatArray
    """Angle by which sag turns the belt to the left where the span starts, rad."""
    end: FloatArray
    """The same where it ends."""


def sag_of(prepared: Prepared, tension: SpanTension, lifted: FloatArray, directions: FloatArray) -> Sag | None:
    """How spans sag by the weight w across them; None without gravity.

    `tension`, `lifted`: T and m v^2, N, shape (n, spans); `directions`: shape (n, spans, 2). With T' = T - m v^2, which
    is linear along the span of length L, its small slope y' has T' y' = c - w s, with c so that both ends stay where
    they are.
    """
    if not any(prepared.gravity):
        return None
    supported = {one.span for one in prepared.supports}
    length = np.where([span in supported for span in prepared.spans], 0.0, prepared.path.span_lengths)
    across = np.sum(turned(directions) * weight_of_meter(prepared, tension)[:, None], axis=-1) * length
    least = _SLACK * np.abs(across) + np.finfo(float).tiny
    first, last = (np.maximum(values - lifted, least) for values in tension[:2])
    pressing = first[..., None] + (last - first)[..., None] * _PLACES
    held = across * (_PLACES / pressing @ _WEIGHTS) / (1.0 / pressing @ _WEIGHTS)
    slope = (held[..., None] - across[..., None] * _PLACES) / pressing
    return Sag(0.5 * length * (slope**2 @ _WEIGHTS), held / first, (held - across) / last)


def wrap_with_sag(prepared: Prepared, tension: SpanTension, lifted: FloatArray, directions: FloatArray) -> FloatArray:
    """Wrap angles between spans that sag, rad, shape (n, pulleys); arguments as for `sag_of`."""
    path = prepared.path
    straight, sag = wrap_angles(directions, *path.shape), sag_of(prepared, tension, lifted, directions)
    if sag is None:
        return straight
    turned = np.sign(path.radii) * (sag.start[:, path.leaving] - sag.end[:, path.reaching])
    return np.asarray(np.maximum(straight + turned, 0.0))


def weight_of_meter(prepared: Prepared, tension: SpanTension) -> FloatArray:
    """Weight of a meter of the stretched belt, N/m, shape (n, 2)."""
    stretch = prepared.belt.stretch_parameters.stretch(tension.mean.mean(axis=-1))
    return np.asarray(prepared.belt.mass_per_length / stretch[:, None] * np.array(prepared.gravity))


def turned(vectors: FloatArray) -> FloatArray:
    """Vectors turned by a quarter to the left, shape (..., 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)
