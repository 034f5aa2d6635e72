"""Verified: steady running on a mesh that stays, against an independent code and against long runs over time."""

from collections.abc import Callable
from functools import cache
from importlib.resources import files

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results import summarize
from beltdyn.state.steady import steady_state
from beltdyn.theory.nip import bending_loss
from validation.published.cases import CASES, better, loaded_two_pulley

EXAMPLES = sorted(path.name[:-5] for path in (files("beltdyn") / "examples").iterdir() if path.name.endswith(".toml"))

INDEPENDENT = {
    1e4: {
        "speed": 114.78628,
        "belt": 9.39429,
        "torque": 45.0404,
        "forces": (22666, 22508),
        "tensions": (1319.35, 1886.38),
    },
    1e5: {
        "speed": 119.25448,
        "belt": 9.57280,
        "torque": 45.2497,
        "forces": (23212, 21595),
        "tensions": (1331.64, 1899.97),
    },
}
"""Case 2 of the paper by an independent code without shear: speed of the driven pulley (rad/s), length of belt that
passes (m/s), torque of the driver (N m), largest normal forces on driver and driven pulley (N/m), tensions (N)."""


@cache
def example(name: str) -> Drive:
    return bd.load(str(files("beltdyn") / "examples" / f"{name}.toml"))


@pytest.mark.parametrize("factor", [1e4, 1e5])
def test_case_2_against_an_independent_code(factor: float, measured: Callable[..., None]) -> None:
    """The other mesh of 76 elements is converged to the digits that are given; of forces they are peaks."""
    run, other = steady_state(better(loaded_two_pulley(factor)), force_tolerance=1e-3), INDEPENDENT[factor]
    last = run.fields_at()
    touched, forces = last.contact_pulley.values, last.normal_force.values
    found = {
        "speed": float(last.pulley_speed[1]),
        "belt": run.dataset.attrs["belt_parameter"],
        "torque": float(last.shaft_torque[0]),
        "forces": [forces[touched == p].max() for p in (0, 1)],
        "tensions": last.span_tension.values,
    }
    errors = {name: float(np.max(np.abs(np.array(found[name]) / np.array(other[name]) - 1.0))) for name in other}
    measured(elements=run.dataset.sizes["node"], **errors)
    assert errors["speed"] < 1e-5
    assert errors["belt"] < 1e-5
    assert errors["torque"] < 2e-4
    assert errors["tensions"] < 2e-4
    assert errors["forces"] < 5e-4


def test_hysteresis_loses_the_same_on_any_mesh(measured: Callable[..., None]) -> None:
    """The curvature follows hysteresis without jumps from element to element: on the mesh for 1 % as on one for 0.05 %.

    The closed form of the loss, for ideal layers at the ends of arcs, is measured beside it.
    """
    drive = example("accessory_drive")
    coarse, fine = (steady_state(drive, force_tolerance=tolerance) for tolerance in (0.01, 5e-4))
    expected = float(bending_loss(drive.belt.bending_stiffness, drive.belt.bending_loss_factor, drive.radii).sum())
    losses = [
        summarize(run).balance.losses["belt bending"] / run.dataset.attrs["belt_parameter"] for run in (coarse, fine)
    ]
    forces = np.array([peaks(run, len(drive.pulleys)) for run in (coarse, fine)])
    change = float(np.max(np.abs(forces[0] / forces[1] - 1.0)))
    sizes = [run.dataset.sizes["node"] for run in (coarse, fine)]
    measured(coarse=sizes[0], fine=sizes[1], loss=losses[1] / expected, forces=change)
    assert losses[0] == pytest.approx(losses[1], rel=1e-2)
    assert change < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1e4, 1e5])
def test_case_2_against_a_run_over_time(factor: float, measured: Callable[..., None]) -> None:
    """A run of 120 travelling elements: speeds to 0.02 %, tensions to 0.3 %, the largest contact forces to 1 %."""
    drive = better(loaded_two_pulley(factor), 120, duration=1.5, rtol=1e-4)
    assert compared(drive, drive.replace(belt=drive.belt.replace(elements=30)), measured)["force"] < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("hysteresis", [True, False])
