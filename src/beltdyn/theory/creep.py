"""Friction of a belt on a pulley: capstan, creep and flutter of sliding.

Creep-rate friction on a rigid pulley in steady running: f_t = -nu_s (v - omega R), capped at mu f_n (Eq. 22).

A belt that runs along a fixed curve passes every place with the same transport speed c, in reference length per second,
and has the speed v = c g where its stretch is g.  Along the reference coordinate X of an arc of radius R

    d(T - rho A c^2 g) / dX = -f_t,        f_n = (T - rho A c^2 g) g / R.

Flutter of a sliding belt: friction couples the normal force with longitudinal waves.

On an arc let w be the displacement outwards and u that along the belt, both as exp(i q x + s t).  The belt stretches by
u' + w / R, presses less by k_p w + c_p dw/dt, and where it slides friction is mu times that, whatever u does:

    (m s^2 + c_p s + k_p + EA / R^2) w + i q EA / R u = 0
    (m s^2 + EA q^2) u - (i q EA / R - mu (k_p + c_p s)) w = 0

Waves of stretch in tune with the belt on its penalty springs, q sqrt(EA / m) = sqrt(k_p / m), take energy from what
drives the pulley, like the coupled modes of brakes that squeal.  Where the belt creeps, friction damps them.  Bending
and the belt's own tension are left out.
"""

from math import exp, expm1, log, pi, tanh
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.parts.ranges import LARGEST_EXPONENT, require_above, require_at_least, require_at_most
from beltdyn.stretch import StretchParameters
from beltdyn.theory.span import open_belt


def capstan_ratio(friction: float, angle: float) -> float:
    """Ratio e^(mu theta) of the tensions at the ends of an arc of sliding.

    Examples
    --------
    Half a turn with a friction of 0.5:

    >>> from math import pi
    >>> round(bd.theory.creep.capstan_ratio(0.5, pi), 3)
    4.81
    """
    require_at_least(friction=friction, angle=angle)
    require_at_most(LARGEST_EXPONENT, friction_times_angle=friction * angle)
    return exp(friction * angle)


def tight_tension(
    slack: float, friction: float, angle: float, *, mass_per_length: float = 0.0, speed: float = 0.0
) -> float:
    """Tension T1 at the tight end: (T1 - rho A v^2) = (T2 - rho A v^2) e^(mu theta).

    Examples
    --------
    >>> from math import pi
    >>> round(bd.theory.creep.tight_tension(100.0, 0.5, pi, mass_per_length=0.1, speed=20.0), 1)
    328.6
    """
    lifted = mass_per_length * speed**2
    return lifted + (slack - lifted) * capstan_ratio(friction, angle)


def sliding_angle(
    tight: float, slack: float, friction: float, *, mass_per_length: float = 0.0, speed: float = 0.0
) -> float:
    """Sliding arc between two tensions, ln((T1 - rho A v^2) / (T2 - rho A v^2)) / mu, rad.

    Parameters are those of `tight_tension`, with the tight tension T1 (N) in place of the angle.

    Examples
    --------
    >>> round(bd.theory.creep.sliding_angle(tight=300.0, slack=100.0, friction=0.5), 3)
    2.197
    """
    lifted = mass_per_length * speed**2
    require_above(lifted, tight=tight, slack=slack)
    require_above(friction=friction)
    return log((tight - lifted) / (slack - lifted)) / friction


def speed_loss(tight: float, slack: float, law: StretchParameters) -> float:
    """Loss of speed (v1 - v2) / v1 = 1 - g(T2) / g(T1) of the rims, (T1 - T2) / EA at small strain.

    Where the belt runs onto a pulley it adheres and has the speed of the rim: c g(T1) on the driver, c g(T2) on the
    driven pulley, with the same c, the reference length that passes per second.

    Examples
    --------
    >>> from beltdyn.stretch import Linear
    >>> f"{bd.theory.creep.speed_loss(tight=300.0, slack=100.0, law=Linear(1e5)):.3%}"
    '0.199%'
    """
    return 1.0 - float(law.stretch(slack) / law.stretch(tight))


def slip_arc(tight: float, slack: float, friction: float, *, mass_per_length: float = 0.0, speed: float = 0.0) -> float:
    """Sliding arc before the exit of a pulley, rad; on the rest of the wrap the belt adheres.

    Parameters are those of `sliding_angle`.
    """
    return sliding_angle(tight, slack, friction, mass_per_length=mass_per_length, speed=speed)


