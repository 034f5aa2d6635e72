"""What the default tolerance leaves of errors of time: headline numbers and the energy account."""

from collections.abc import Callable
from importlib.resources import files

import numpy as np
import pytest

from beltdyn import Drive, Run, load, loads, simulate
from beltdyn.results.energy_balance import largest_closure
from validation.published import cases

ALLOWED = 0.01
"""Error of a headline number, of its limit in the tolerance."""
CLOSURE = 5e-3
"""Of the energy put in."""
FREE = 0.01
"""Slip over the largest of the drive below which a pulley turns freely: such as 1e-5 beside 3e-3, known to 1e-6. Their
speeds are compared, as all are."""


def packaged(folder: str, name: str) -> Drive:
    return load(str(files("beltdyn").joinpath(folder, name)))


DRIVES: dict[str, tuple[Callable[[], Drive], float, float]] = {
    "two_pulley": (lambda: packaged("examples", "two_pulley.toml"), 0.8, 1.0),
    "new": (lambda: packaged("cli", "new_drive.toml"), 0.8, 1.0),
    "case_1": (cases.two_pulley, 0.8, 1.0),
    "unequal_radii": (lambda: packaged("examples", "unequal_radii.toml"), 1.2, 1.5),
    "slip_through": (lambda: packaged("examples", "slip_through.toml"), 0.9, 1.2),
    "case_2": (cases.loaded_two_pulley, 0.8, 1.0),
    "crossed_belt": (lambda: packaged("examples", "crossed_belt.toml"), 1.6, 2.0),
    "flat_belt_idler": (lambda: packaged("examples", "flat_belt_idler.toml"), 1.3, 1.6),
    "band_brake": (lambda: packaged("examples", "band_brake.toml"), 1.0, 1.5),
    "washing_machine": (lambda: packaged("examples", "washing_machine.toml"), 0.8, 0.9),
    "accessory_drive": (lambda: packaged("examples", "accessory_drive.toml"), 0.975, 1.2),
}
"""Name -> the drive, and the beginning and end of steady running, s."""


def headlines(run: Run, start: float, end: float) -> dict[str, float]:
    """Speeds and slips from angles; means of tensions, hub loads and tensioners' places; the sum of the losses."""
    part = run.dataset.drop_dims("filtered_time").sel(time=slice(start - 1e-9, end + 1e-9))
    turned = part.pulley_angle.values[-1] - part.pulley_angle.values[0]
    rims = np.abs(turned) * run.drive.rolling_radii
    losses = ("friction_loss", "damping_loss", "material_loss", "compression_loss", "tensioner_loss", "coupling_loss")
    hubs = np.hypot(*part.hub_force.mean("time").values.T)
    places = part.tensioner_position.mean("time").values if "tensioner_position" in part else ()
    slips = 1.0 - rims / rims[0]
    slipping = np.flatnonzero(np.abs(slips) > FREE * np.abs(slips).max())
    return {
        **{f"speed_{number}": float(angle) for number, angle in enumerate(turned)},
        **{f"slip_{number}": float(slips[number]) for number in slipping},
        **{f"tension_{number}": float(value) for number, value in enumerate(part.span_tension.mean("time").values)},
        **{f"hub_{number}": float(value) for number, value in enumerate(hubs)},
        **{f"arm_{number}": float(value) for number, value in enumerate(places)},
        "losses": sum(float(part[name][-1] - part[name][0]) for name in losses if name in part),
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", DRIVES)
def test_headline_numbers(name: str, measured: Callable[..., None]) -> None:
    """Against a tenth of the default tolerance."""
    build, *window = DRIVES[name]
    drive = build()
    coarse, fine = (
        headlines(simulate(drive.replace(simulation=drive.simulation.replace(rtol=rtol))), *window)
        for rtol in (1e-4, 1e-5)
    )
    assert coarse.keys() == fine.keys()
    errors = {key: coarse[key] / fine[key] - 1.0 for key in fine}
    measured(**errors)
    assert {key: error for key, error in errors.items() if not abs(error) <= ALLOWED} == {}


@pytest.mark.slow
@pytest.mark.parametrize("rtol", [1e-3, 1e-4])
def test_a_belt_that_slides_without_friction_keeps_its_energy(rtol: float, measured: Callable[..., None]) -> None:
    """A load turns the driven pulley backwards within the belt, which rings as laid."""
    drive = loads(cases.demo_text())
    driver, driven = drive.pulleys
    drive = drive.replace(
        pulley=[driver, driven.replace(torque={"kind": "constant", "value": -0.5})],
        contact=drive.contact.replace(friction=0.0),
    )
    run = simulate(drive.replace(simulation=drive.simulation.replace(rtol=rtol, duration=0.3)))
    error = largest_closure(run.dataset).error
    measured(closure=error)
    assert abs(error) < CLOSURE