def test_accessory_drive_against_a_run_over_time(hysteresis: bool, measured: Callable[..., None]) -> None:
    """Seven pulleys, a tensioner without dry friction, clutches and springs behind rims, at a constant speed.

    Both meshes are refined to 0.3 %, so that they leave room for what is no error of a mesh.
    """
    drive = example("accessory_drive")
    crank = drive.pulleys[0].replace(harmonics=())
    compressor = drive.pulleys[-1]
    smooth = compressor.replace(load=[load.replace(harmonics=()) for load in compressor.load])
    arm = drive.tensioners[0].replace(tensioning_friction=0.0, yielding_friction=0.0, damping=2.0)
    drive = drive.replace(
        pulley=[crank, *drive.pulleys[1:-1], smooth],
        tensioner=[arm],
        simulation=drive.simulation.replace(duration=4.0, rtol=1e-3, force_tolerance=3e-3),
    )
    if not hysteresis:
        drive = drive.replace(belt=drive.belt.replace(bending_loss_factor=0.0))
    assert compared(drive, drive, measured)["force"] < 1e-2


def compared(over_time: Drive, drive: Drive, measured: Callable[..., None]) -> dict[str, float]:
    """Compare the end of a run over time with steady running; relative differences."""
    run, steady = bd.simulate(over_time), steady_state(drive, at=over_time.simulation.duration)
    end, found = summarize(run), summarize(steady)
    speeds = [[pulley.speed for pulley in one.pulleys] for one in (end, found)]
    tensions = [[span.tension for span in one.spans] for one in (end, found)]
    hubs = [[pulley.hub_load for pulley in one.pulleys] for one in (end, found)]
    forces = [peaks(one, len(drive.pulleys)) for one in (run, steady)]
    pairs = {"speed": speeds, "tension": tensions, "hub": hubs, "force": forces}
    errors = {name: float(np.max(np.abs(np.array(b) / np.array(a) - 1.0))) for name, (a, b) in pairs.items()}
    measured(**errors)
    assert errors["speed"] < 2e-4
    assert errors["tension"] < 3e-3
    assert errors["hub"] < 3e-3
    return errors


def peaks(run: bd.Run, pulleys: int) -> list[float]:
    """Means over the last instants of the largest normal force on each pulley, N/m."""
    last = run.dataset.isel(field_time=slice(-20, None))
    touched, forces = last.contact_pulley.values, last.normal_force.values
    return [float(np.where(touched == p, forces, 0.0).max(axis=1).mean()) for p in range(pulleys)]


SHOWN = [pytest.param(name, marks=[pytest.mark.slow] * example(name).carries) for name in EXAMPLES]
"""All of them; belts that carry have kernels of their own."""
QUICK = ("crossed_belt", "tensioner_stop", "timing_drive", "two_pulley", "washing_machine")
STEADY = [
    pytest.param(one.values[0], marks=[pytest.mark.slow] * (one.values[0] not in QUICK))
    for one in SHOWN
    if one.values[0] not in ("servo_axis", "slip_through") and not example(str(one.values[0])).ends
]


@pytest.mark.parametrize("name", STEADY)
def test_rounding_does_not_decide_whether_there_is_steady_running(name: str) -> None:
    """The way from rest is another one with each last digit; a tenth of a billionth of the mass does the same."""
    drive = example(name)
    changes = 1.0 + 1e-10 * np.random.default_rng(0).standard_normal(4)
    runs = [
        steady_state(drive.replace(belt=drive.belt.replace(mass_per_length=drive.belt.mass_per_length * c)))
        for c in changes
    ]
    tensions = np.array([run.dataset.span_tension.values[-1] for run in runs])
    np.testing.assert_allclose(tensions, tensions[:1].repeat(4, axis=0), rtol=1e-3)


@pytest.mark.parametrize("name", SHOWN)
def test_every_example(name: str) -> None:
    """It runs steadily, or says why not: its belt has ends, stands still at the end of its move, or slips through."""
    drive = example(name)
    if drive.ends:
        with pytest.raises(bd.ModelError, match="open belt"):
            steady_state(drive)
    elif name == "servo_axis":
        with pytest.raises(bd.ModelError, match="every prescribed speed is zero"):
            steady_state(drive)
        assert steady_state(drive, at=0.1).resolution.errors["peak pressure"] < 0.01
    elif name == "slip_through":
        with pytest.raises(ConvergenceError, match="slips on `"):
            steady_state(drive)
    else:
        assert steady_state(drive).resolution.errors["peak pressure"] < 0.01


@pytest.mark.parametrize("name", CASES)
def test_every_published_case(name: str) -> None:
    assert steady_state(better(CASES[name].build())).resolution.errors["peak pressure"] < 0.01
