"""A nip in steady running against the closed forms of an elastic foundation, rolling, Coulomb friction, and energy."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError
from beltdyn.model.nip import Pair, side_stiffness
from beltdyn.theory.nip import (
    equivalent_radius,
    force,
    half_width,
    hertz_half_width,
    plane_modulus,
    rolling_loss,
    series,
)

WIDTH, TENSION = 0.2, 1000.0
FRICTION = 0.4
DRUM, TAIL, ROLLER = 0.15, 0.1, 0.08
SPEED = 6.6
PARABOLA = 0.01
"""What the closed forms leave out: circles for parabolas, half of the width being 0.1 of the radius; bending."""


def drive(**changes: Any) -> bd.Drive:
    """A thin belt on a driven drum, and a roller with a cover that presses it there."""
    base = bd.Drive(
        belt={
            "width": WIDTH,
            "thickness": 3e-3,
            "pitch_offset": 1.5e-3,
            "back_offset": 1.5e-3,
            "axial_stiffness": 4e5,
            "bending_stiffness": 1e-3,
            "mass_per_length": 0.7,
            "contact_stiffness": 4e10,
            "installed_tension": TENSION,
        },
        pulley=[
            {"name": "drum", "center": [0.0, 0.0], "radius": DRUM, "speed": SPEED},
            {"name": "tail", "center": [1.2, 0.0], "radius": TAIL, "inertia": 0.2, "torque": -30.0},
            {
                "name": "press",
                "center": [-0.3, 0.0],
                "radius": ROLLER,
                "side": "outside",
                "inertia": 0.05,
                "cover": {"thickness": 0.01, "youngs_modulus": 4e6, "poissons_ratio": 0.45},
            },
        ],
        nip=[{"roller": "press", "pulley": "drum", "force": 500.0}],
        contact={"friction": FRICTION},
        simulation={"duration": 1.0},
    )
    return base.with_(changes)


@pytest.fixture(scope="module")
def idle() -> bd.Run:
    return bd.steady_state(drive())


def _foundation(run: bd.Run) -> tuple[float, float]:
    """Stiffness of both sides in series, N/m^2, and the equivalent radius, m."""
    prepared = run.prepared
    sides = [side_stiffness(prepared.pulleys[one], prepared.belt, prepared.contact_stiffness) for one in (0, 2)]
    return series(*sides), equivalent_radius(*prepared.radii[[0, 2]].tolist())


def test_the_nip_is_that_of_a_foundation(idle: bd.Run) -> None:
    nip, (stiffness, radius) = bd.derived.nips(idle).isel(nip=0), _foundation(idle)
    depth = float(nip.indentation)
    assert float(nip.force) == pytest.approx(500.0, rel=1e-6)
    assert force(depth, stiffness, radius) == pytest.approx(500.0, rel=PARABOLA)
    assert float(nip.width) == pytest.approx(2.0 * half_width(depth, radius), rel=PARABOLA)
    assert float(nip.peak_pressure) == pytest.approx(stiffness * depth / WIDTH, rel=PARABOLA)


def test_pressure_is_a_parabola_on_the_covered_face(idle: bd.Run, curve: Callable[..., None]) -> None:
    profile, (stiffness, radius) = bd.derived.nip_profile(idle, "press"), _foundation(idle)
    depth = float(bd.derived.nips(idle).indentation[0])
    parabola = stiffness * (depth - profile.distance.values**2 / (2.0 * radius)) / WIDTH
    misfit = profile.pressure.sel(face="press").values - np.maximum(parabola, 0.0)
    place = 1e3 * profile.distance.values
    for face, style in (("press", "-"), ("drum", "--")):
        curve("nip/pressure", place, profile.pressure.sel(face=face).values / 1e3, f"on the {face}", style)
        curve("nip/shear", place, profile.shear.sel(face=face).values / 1e3, f"on the {face}", style)
    curve("nip/pressure", place[::8], np.maximum(parabola, 0.0)[::8] / 1e3, "parabola", ".")
    assert np.abs(misfit).max() < 2.0 * PARABOLA * parabola.max()


SOLID = {"youngs_modulus": 50e6, "poissons_ratio": 0.45}
HARD = {"pulley[press].cover": SOLID, "belt.contact_stiffness": 4e12}
"""A solid roller on a belt that gives way by 1 % of what the roller does."""


def test_a_solid_roller_presses_as_hertz_says() -> None:
    """2 a and 2 F / pi a of the line contact of a roller with a rigid drum of the effective radii, and its ellipse."""
    run = bd.steady_state(drive(**HARD))
    nip, (_, radius) = bd.derived.nips(run).isel(nip=0), _foundation(run)
    half = hertz_half_width(500.0 / WIDTH, plane_modulus(50e6, 0.45), radius)
    peak = 2.0 * 500.0 / (np.pi * half * WIDTH)
    assert float(nip.force) == pytest.approx(500.0, rel=1e-6)
    assert float(nip.width) == pytest.approx(2.0 * half, rel=PARABOLA)
    assert float(nip.peak_pressure) == pytest.approx(peak, rel=PARABOLA)
    profile = bd.derived.nip_profile(run, "press")
    inner = np.abs(profile.distance.values) < 0.9 * half
    ellipse = peak * np.sqrt(1.0 - (profile.distance.values[inner] / half) ** 2)
    assert profile.pressure.sel(face="press").values[inner] == pytest.approx(ellipse, rel=2.0 * PARABOLA)


@pytest.mark.slow
def test_a_solid_roller_loses_as_johnson_says() -> None:
    """The force eta F a / 3 R."""
    run = bd.steady_state(drive(**{**HARD, "pulley[press].cover": {**SOLID, "loss_factor": 0.02}}))
    nip, (_, radius) = bd.derived.nips(run).isel(nip=0), _foundation(run)
    rolls = 0.02 * 500.0 * 0.5 * float(nip.width) / (3.0 * radius)
    assert float(nip.compression_loss) == pytest.approx(rolls * SPEED * (DRUM + 1.5e-3), rel=PARABOLA)


def test_a_belt_that_stays_compressed_loses_what_it_does_not_give_back() -> None:
    """The set s of the compression 2 f / k at the peak costs s f^2 / k of each meter, and leaves the belt thinner."""
    share, contact = 0.2, 2e9
    changes = {"belt.compression_set": share, "belt.contact_stiffness": contact, "contact.damping": 0.0}
    run = bd.steady_state(drive(**changes, **{"pulley[press].cover": None, "nip[1].force": 5e3}))
    nip, prepared = bd.derived.nips(run).isel(nip=0), run.prepared
    pair = Pair.of(prepared.pulleys[2], prepared.pulleys[0], prepared.belt, prepared.contact_stiffness)
    depth = float(nip.indentation)
    peak, lasting = pair.peak(depth), share * 2.0 * pair.peak(depth) / contact
    assert pair.force(depth) == pytest.approx(5e3, rel=PARABOLA)
    assert float(nip.thickness_after) == pytest.approx(3e-3 - lasting, abs=PARABOLA * lasting)
    lost = share * peak**2 / contact * SPEED * (DRUM + 1.5e-3)
    assert float(nip.compression_loss) == pytest.approx(lost, rel=PARABOLA)
    last, span = run.dataset.isel(time=-1), float(run.dataset.time[-1])
    put_in = float((last.shaft_torque * last.pulley_speed).sum())
    assert put_in == pytest.approx(sum(float(last[one]) / span for one in ("friction_loss", "damping_loss")), rel=1e-4)


def test_an_idle_roller_takes_nothing_and_rolls_on_the_outer_face(idle: bd.Run) -> None:
    nip, last = bd.derived.nips(idle).isel(nip=0), idle.dataset.isel(time=-1)
    assert abs(float(nip.pull.sel(side="roller"))) < 1e-2 * FRICTION * 500.0
    assert float(nip.torque.sel(side="roller")) == 0.0
    face = SPEED * (DRUM + 3e-3) / ROLLER
    assert float(last.pulley_speed.sel(pulley="press")) == pytest.approx(-face, rel=2e-3)
    assert float(nip.speed_ratio) == pytest.approx(1.0, rel=2e-3)


def test_the_energy_account_closes(idle: bd.Run) -> None:
    last, span = idle.dataset.isel(time=-1), float(idle.dataset.time[-1])
    put_in = float((last.shaft_torque * last.pulley_speed).sum())
    lost = sum(float(last[name]) / span for name in ("friction_loss", "damping_loss"))
    assert put_in == pytest.approx(lost, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [3.0, 12.0])
def test_a_cover_loses_as_hysteresis_does_at_any_speed(speed: float) -> None:
    """pi / 4 eta K d^2 of the cover's share K / k of the energy rolls it."""
    run = bd.steady_state(drive(**{"pulley[press].cover.loss_factor": 0.02, "pulley[drum].speed": speed}))
    nip, (stiffness, _) = bd.derived.nips(run).isel(nip=0), _foundation(run)
    cover = run.prepared.pulleys[2].cover
    assert cover is not None
    eta = 0.02 * stiffness / cover.stiffness(WIDTH)
    rolls = rolling_loss(eta, stiffness, float(nip.indentation)) * speed * (DRUM + 1.5e-3)
    assert float(nip.compression_loss) == pytest.approx(rolls, rel=PARABOLA)
    assert float(nip.force) == pytest.approx(500.0, rel=1e-6)