def entry_strain(
    tension: FloatArray,
    radii: FloatArray,
    *,
    bending_stiffness: float,
    axial_stiffness: float,
    contact_stiffness: float,
    bent_strain: float,
    loss_factor: float = 0.0,
) -> FloatArray:
    """Strain lost by the belt at the entry of a pulley against its span, and the resulting loss of rim speed.

    In a span of tension T the belt bends towards a rim of stiffness k.  With q = EI k / T^2 the beam on springs, E I
    d'''' - T d'' + k d = T / R, meets the rim with the curvature kappa and the angle alpha,

        kappa R = sqrt(q) / (1 + sqrt(q) + sqrt(1 + 2 sqrt(q))),    alpha^2 = T / (k R^2).

    What does not depend on the place along a belt, T g - psi and the energy of bending, takes (1/2 - e) EI kappa^2 from
    the strain's EA, with e EI kappa^2 / EA the strain of a bent belt without tension; hysteresis takes pi/8 eta EI
    kappa^2, half of what bending forth and back loses.  The rim sees cos(alpha) of the belt's speed.
    """
    require_above(axial_stiffness=axial_stiffness, contact_stiffness=contact_stiffness, radii=radii)
    require_at_least(bending_stiffness=bending_stiffness)
    pull = np.maximum(tension, 1e-9 * axial_stiffness)
    root = np.sqrt(bending_stiffness * contact_stiffness) / pull
    bent = (root / (1.0 + root + np.sqrt(1.0 + 2.0 * root)) / radii) ** 2
    share = 0.5 - bent_strain + pi / 8.0 * loss_factor
    return np.asarray(share * bending_stiffness / axial_stiffness * bent + 0.5 * pull / (contact_stiffness * radii**2))


def gross_slip_tensions(
    installed: float,
    friction: float,
    distance: float,
    radius: float,
    *,
    mass_per_length: float = 0.0,
    speed: float = 0.0,
) -> tuple[float, float]:
    """Tight and slack tension of a drive with equal pulleys at gross slip.

    At small strain the belt's length fixes the mean of the tension over the path: with the lifted tension
    T0 = rho A v^2, span l, T1 - T0 = (T2 - T0) e^(mu pi), and arcs with the mean (T1 - T2) / (mu pi),

        l (T1 - T0 + T2 - T0) + 2 R (T1 - T2) / mu = (2 l + 2 pi R) (T - T0).

    Examples
    --------
    >>> tight, slack = bd.theory.creep.gross_slip_tensions(200.0, friction=0.3, distance=0.4, radius=0.05)
    >>> round(tight, 1), round(slack, 1)
    (293.5, 114.4)
    """
    require_above(friction=friction, distance=distance, radius=radius)
    belt, lifted = open_belt(distance, (radius, radius)), mass_per_length * speed**2
    ratio = capstan_ratio(friction, belt.wrap[0])
    weight = belt.span * (ratio + 1.0) + 2.0 * radius * (ratio - 1.0) / friction
    slack = belt.length * (installed - lifted) / weight
    return lifted + ratio * slack, lifted + slack


def layer_length(
    creep_rate_factor: float, transport_speed: float, law: StretchParameters, *, mass: float = 0.0, at: float = 1.0
) -> float:
    """Reference length (dT/dg - rho A c^2) / (nu_s c) over which a slip velocity grows e-fold along an arc, m."""
    require_above(creep_rate_factor=creep_rate_factor, transport_speed=transport_speed)
    stiffness = float(law.tangent_stiffness(at)) - mass * transport_speed**2
    return stiffness / (creep_rate_factor * transport_speed)


@np.errstate(under="ignore")  # below the least number is zero
def tension_along_arc(x: FloatArray, entry: float, leaving: float, arc: float, layer: float) -> FloatArray:
    """Tension along an arc, linearized and below the cap: T = T_in + (T_out - T_in) (e^(X/l) - 1) / (e^(a/l) - 1)."""
    _require_layer(arc, layer)
    _require_along(x, arc)
    grown = np.exp((x - arc) / layer) * np.expm1(-x / layer) / np.expm1(-arc / layer)  # no exponential overflows
    return np.asarray(entry + (leaving - entry) * grown)


@np.errstate(under="ignore")  # below the least number is zero
def friction_along_arc(x: FloatArray, entry: float, leaving: float, arc: float, layer: float) -> FloatArray:
    """Friction -dT/dX that belongs to `tension_along_arc`, N/m; it grows towards the exit.  Parameters as there."""
    _require_layer(arc, layer)
    _require_along(x, arc)
    return np.asarray((entry - leaving) / layer * np.exp((x - arc) / layer) / -np.expm1(-arc / layer))


