"""Nips against closed forms of an elastic foundation, rolling, Coulomb friction, transport of webs, and energy."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model.nip import Pair, side_stiffness
from beltdyn.results.energy_balance import largest_closure
from beltdyn.theory.nip import (
    equivalent_radius,
    force,
    half_width,
    hertz_half_width,
    plane_modulus,
    rolling_loss,
    series,
)

EXAMPLES = Path(__file__).parents[3] / "docs" / "tasks"
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


def require_no_loss_in_the_damper(seed: int) -> None:
    """Power of the drum is that of the load and of friction; contact damping takes below 0.1 % of the load."""
    rng = np.random.default_rng(seed)
    force, tension = 10.0 ** rng.uniform(2.5, 3.8), 10.0 ** rng.uniform(2.7, 3.5)
    load = rng.uniform(max(0.03 * force, 0.1 * tension), max(0.06 * force, 0.7 * tension))
    cover = {"thickness": rng.uniform(5e-3, 15e-3), "youngs_modulus": 10.0 ** rng.uniform(6.5, 7.5)}
    solid = {"youngs_modulus": 10.0 ** rng.uniform(7.5, 8.5)}
    changes = {
        "belt.installed_tension": tension,
        "belt.contact_stiffness": 10.0 ** rng.uniform(9.0, 10.6),
        "belt.mass_per_length": rng.uniform(0.2, 2.0),
        "pulley[drum].speed": rng.uniform(0.5, 6.0) / DRUM,
        "pulley[tail].torque": -load * TAIL,
        "pulley[press].cover": {"poissons_ratio": 0.45, **(cover if rng.random() < 0.7 else solid)},
        "nip[1].force": force,
    }
    last = bd.steady_state(drive(**changes)).dataset.isel(time=-1)
    power = float((last.shaft_torque * last.pulley_speed).sum())
    damped, rubbed = float(last.contact_damping_power.sum()), float(last.friction_power.sum())
    carried = load * float(last.belt_speed.mean())
    assert damped < 1e-3 * carried, seed
    assert power == pytest.approx(damped + rubbed, abs=3e-4 * carried), seed


def test_contact_damping_takes_no_power_in_a_nip() -> None:
    require_no_loss_in_the_damper(57)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(200, 240))
def test_contact_damping_takes_no_power_in_drawn_nips(seed: int) -> None:
    require_no_loss_in_the_damper(seed)


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
    run = bd.steady_state(bd.load(EXAMPLES / f"{name}.toml"))
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


# Webs over time and their vibrations: driven pairs of rollers, and calenders

ROLL, WEB, AXIAL, ENTERS, HEAVY = 0.05, 2.0, 2e4, 100.0, 0.05
LARGE, PRESSED = 2e-3, 0.3
"""A draw and friction with which arcs alone would slip."""
RISE = (0.05, 0.10)


def pairs(last: Any, **more: Any) -> bd.Drive:
    """Two driven rollers, each with a roller that presses the web on its arc and turns with it."""
    cover = {"thickness": 5e-3, "youngs_modulus": 4e6, "poissons_ratio": 0.45}
    press = {"radius": 0.04, "side": "outside", "inertia": 1e-3, "mass": 2.0, "cover": cover}
    rollers = [
        {"name": "first", "center": [0.5, 0.0], "radius": ROLL, "speed": WEB / ROLL},
        press | {"name": "one", "center": [0.448, -0.193]},
        {"name": "last", "center": [1.5, 0.0], "radius": ROLL, "speed": last},
        press | {"name": "two", "center": [1.552, -0.193]},
    ]
    nips = [
        {"roller": "one", "pulley": "first", "force": 1000.0},
        {"roller": "two", "pulley": "last", "force": 1000.0},
    ]
    settings = {"duration": 1.1, "start": "steady", "output_interval": 5e-3, "rtol": 3e-5}
    web = {"axial_stiffness": AXIAL, "bending_stiffness": 1e-4, "mass_per_length": HEAVY}
    base = bd.Drive(
        belt={**web, "thickness": 1e-4, "width": 0.2, "contact_stiffness": 1e11},
        unwinder={"point": [0.0, 0.3], "tension": ENTERS},
        pulley=rollers,
        winder={"point": [2.0, 0.3], "tension": ENTERS},
        nip=nips,
        contact={"friction": PRESSED, "damping": 3e3, "creep_ratio": 3e-5},
        simulation=settings,
    )
    return base.with_(more)


def behind_the_nip(drive: bd.Drive, tension: FloatArray) -> FloatArray:
    """Unstretched web on the arc behind the first nip, m: it slides from where it leaves on, at most up to the nip."""
    path, lifted = drive.path, HEAVY * WEB**2
    rest = float(path.wrap_angles[0] - path.nip_angles[0])
    slides = np.clip(np.log((tension - lifted) / (ENTERS - lifted)) / PRESSED, 0.0, rest)
    angles = slides * np.linspace(0.0, 1.0, 201)[:, None]
    along = (tension - lifted) * np.exp(-PRESSED * angles) + lifted
    sliding = np.trapezoid(1.0 / (1.0 + along / AXIAL), angles, axis=0)
    return np.asarray(ROLL * (sliding + (rest - slides) / (1.0 + ENTERS / AXIAL)))


@pytest.fixture(scope="module")
def gripped() -> bd.Run:
    """A line of two driven pairs, of which the second gets faster."""
    faster = WEB / ROLL * np.array([1.0, 1.0, 1.0 + LARGE, 1.0 + LARGE])
    return bd.simulate(pairs({"kind": "table", "times": [0.0, *RISE, 10.0], "values": faster.tolist()}))


@pytest.mark.slow
def test_driven_pairs_transport_a_draw(gripped: bd.Run) -> None:
    """To 0.1 % of the change of the draw, beyond what the arcs would hold without the nips."""
    drive, time = gripped.drive, gripped.dataset.time.values
    tension = np.linspace(ENTERS, ENTERS + 1.2 * AXIAL * LARGE, 2001)
    thin = 1.0 / (1.0 + tension / AXIAL)
    content = float(drive.path.span_lengths[0]) * thin + behind_the_nip(drive, tension)

    def flow(at: float, held: FloatArray) -> FloatArray:
        part = np.clip((at - RISE[0]) / (RISE[1] - RISE[0]), 0.0, 1.0)
        return np.asarray(WEB * (thin[0] - (1.0 + LARGE * part) * np.interp(held, content[::-1], thin[::-1])))

    found = solve_ivp(flow, (0.0, time[-1]), [content[0]], t_eval=time, rtol=1e-10, atol=1e-13, max_step=0.01)
    expected = np.interp(found.y[0], content[::-1], tension[::-1])
    wrap = float(drive.path.wrap_angles[0])
    assert expected[-1] > 1.1 * ENTERS * np.exp(PRESSED * wrap)
    tensions = gripped.dataset.span_tension.values[:, 0]
    assert np.abs(tensions - expected)[time > 0.2].max() < 1e-3 * AXIAL * LARGE


@pytest.mark.slow
def test_before_the_draw_changes_the_pairs_run_steadily(gripped: bd.Run) -> None:
    """Tensions, torques, forces and widths are those of steady running to 1e-4 of the largest, and stay."""
    steady = bd.steady_state(pairs(WEB / ROLL))
    before, last = gripped.dataset.isel(time=gripped.dataset.time < RISE[0]), steady.dataset.isel(time=-1)
    for name in ("span_tension", "pulley_speed", "nip_width"):
        expected = last[name].values
        assert np.abs(before[name].values - expected).max() < 1e-4 * np.abs(expected).max()
    assert np.abs(before.shaft_torque.values - last.shaft_torque.values).max() < 1e-4 * ENTERS * ROLL
    loads = np.linalg.norm(before.hub_force.sel(pulley=["one", "two"]).values, axis=-1)
    assert loads == pytest.approx(1000.0, rel=1e-6)


@pytest.mark.slow
def test_energy_closes_with_the_flow_through_the_ends(gripped: bd.Run) -> None:
    """To 2e-4 on the mesh of a run; on a fine one to 1e-5."""
    assert abs(largest_closure(gripped.dataset).error) < 2e-4
    fine = bd.steady_state(pairs(WEB / ROLL * (1.0 + LARGE)), force_tolerance=1e-6)
    assert abs(largest_closure(fine.dataset).error) < 1e-5


@pytest.mark.slow
def test_a_varying_draw_of_a_pair_varies_the_tension() -> None:
    """Amplitude and phase to 1 %: dv / g over v / g^2 EA + i w C, with the content of the arc behind the nip."""
    orders, part, faster = np.array([0.02, 0.05, 0.2, 1.0, 3.0]), 1e-5, WEB * (1.0 + LARGE)
    waves = [{"order": one, "amplitude": part} for one in orders.tolist()]
    drive = pairs(faster / ROLL, **{"pulley[last].harmonics": waves})
    found = bd.response(drive, speed=[faster / ROLL], pulley="last").dataset.isel(speed=0, span=0)
    length, tension = float(drive.path.span_lengths[0]), float(found.span_tension)
    stretch, step = 1.0 + tension / AXIAL, 0.1
    thinner = 1.0 / AXIAL / stretch**2
    lower, upper = behind_the_nip(drive, tension + np.array([-step, step]))
    turning = orders * faster / ROLL
    expected = part * faster / stretch / (faster * thinner + 1j * turning * (length * thinner - (upper - lower) / 0.2))
    amplitude = found.span_tension_amplitude.values * np.exp(1j * found.span_tension_phase.values)
    assert amplitude == pytest.approx(expected, rel=0.01)


@pytest.mark.slow
def test_rollers_swing_on_their_covers() -> None:
    """Frequency to 1 %, sqrt(2 K a / m); damping to 5 %, 3 pi / 64 eta a w / v, with little friction, which adds to it.

    A damper c = 3 pi / 32 eta K a / v on the foundation loses what hysteresis does while the web passes. On the same
    mesh, that of the slope of friction found first, a Campbell diagram agrees; from mesh to mesh it moves by 3e-4.
    """
    mass, losses = 40.0, {"upper": 0.1, "lower": 0.05}
    little = {
        f"pulley[{name}].{key}": value for name in losses for key, value in (("friction", 0.03), ("torque", -1.0))
    }
    run = bd.steady_state(bd.steady_state(bd.load(EXAMPLES / "calender.toml").with_(little)).drive)
    nips, prepared = bd.derived.nips(run), run.prepared
    found = bd.modes(run, count=30).dataset
    campbell = bd.campbell(run.drive, speed="40 rpm", count=30).dataset.isel(speed=0)
    for name, loss in losses.items():
        roller = prepared.pulleys[run.drive.number_of(name)]
        pair = Pair.of(roller, prepared.pulleys[0], prepared.belt, prepared.contact_stiffness)
        half = half_width(float(nips.indentation.sel(nip=name)), pair.radius)
        turning = np.sqrt(2.0 * pair.stiffness * half / mass)
        own = found.isel(mode=int(np.argmax(found.tensioner_share.sel(tensioner=name).values)))
        assert 2.0 * np.pi * float(own.frequency) == pytest.approx(turning, rel=0.01)
        assert roller.cover is not None
        shared = loss * pair.stiffness / roller.cover.stiffness(0.4)
        expected = 3.0 * np.pi / 64.0 * shared * half * turning / float(run.dataset.belt_speed[-1].mean())
        assert float(own.damping_ratio) == pytest.approx(expected, rel=0.05)
        assert np.abs(campbell.frequency.values - float(own.frequency)).min() < 1e-4 * float(own.frequency)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["calender", "calender5"])
def test_calenders_stay_in_steady_running(name: str) -> None:
    """A run that is held agrees to 1e-3 of tensions, torques, speeds, and widths and forces of the nips."""
    drive = bd.load(EXAMPLES / f"{name}.toml")
    steady, run = bd.steady_state(drive), bd.simulate(drive.with_({"simulation.duration": 0.5}))
    found, expected = run.dataset.isel(time=-1), steady.dataset.isel(time=-1)
    for variable in ("span_tension", "shaft_torque", "pulley_speed", "nip_width"):
        largest = np.abs(expected[variable].values).max()
        assert found[variable].values == pytest.approx(expected[variable].values, abs=1e-3 * largest)
    one, two = bd.derived.nips(run), bd.derived.nips(steady)
    assert one.force.values == pytest.approx(two.force.values, rel=1e-3)
    assert one.thickness.values == pytest.approx(two.thickness.values, rel=1e-3)
    assert abs(largest_closure(run.dataset).error) < 1e-4
    assert run.dataset.span.values.tolist() == steady.dataset.span.values.tolist()
    assert np.isfinite(run.dataset.span_tension.values).all()


@pytest.mark.slow
def test_a_roller_without_mass_that_a_force_presses_is_refused() -> None:
    drive = pairs(WEB / ROLL, **{"pulley[two].mass": 0.0})
    for analysis in (bd.simulate, bd.modes):
        with pytest.raises(ModelError, match=r'has no mass\. Give mass for the pulley "two", or gap'):
            analysis(drive)
