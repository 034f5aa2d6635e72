"""A loaded two-pulley drive in steady running on penalty contact, as a boundary-value problem along the belt.

The belt runs along a fixed closed curve p(X) with the transport speed c (reference length per second): its velocity is
c p' and its acceleration c^2 p''.  With p' = g t, the angle theta of the tangent t and the angle phi of the section,
tension N(g), bending EI, shear K and the force n in the belt,

    m = n - rho A c^2 p',        m' = -f,
    m . t = N(g) + (3/2 EI phi'^2 + K s^2 - rho A c^2) g,        m . n = -K g s,        s = phi - theta,
    (EI - rho I c^2) phi'' = K g^2 s,

where f is the contact force of Eqs. 17-22 without dampers.  c and the speed of the driven pulley are unknown; the belt
closes, and its torque on the driven pulley is the load.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.stretch import StretchParameters
from beltdyn.theory.span import OpenBelt, open_belt
from beltdyn.theory.static_tension import static_tension

_X, _Y, _SECTION, _SECTION_RATE, _FORCE_X, _FORCE_Y, _TORQUE = range(7)


@dataclass(frozen=True)
class RunningDrive:
    """A drive in counter-clockwise rotation: driver at the origin, driven pulley at (distance, 0)."""

    length: float
    """Unstretched length of the belt, m."""
    law: StretchParameters
    """Parameters of the law of stretch."""
    bending: float
    """EI with its factor alpha, N m^2."""
    shear: float
    """k_s G A with its factor alpha, N."""
    mass: float
    """rho A, kg/m."""
    rotary_inertia: float
    """rho I, kg m."""
    distance: float
    """Distance of the centers, m."""
    radii: tuple[float, float]
    """Radii of driver and driven pulley, m."""
    stiffness: float
    """k_p, N/m^2."""
    friction: float
    """mu."""
    creep_rate_factor: float
    """nu_s, kg/(m s)."""
    speed: float
    """Of the driver, rad/s."""
    load: float
    """Torque that the belt gives to the driven pulley, N m."""


@dataclass(frozen=True, eq=False)
class RunningBelt:
    """Steady running of a drive at k points along the belt."""

    coordinate: FloatArray
    """Reference coordinate from the middle of the span that leaves the driver, m, shape (k,)."""
    position: FloatArray
    """m, shape (2, k)."""
    tension: FloatArray
    """N(g), N, shape (k,)."""
    normal_force: FloatArray
    """Normal force of each pulley per reference length, N/m, shape (2, k)."""
    friction_force: FloatArray
    """Friction force of each pulley per reference length, N/m, shape (2, k)."""
    transport_speed: float
    """c, m/s."""
    driven_speed: float
    """rad/s."""


def run_steadily(drive: RunningDrive, points: int = 20001) -> RunningBelt:
    """Solve the boundary-value problem."""
    from scipy.integrate import solve_bvp

    coordinate, begin, parameters = _guess(drive)
    found = solve_bvp(_rates(drive), _closed(drive, begin), coordinate, begin, parameters, tol=1e-3, max_nodes=20000)
    if not found.success:
        raise ConvergenceError(f"no steady running found ({found.message.strip()}). Reduce load = {drive.load:g} N m.")
    x = np.linspace(0.0, drive.length, points)
    y, (transport, driven) = found.sol(x), np.asarray(found.p, dtype=float)
    angle, g = _tangent(drive, y, transport)
    forces = _contact(drive, y, angle, g, transport, driven)
    return RunningBelt(x, y[:2], drive.law.tension(g), forces[:, 0], forces[:, 1], float(transport), float(driven))


def _rates(drive: RunningDrive) -> Callable[[FloatArray, FloatArray, FloatArray], FloatArray]:
    """Derivatives of the unknowns along the belt."""

    def rates(_: FloatArray, y: FloatArray, parameters: FloatArray) -> FloatArray:
        transport, driven = parameters
        angle, g = _tangent(drive, y, transport)
        forces = _contact(drive, y, angle, g, transport, driven)
        bending = drive.bending - drive.rotary_inertia * transport**2
        turn = drive.shear * g * g * _difference(y[_SECTION], angle) / bending
        return np.stack(
            [
                g * np.cos(angle),
                g * np.sin(angle),
                y[_SECTION_RATE],
                turn,
                -forces[:, 2].sum(axis=0),
                -forces[:, 3].sum(axis=0),
                forces[1, 4],
            ]
        )

    return rates


def _closed(drive: RunningDrive, begin: FloatArray) -> Callable[[FloatArray, FloatArray, FloatArray], FloatArray]:
    """The belt closes after one turn, begins above the middle of the guess, and drives the load."""
    turn = np.array([0.0, 0.0, 2.0 * pi, 0.0, 0.0, 0.0])

    def conditions(start: FloatArray, end: FloatArray, _: FloatArray) -> FloatArray:
        return np.concatenate(
            [
                end[:_TORQUE] - start[:_TORQUE] - turn,
                [start[_X] - begin[_X, 0], start[_TORQUE], end[_TORQUE] - drive.load],
            ]
        )

    return conditions


def _tangent(drive: RunningDrive, y: FloatArray, transport: float) -> tuple[FloatArray, FloatArray]:
    """Angle of the tangent and stretch from the force and the section, by Newton's method from no shear."""
    size, direction = np.hypot(y[_FORCE_X], y[_FORCE_Y]), np.arctan2(y[_FORCE_Y], y[_FORCE_X])
    lean, g = _difference(y[_SECTION], direction), drive.law.stretch(size)
    turn, shear, lifted = np.zeros_like(size), drive.shear, drive.mass * transport**2
    curving = 1.5 * drive.bending * y[_SECTION_RATE] ** 2
    for _ in range(20):
        s, sine, cosine = lean - turn, np.sin(turn), np.cos(turn)
        along = size * cosine - drive.law.tension(g) + (lifted - curving - shear * s * s) * g
        across = -size * sine + shear * g * s
        along_turn, along_g = -size * sine + 2.0 * shear * s * g, lifted - curving - shear * s * s
        along_g = along_g - drive.law.tangent_stiffness(g)
        across_turn, across_g = -size * cosine - shear * g, shear * s
        scale = along_turn * across_g - across_turn * along_g
        step = (along * across_g - across * along_g) / scale
        turn, g = turn - step, g - (along_turn * across - across_turn * along) / scale
        if np.max(np.abs(step)) < 1e-13:
            break
    return direction + turn, g


