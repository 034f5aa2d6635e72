"""What the page of toothed belts says in numbers, beside a hand calculation; see `docs/scripts/example_numbers.py`."""

from collections.abc import Iterator
from math import cosh, pi, sinh, sqrt

from example_numbers import RPM, Number

from beltdyn import Run
from beltdyn.results import summarize, tooth_loads


def timing_drive(run: Run) -> Iterator[Number]:
    """Ratios of teeth, pulls of the loads, and the load of the first tooth on the camshaft by load sharing."""
    belt, pulleys, spans = run.drive.belt, summarize(run).pulleys, [one.tension for one in summarize(run).spans]
    toothing = belt.toothing
    assert toothing is not None
    radii = [one.teeth * toothing.pitch / (2.0 * pi) if one.teeth else 0.0 for one in run.drive.pulleys]
    pump = 800.0 / (3000.0 * RPM) * (22.0 / 24.0) ** 2
    pull = 14.0 / radii[2] + pump / radii[3]
    yield Number("speed of the camshaft, rpm", 1500.0, pulleys[2].speed / RPM, 1.5e-6)  # 1e-9 of it
    yield Number("tension across the crankshaft, N", pull, spans[3] - spans[0], 0.02 * pull)
    torque = pull * radii[0]
    yield Number("torque of the crankshaft, N m", torque, pulleys[0].shaft_torque, 0.02 * torque)
    loads = {one.name: one for one in tooth_loads(run)}
    mesh = 22.0 * pulleys[0].wrap_angle / (2.0 * pi)
    yield Number("teeth in mesh on the crankshaft", mesh, loads["crankshaft"].in_mesh, 0.02 * mesh)
    length, shared = (
        radii[2] * pulleys[2].wrap_angle,
        sqrt(toothing.pitch * belt.axial_stiffness / toothing.tooth_stiffness),
    )
    momentum, agree = belt.mass_per_length * (radii[0] * 3000.0 * RPM) ** 2, 0.5 * (belt.measuring_force or 0.0)
    before, after = spans[1] - momentum - agree, spans[2] - momentum - agree
    slope = (after * cosh(length / shared) - before) / (shared * sinh(length / shared))
    first = toothing.pitch * slope
    yield Number("largest tooth load on the camshaft, N", first, loads["camshaft"].largest, 0.05 * first)


def servo_axis(run: Run) -> Iterator[Number]:
    """The peak after a step of acceleration, and the angle of the move.

    The table sticks until the belt pulls with the friction F of its bearing, and then swings without damping about F
    and the inertial force N: the peak is F + N + sqrt(N^2 + 2 N F). The resistance that grows with speed and the
    damping of the belt, left out, change it by less than 1 %.
    """
    pulleys, data = run.drive.pulleys, run.dataset
    radius, acceleration = 72.0 * 5e-3 / (2.0 * pi), 500.0 * RPM / 3.0 / 0.05
    inertial, friction = 0.02 * acceleration / radius, 0.5 / radius
    peak = friction + inertial + sqrt(inertial**2 + 2.0 * inertial * friction)
    spans = data.span_tension.sel(time=slice(0.02, 0.07)).values
    found = float((spans[:, 1] - spans[:, 0]).max())
    yield Number("largest circumferential force as it accelerates, N", peak, found, 0.01 * peak)
    turned = float(data.pulley_angle[-1, 1] - data.pulley_angle[0, 1]) * 180.0 / pi
    yield Number("angle of the move, degrees", 360.0 * pulleys[0].teeth / pulleys[1].teeth, turned, 0.1)