@pytest.mark.slow
def test_driven_pairs_share_the_load() -> None:
    """What the roller drives the drum need not: their torques over their radii add up to the load of the tail."""
    powers = []
    for torque in (0.0, -5.0, -10.0):
        run = bd.steady_state(drive(**{"pulley[press].torque": torque}))
        nip, last = bd.derived.nips(run).isel(nip=0), run.dataset.isel(time=-1)
        power = last.shaft_torque * last.pulley_speed
        powers.append([float(power.sel(pulley=name)) for name in ("drum", "press", "tail")])
        outer = torque * SPEED * (DRUM + 3e-3) / ROLLER / (SPEED * (DRUM + 1.5e-3))
        assert float(nip.pull.sel(side="roller")) == pytest.approx(-outer, rel=5e-3, abs=1.0)
    by_drum, by_press, tail = np.array(powers).T
    np.testing.assert_allclose(by_drum + by_press, -tail, rtol=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.06, 0.15])
def test_unequal_rollers_turn_as_their_surfaces_roll(radius: float) -> None:
    run = bd.steady_state(drive(**{"pulley[press].radius": radius}))
    ratio = float(run.dataset.pulley_speed.isel(time=-1).sel(pulley="press")) / SPEED
    assert ratio == pytest.approx(-(DRUM + 3e-3) / radius, rel=2e-3)


