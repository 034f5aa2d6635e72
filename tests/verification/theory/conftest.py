"""Two-pulley drives for comparison with belt theory: one place that makes them from the published drive."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.system.state import belt_section
from beltdyn.theory.running_drive import RunningDrive

Changes = Mapping[str, Any]
RISE = {"start": 0.05, "end": 0.6}


@pytest.fixture(scope="session")
def changed() -> Callable[..., Drive]:
    """Change values of a drive with two pulleys."""

    def change(
        drive: Drive,
        *,
        belt: Changes | None = None,
        driver: Changes | None = None,
        driven: Changes | None = None,
        contact: Changes | None = None,
        **simulation: Any,
    ) -> Drive:
        first, second = drive.pulleys
        return drive.replace(
            belt=drive.belt.replace(**belt or {}),
            pulley=[first.replace(**driver or {}), second.replace(**driven or {})],
            contact=drive.contact.replace(**contact or {}),
            simulation=drive.simulation.replace(**simulation),
        )

    return change


@pytest.fixture(scope="session")
def table_1(drive: Drive, changed: Callable[..., Drive]) -> Callable[..., Drive]:
    """The published drive (Table 1, Eq. 28) with a number of elements, contact on the zone, from equilibrium."""
    return lambda elements, **changes: changed(
        drive, **{"belt": {"elements": elements}, "start": "equilibrium"} | changes
    )


@pytest.fixture(scope="session")
def loaded(table_1: Callable[..., Drive], changed: Callable[..., Drive]) -> Callable[..., Drive]:
    """The published drive under load (Eq. 29, 120 rad/s) with a number of elements and a creep-rate factor."""

    def make(elements: int, creep_rate_factor: float, **simulation: Any) -> Drive:
        return changed(
            table_1(elements),
            belt={"length": 1.2443, "bending_factor": 0.001, "youngs_modulus": 1e9},
            driver={"speed": {"kind": "ramp", "value": 120.0, **RISE}},
            driven={"torque": {"kind": "cosine_ramp_published", "value": -45.0, **RISE}},
            contact={"creep_rate_factor": creep_rate_factor},
            **simulation,
        )

    return make


@pytest.fixture(scope="session")
def running() -> Callable[[Drive, float, float], RunningDrive]:
    """The numbers of a drive, with a speed of its driver (rad/s) and a load (N m), for the theory."""

    def numbers(drive: Drive, speed: float, load: float) -> RunningDrive:
        section, contact = belt_section(drive.belt), drive.contact
        driver, driven = drive.pulleys
        assert contact.creep_rate_factor is not None
        return RunningDrive(
            length=drive.belt_length,
            law=section.stretch,
            bending=section.bending,
            shear=section.shear,
            mass=section.mass,
            rotary_inertia=section.rotary_inertia,
            distance=driven.center[0] - driver.center[0],
            radii=(driver.radius, driven.radius),
            stiffness=contact.given("stiffness"),
            friction=float(drive.frictions[0]),
            creep_rate_factor=contact.creep_rate_factor,
            speed=speed,
            load=load,
        )

    return numbers


@pytest.fixture(scope="session")
def around() -> Callable[[FloatArray, tuple[float, float]], FloatArray]:
    """Angle of points, shape (k, 2), around a center, continuous over the half plane away from the other pulley."""

    def angle(points: FloatArray, center: tuple[float, float]) -> FloatArray:
        away = -np.sign(center[0])
        x, y = -away * (points[:, 0] - center[0]), points[:, 1] - center[1]
        return np.asarray(np.arctan2(-away * y, x))

    return angle


@pytest.fixture(scope="session")
def on_pulley() -> Callable[[xr.Dataset, int], xr.Dataset]:
    """The contact points of an output on a pulley."""
    return lambda output, pulley: output.isel(contact_point=np.flatnonzero(output.contact_pulley.values == pulley))
