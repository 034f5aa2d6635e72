"""Drives made at random, on which `beltdyn.model.resolution` is validated, and what their runs give.

`python docs/scripts/measure.py resolution` measures the tables of docs/verification/resolution.md with them.
"""

import math
from typing import NamedTuple

import numpy as np

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError
from beltdyn.quadrature import gauss_points

_SEED = 2026
_SUNK = 1.0
"""Largest length of belt that penetration takes, over the belt's elongation."""
_RAMP, _TURNS, _MEANS = 0.5, 1.25, 0.75
"""Turns of the belt at full speed: of the rise of speed and load, of the run, and of the means at its end."""
_OUTPUTS = 100


SEEDS = range(200, 230)
"""Those of the validation."""
_COARSE = 1.8
"""Elements on a radian of the smallest pulley of a mesh that does not resolve much."""
_FINE, _FINER = 6.0, 1.6
"""Elements on a radian, and elements over those that the finest named mesh has, of a converged mesh."""


class Values(NamedTuple):
    """What the mesh is judged by, in steady running."""

    tension: float
    """Mean of the belt, N."""
    peak_pressure: FloatArray
    """Mean over time of the largest normal force along each arc, N/m, shape (pulleys,)."""
    mean_pressure: FloatArray
    """Mean normal force along each arc, N/m."""
    slip: float
    """Of the loaded pulley."""
    friction: float
    """Power lost in friction, W."""
    damping: float
    """Power lost in contact damping, W."""


class Judged(NamedTuple):
    """A mesh of a drive: what it estimates of its errors, and what they are."""

    mesh: str
    """ "coarse", "for the tension" or "for all": the mesh that the coarse one names."""
    elements: int
    estimated: dict[str, float]
    true: dict[str, float]
    needed: dict[str, int]
    """Elements that it asks for."""


def judge(seed: int) -> list[Judged]:
    """Compare what three meshes of a random drive estimate with a converged mesh."""
    drive = random_drive(seed)
    radian = drive.belt_length / float(drive.radii.min())
    coarse = bd.simulate(meshed(drive, math.ceil(_COARSE * radian)))
    named = coarse.resolution.needed
    finest = max(named.values())
    exact = values(bd.simulate(meshed(drive, max(math.ceil(_FINE * radian), math.ceil(_FINER * finest)))))
    runs = {
        "coarse": coarse,
        "for the tension": bd.simulate(meshed(drive, named["tension"])),
        "for all": bd.simulate(meshed(drive, finest)),
    }
    return [
        Judged(
            mesh,
            run.drive.elements,
            dict(run.resolution.errors),
            true_errors(values(run), exact),
            dict(run.resolution.needed),
        )
        for mesh, run in runs.items()
    ]


def random_drive(seed: int) -> bd.Drive:
    """A drive of two to four pulleys, of which one is loaded below gross slip; with about one element a radian.

    Radii are 8 mm to 0.5 m; strain, bending stiffness, penetration, speed, damping, friction and its slope, and load
    vary over the ranges of belt drives.  Layouts that do not fit are thrown away.
    """
    rng = np.random.default_rng([_SEED, seed])
    while True:
        drive = _draw(rng)
        if drive is not None:
            return drive