@pytest.mark.slow
def test_the_nip_grips_up_to_coulomb_friction() -> None:
    """M = mu F R; and beyond, the answer names the nip."""
    limit = FRICTION * 500.0 * ROLLER / (1.0 + 1.5e-3 / (DRUM + 1.5e-3))
    held = bd.steady_state(drive(**{"pulley[press].torque": 0.97 * limit}))
    assert float(bd.derived.nips(held).grip.sel(side="roller")[0]) == pytest.approx(0.97, rel=0.01)
    with pytest.raises(ConvergenceError, match="slips in the nip of `press`, which transmits at most"):
        bd.steady_state(drive(**{"pulley[press].torque": 1.05 * limit}))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "forces", "ends"),
    [("calender", [4e3, 8e3], (400.0, 450.0)), ("calender5", [9e3, 7e3, 5e3], (400.0, 500.0))],
)
def test_a_web_is_pressed_between_unwinder_and_winder(
    name: str, forces: list[float], ends: tuple[float, float]
) -> None:
    """Tensions of both ends, pulls of the rollers and the loss of the covers balance along the web."""
    run = bd.steady_state(bd.load(Path(__file__).parents[3] / "docs" / "tasks" / f"{name}.toml"))
    assert run.warnings == []
    last, nips = run.dataset.isel(time=-1), bd.derived.nips(run)
    assert nips.force.values.tolist() == pytest.approx(forces, rel=1e-6)
    spans = last.span.values.tolist()
    before, after = (next(one for one in spans if end in one.split("-")) for end in ("unwinder", "winder"))
    tension = last.span_tension.sel(span=[before, after]).values
    assert tension.tolist() == pytest.approx(ends, rel=1e-4)
    speed = float(last.belt_speed.mean())
    power = float((last.shaft_torque * last.pulley_speed).sum()) + speed * float(tension[1] - tension[0])
    lost = float(last.friction_power.sum() + last.contact_damping_power.sum())
    assert power == pytest.approx(lost, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("by", ["gap", "force"])
def test_a_run_over_time_keeps_the_nip_of_steady_running(idle: bd.Run, by: str) -> None:
    """With the gap that was found for a force, or on a slide with that force, a run from steady running stays there."""
    loading = {"nip[1].force": None, "nip[1].gap": float(bd.derived.nips(idle).gap[0])}
    if by == "force":
        loading = {"pulley[press].mass": 5.0}
    held = drive(**{**loading, "simulation.start": "steady", "simulation.duration": 0.01})
    run = bd.simulate(held)
    one, two = bd.derived.nips(idle).isel(nip=0), bd.derived.nips(run).isel(nip=0)
    assert float(two.force) == pytest.approx(500.0, rel=1e-3)
    assert float(two.width) == pytest.approx(float(one.width), rel=0.01)
    assert abs(float(run.dataset.energy_closure[-1])) < 1e-4


@pytest.mark.slow
def test_a_roller_on_a_spring_swings_on_its_nip() -> None:
    """The force is the preload less what the spring loses; f = sqrt((dF/dd + rate) / m) / 2 pi, dF/dd = 2 K a."""
    mass, rate = 100.0, 2e4
    spring = {"preload": 500.0, "rate": rate, "damping": 300.0}
    slide = {"kind": "sliding", "pulley": "press", "direction": [1, 0], **spring}
    carried = drive(**{"nip[1].force": None, "tensioner": [slide], "pulley[press].mass": mass})
    run = bd.steady_state(carried)
    nip, (stiffness, radius) = bd.derived.nips(run).isel(nip=0), _foundation(run)
    way = float(run.dataset.tensioner_position[-1, 0])
    assert float(nip.force) == pytest.approx(500.0 - rate * way, rel=1e-6)
    found = bd.modes(run, count=10).dataset
    own = found.isel(mode=int(np.argmax(found.tensioner_share.values)))
    grows = 2.0 * stiffness * half_width(float(nip.indentation), radius)
    assert float(own.frequency) == pytest.approx(np.sqrt((grows + rate) / mass) / (2.0 * np.pi), rel=PARABOLA)
    assert float(own.damping_ratio) > 300.0 / (2.0 * np.sqrt(mass * grows))