def _contact(
    drive: RunningDrive, y: FloatArray, angle: FloatArray, g: FloatArray, transport: float, driven: float
) -> FloatArray:
    """Normal force, friction, force along x and y, and moment on the pulley, per reference length; shape (2, 5, k)."""
    velocity_x, velocity_y = transport * g * np.cos(angle), transport * g * np.sin(angle)
    forces = []
    for center, radius, speed in zip((0.0, drive.distance), drive.radii, (drive.speed, driven), strict=True):
        x, height = y[_X] - center, y[_Y]
        distance = np.hypot(x, height)
        out_x, out_y = x / distance, height / distance
        normal = drive.stiffness * np.maximum(radius - distance, 0.0)
        slip = out_x * velocity_y - out_y * velocity_x - speed * radius
        cap = drive.friction * normal
        friction = -np.clip(drive.creep_rate_factor * slip, -cap, cap)
        force_x, force_y = normal * out_x - friction * out_y, normal * out_y + friction * out_x
        forces.append(np.stack([normal, friction, force_x, force_y, -distance * friction]))
    return np.stack(forces)


def _difference(one: FloatArray, other: FloatArray) -> FloatArray:
    """Difference of two angles, from -pi to pi."""
    return np.asarray(np.remainder(one - other + pi, 2.0 * pi) - pi)


def _guess(drive: RunningDrive) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The belt as it is installed, running without slip and without load; mesh, unknowns and parameters."""
    installed = static_tension(
        drive.length,
        drive.distance,
        drive.radii,
        law=drive.law,
        contact_stiffness=drive.stiffness,
    )
    inner = drive.radii[0] - installed.penetration[0], drive.radii[1] - installed.penetration[1]
    way = open_belt(drive.distance, inner)
    x = np.linspace(0.0, drive.length, 800)
    place, angle = _trace(way, inner, x * way.length / drive.length)
    g = float(drive.law.stretch(installed.tension))
    transport = drive.speed * drive.radii[0] / g
    force = installed.tension - drive.mass * transport**2 * g
    y = np.zeros((7, x.size))
    y[_X], y[_Y], y[_SECTION] = place[0], place[1], angle
    y[_SECTION_RATE] = np.gradient(angle, x)
    y[_FORCE_X], y[_FORCE_Y] = force * np.cos(angle), force * np.sin(angle)
    return x, y, np.array([transport, drive.speed * drive.radii[0] / drive.radii[1]])


def _trace(way: OpenBelt, radii: tuple[float, float], along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places, shape (2, k), and angles of the tangent along a path, from the middle of the span after the driver."""
    half, tilt = 0.5 * way.span, way.tilt
    corners = np.cumsum([0.0, half, radii[1] * way.wrap[1], way.span, radii[0] * way.wrap[0], half])
    angle = np.interp(along, corners, -tilt + np.cumsum([0.0, 0.0, way.wrap[1], 0.0, way.wrap[0], 0.0]))
    start = half * np.array([np.cos(tilt), -np.sin(tilt)]) - radii[0] * np.array([np.sin(tilt), np.cos(tilt)])
    middle = 0.5 * (angle[1:] + angle[:-1])
    steps = np.diff(along) * np.stack([np.cos(middle), np.sin(middle)])
    return start[:, None] + np.hstack([np.zeros((2, 1)), np.cumsum(steps, axis=1)]), angle