def creep_speed_loss(tight: float, slack: float, law: StretchParameters, arc: float, layer: float) -> float:
    """Loss of speed (omega1 - omega2) / omega1 of a drive with equal pulleys below the cap, linearized.

    With a growing exponential on each arc, (omega1 - omega2) R / c = (g1 - g2) coth(a / 2 l) and
    omega1 R / c = g1 + (g1 - g2) / (e^(a/l) - 1).  For l << a this is elastic creep, (T1 - T2) / EA; for l >> a it is
    the slip of an inextensible belt, 2 (T1 - T2) / (nu_s a) over the rim speed.
    """
    _require_layer(arc, layer)
    first, second = (float(law.stretch(end)) for end in (tight, slack))
    rim = first + (first - second) * exp(-arc / layer) / -expm1(-arc / layer)
    return (first - second) / tanh(0.5 * arc / layer) / rim


def _require_layer(arc: float, layer: float) -> None:
    """Refuse arcs and layers that are no lengths."""
    require_above(arc=arc, layer=layer)


def _require_along(x: FloatArray, arc: float) -> None:
    """Refuse places that are not on the arc."""
    require_at_least(x=x)
    require_at_most(arc, x=x)


def entry_creep(elastic: float, saturation: float, lengths: float) -> float:
    """Slip velocity v0 at the entry of an arc, zero for Coulomb friction.

    Below the cap the slip velocity grows e-fold over each layer length, to v0 + V dT / EA at the exit. Where that is
    above v_c, the belt slides from v_c on, after n' layer lengths: v0 = v_c e^-n' with
    n' = n - (V dT / EA - v_c + v0) / v_c, which Lambert's function solves. The belt slips by v0 more, and friction
    takes v0 dT more.
    """
    from scipy.special import lambertw

    require_above(saturation=saturation)
    require_at_least(lengths=lengths)
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

    require_at_least(x=x, step_of_x=np.diff(x))
    require_above(entry=entry, transport_speed=transport_speed, radius=radius)
    require_at_least(mass=mass, friction=friction, creep_rate_factor=creep_rate_factor)

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


_LARGEST_WAVE_NUMBER = 20.0
"""Largest wave number considered, over that of the tuned waves."""
_WAVE_NUMBERS = 4000
"""Number of wave numbers at which growth is evaluated: a spacing of 1/200 of that of the tuned waves."""


class Flutter(NamedTuple):
    """A wave that grows like exp(rate t)."""

    rate: float
    """1/s; negative if it decays."""
    frequency: float
    """Hz."""
    wave_number: float
    """q, 1/m."""


class SlidingBelt(NamedTuple):
    """A belt sliding on a pulley of radius R."""

    mass_per_length: float
    """m, kg/m."""
    axial_stiffness: float
    """EA, N: the rate dN/dg of the law of stretch at the tension of the belt."""
    radius: float
    """R, m."""
    stiffness: float
    """k_p, N/m^2."""
    damping: float
    """c_p, N s/m^2."""
    friction: float
    """mu."""


def flutter_at(belt: SlidingBelt, wave_number: float) -> Flutter:
    """The wave of a wave number q (1/m) that grows fastest, running either way."""
    require_above(mass_per_length=belt.mass_per_length, axial_stiffness=belt.axial_stiffness, radius=belt.radius)
    require_at_least(stiffness=belt.stiffness, damping=belt.damping, friction=belt.friction)
    axial, radius = belt.axial_stiffness, belt.radius
    radial = np.array([belt.mass_per_length, belt.damping, belt.stiffness + axial / radius**2])
    along = np.array([belt.mass_per_length, 0.0, axial * wave_number**2])
    stretch = 1j * wave_number * axial / radius
    rubbing = np.array([0.0, -belt.friction * belt.damping, -belt.friction * belt.stiffness])
    coupling = np.convolve([0.0, 0.0, stretch], rubbing + np.array([0.0, 0.0, stretch]))
    roots = np.roots(np.convolve(radial, along) + coupling)
    fastest = roots[np.argmax(roots.real)]
    return Flutter(float(fastest.real), float(abs(fastest.imag)) / (2.0 * np.pi), wave_number)


def fastest_flutter(belt: SlidingBelt) -> Flutter:
    """The fastest growing wave on an infinite arc, a bound for partly sliding arcs."""
    require_above(stiffness=belt.stiffness, axial_stiffness=belt.axial_stiffness)
    in_tune = np.sqrt(belt.stiffness / belt.axial_stiffness)
    waves = in_tune * np.linspace(0.0, _LARGEST_WAVE_NUMBER, _WAVE_NUMBERS + 1)[1:]
    return max((flutter_at(belt, float(wave)) for wave in waves), key=lambda flutter: flutter.rate)
