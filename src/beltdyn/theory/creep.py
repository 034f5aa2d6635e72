"""Creep-rate friction on a rigid pulley in steady running: f_t = -nu_s (v - omega R), capped at mu f_n (Eq. 22).

A belt that runs along a fixed curve passes every place with the same transport speed c, in reference length per second,
and has the speed v = c g where its stretch is g.  Along the reference coordinate X of an arc of radius R

    d(T - rho A c^2 g) / dX = -f_t,        f_n = (T - rho A c^2 g) g / R.
"""

from math import exp, expm1, tanh

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.stretch import StretchParameters


def layer_length(
    creep_rate_factor: float, transport_speed: float, law: StretchParameters, *, mass: float = 0.0, at: float = 1.0
) -> float:
    """Reference length (dT/dg - rho A c^2) / (nu_s c) over which a slip velocity grows e-fold along an arc, m."""
    stiffness = float(law.tangent_stiffness(at)) - mass * transport_speed**2
    return stiffness / (creep_rate_factor * transport_speed)


def tension_along_arc(x: FloatArray, entry: float, leaving: float, arc: float, layer: float) -> FloatArray:
    """Tension along an arc, linearized and below the cap: T = T_in + (T_out - T_in) (e^(X/l) - 1) / (e^(a/l) - 1)."""
    return np.asarray(entry + (leaving - entry) * np.expm1(x / layer) / np.expm1(arc / layer))


def friction_along_arc(x: FloatArray, entry: float, leaving: float, arc: float, layer: float) -> FloatArray:
    """Friction -dT/dX that belongs to `tension_along_arc`, N/m; it grows towards the exit.  Parameters as there."""
    return np.asarray((entry - leaving) / layer * np.exp((x - arc) / layer) / -np.expm1(-arc / layer))


def creep_speed_loss(tight: float, slack: float, law: StretchParameters, arc: float, layer: float) -> float:
    """Loss of speed (omega1 - omega2) / omega1 of a drive with equal pulleys below the cap, linearized.

    With a growing exponential on each arc, (omega1 - omega2) R / c = (g1 - g2) coth(a / 2 l) and
    omega1 R / c = g1 + (g1 - g2) / (e^(a/l) - 1).  For l << a this is elastic creep, (T1 - T2) / EA; for l >> a it is
    the slip of an inextensible belt, 2 (T1 - T2) / (nu_s a) over the rim speed.
    """
    first, second = (float(law.stretch(end)) for end in (tight, slack))
    rim = first + (first - second) * exp(-arc / layer) / -expm1(-arc / layer)
    return (first - second) / tanh(0.5 * arc / layer) / rim


def entry_creep(elastic: float, saturation: float, lengths: float) -> float:
    """Slip velocity v0 at the entry of an arc, zero for Coulomb friction.

    Below the cap the slip velocity grows e-fold over each layer length, to v0 + V dT / EA at the exit. Where that is
    above v_c, the belt slides from v_c on, after n' layer lengths: v0 = v_c e^-n' with
    n' = n - (V dT / EA - v_c + v0) / v_c, which Lambert's function solves. The belt slips by v0 more, and friction
    takes v0 dT more.
    """
    from scipy.special import lambertw

    creep = elastic / saturation
    if creep >= lengths:
        return saturation
    if creep <= -expm1(-lengths):
        return elastic * exp(-lengths) / -expm1(-lengths)
    return saturation * float(-lambertw(-exp(creep - 1.0 - lengths)).real)


def creeping_arc(
    x: FloatArray,
    entry: float,
    rim_speed: float,
    transport_speed: float,
    *,
    law: StretchParameters,
    mass: float,
    radius: float,
    friction: float,
    creep_rate_factor: float,
) -> tuple[FloatArray, FloatArray]:
    """Tension and friction along an arc with inertia and the Coulomb cap, integrated from the entry."""
    from scipy.integrate import solve_ivp

    def friction_force(force: FloatArray, g: FloatArray) -> FloatArray:
        pressing = (force - mass * transport_speed**2 * g) * g / radius
        cap = friction * np.maximum(pressing, 0.0)
        return np.asarray(-np.clip(creep_rate_factor * (transport_speed * g - rim_speed), -cap, cap))

    def slope(_: float, force: FloatArray) -> FloatArray:
        g = law.stretch(force)
        lifted = mass * transport_speed**2 / law.tangent_stiffness(g)
        return -friction_force(force, g) / (1.0 - lifted)

    found = solve_ivp(slope, (0.0, float(x[-1])), [entry], t_eval=x, method="LSODA", rtol=1e-10, atol=1e-12 * entry).y[
        0
    ]
    return found, friction_force(found, law.stretch(found))