def _draw(rng: np.random.Generator) -> bd.Drive | None:
    """One drive, or None if the draw does not fit."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    count = int(rng.integers(2, 5))
    small = between(0.008, 0.2)
    radii = np.minimum(small * np.array([1.0, *(between(1.0, 3.0) for _ in range(count - 1))]), 0.5)
    rng.shuffle(radii)
    size = rng.uniform(1.1, 1.8) * np.sort(radii)[-2:].sum() / (2 * math.sin(math.pi / count))
    angles = 2 * math.pi * np.arange(count) / count + rng.uniform(-0.3, 0.3, count)
    centers = size * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    tension = 300.0 * (small / 0.03) ** 1.5 * between(0.3, 3.0)
    strain = between(3e-4, 1e-2)
    bending = tension * (between(0.01, 0.3) * small) ** 2
    stiffness = tension / (small * between(1e-3, 2e-2) * small)
    thickness = rng.uniform(0.03, 0.12) * small
    lifted = between(1e-3, 0.15)
    mass = 1200.0 * 5.0 * thickness**2
    speed = math.sqrt(lifted * tension / mass)
    damping = 2 * math.sqrt(stiffness * mass) * between(0.02, 0.5)
    friction = rng.uniform(0.3, 1.2)
    slope = friction * tension / small / (speed * between(3e-4, 1e-2))
    loaded, share = int(rng.integers(1, count)), rng.uniform(0.2, 0.55)
    belt = {
        "width": 5.0 * thickness,
        "thickness": thickness,
        "poissons_ratio": 0.3,
        "axial_stiffness": tension / strain,
        "bending_stiffness": bending,
        "mass_per_length": mass,
    }
    contact = {
        "stiffness": stiffness,
        "damping": damping,
        "friction": friction,
        "friction_law": "force_slope",
        "creep_rate_factor": slope,
        "moment_arm": "rim" if rng.random() < 0.5 else "point",
    }

    def assemble(length: float | None, load: float, turn: float) -> bd.Drive:
        rise = {"kind": "cosine_ramp", "start": 0.0, "end": _RAMP * turn}
        pulleys = [
            {"name": f"pulley {i}", "center": tuple(centers[i].tolist()), "radius": float(radii[i])}
            | ({"inertia": float(2.0 * mass * radii[i] ** 3)} if i else {"speed": rise | {"value": speed / radii[0]}})
            | ({"torque": rise | {"value": -load}} if i == loaded else {})
            for i in range(count)
        ]
        long = {"length": length} if length else {"installed_tension": tension}
        elements = math.ceil(length / small) if length else 24
        return bd.Drive(
            belt={**belt, **long, "elements": max(12, elements)},
            pulley=pulleys,
            contact=contact,
            simulation={"duration": _TURNS * turn, "rtol": 3e-4, "frame": "travelling"}
            | dict.fromkeys(("output_interval", "field_interval"), turn / _OUTPUTS),
        )

    try:
        path = assemble(None, 0.0, 1.0).path
        if min(path.wrap_angles) < 0.9 or min(path.span_lengths) < small:
            return None
        length = float(path.length / (1.0 + strain))
        sunk = tension / (strain * stiffness * length) * float(np.sum(path.wrap_angles / radii))
        if sunk > _SUNK:
            return None
        rest = tension / (1.0 + sunk)
        wrap = min(path.wrap_angles[0], path.wrap_angles[loaded])
        most = 2.0 * rest * (1.0 - lifted) * math.tanh(0.5 * friction * wrap) * radii[loaded]
        return assemble(length, float(share * most), length / speed)
    except BeltdynError:
        return None


def meshed(drive: bd.Drive, elements: int) -> bd.Drive:
    """The drive with another mesh."""
    return drive.replace(belt=drive.belt.replace(elements=elements))


def values(run: bd.Run) -> Values:
    """Means over the last three quarters of a turn of the belt."""
    drive, data = run.drive, run.dataset
    last = slice(round((_TURNS - _MEANS) * _OUTPUTS), None)
    window = data.isel(time=last, field_time=last)
    _, weights = gauss_points(drive.contact.quadrature_points)
    cell = np.tile(weights, drive.elements)
    force, touched = window["normal_force"].values, window["contact_pulley"].values
    on = [touched == number for number in range(len(drive.pulleys))]
    turned = window["pulley_angle"].values[-1] - window["pulley_angle"].values[0]
    rim = turned * drive.radii
    loaded = next(number for number, pulley in enumerate(drive.pulleys) if pulley.torque is not None)
    elapsed = float(window["time"].values[-1] - window["time"].values[0])
    friction, damping = (
        float(window[name].values[-1] - window[name].values[0]) / elapsed for name in ("friction_loss", "damping_loss")
    )
    return Values(
        tension=float(window["belt_tension"].mean()),
        peak_pressure=np.array([np.where(here, force, 0.0).max(axis=1).mean() for here in on]),
        mean_pressure=np.array([np.mean((force * cell * here).sum(axis=1) / (cell * here).sum(axis=1)) for here in on]),
        slip=float(1.0 - rim[loaded] / rim[0]),
        friction=friction,
        damping=damping,
    )


def true_errors(found: Values, exact: Values) -> dict[str, float]:
    """Relative errors by the names of `beltdyn.model.ERROR_LIMITS`, without sign, of the worst pulley.

    Those of losses by friction and by damping are added before their sign is dropped, over the sum of both: with
    friction at the belt's point, as published, the first may be negative.
    """
    lost = found.friction - exact.friction + found.damping - exact.damping
    return {
        "tension": abs(found.tension / exact.tension - 1.0),
        "mean pressure": float(np.max(np.abs(found.mean_pressure / exact.mean_pressure - 1.0))),
        "peak pressure": float(np.max(np.abs(found.peak_pressure / exact.peak_pressure - 1.0))),
        "slip": abs(found.slip / exact.slip - 1.0),
        "losses": abs(lost) / (abs(exact.friction) + abs(exact.damping)),
    }
