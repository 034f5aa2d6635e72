"""Drive sheets of five trades, typed from suppliers' forms alone, against an independent lumped model.

`tests.lumped` has its tensions and positions; hub loads and modes follow here from its spans, with strain that flows
with the belt.  What bending lifts off and what slides behind an arc stretches with the span.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive, loads, prepare
from beltdyn.points.changed_drive import at_instant
from beltdyn.points.duty import at_row, duty_of
from beltdyn.points.quasi_steady import torques_of
from beltdyn.state.staying import bring_to_stand
from tests.lumped.lumped_balance import Balanced, LumpedBalance, Route

ACCESSORY = """
name = "Accessory drive, crank clockwise"
[belt]
profile = "PK"
ribs = 6
[[pulley]]
name = "crank"
center = ["0 mm", "0 mm"]
diameter = "160 mm"
diameter_kind = "effective"
speed = "800 rpm clockwise"
[[pulley]]
name = "compressor"
center = ["215 mm", "20 mm"]
diameter = "123 mm"
diameter_kind = "pitch"
inertia = "20 kg cm^2"
load = [{ kind = "power", speeds = ["1000 rpm", "4000 rpm"], powers = ["1.2 kW", "3 kW"] }]
[[pulley]]
name = "idler"
center = ["280 mm", "150 mm"]
diameter = "70 mm"
diameter_kind = "flat"
inertia = "1.5 kg cm^2"
[[pulley]]
name = "alternator"
center = ["235 mm", "255 mm"]
diameter = "56 mm"
inertia = "35 kg cm^2"
[[pulley]]
name = "steering"
center = ["-55 mm", "300 mm"]
diameter = "130 mm"
inertia = "15 kg cm^2"
[[pulley]]
name = "tensioner"
diameter = "70 mm"
diameter_kind = "flat"
inertia = "1.5 kg cm^2"
mass = "0.2 kg"
[[tensioner]]
kind = "rotary"
pulley = "tensioner"
pivot = ["-130 mm", "80 mm"]
arm_length = "75 mm"
free_angle = "23.63 deg"
load_stop_angle = "68 deg"
preload = "11.8 N m"
rate = "0.4 N m/deg"
sense = "clockwise"
inertia = "6 kg cm^2"
damping = 0.02
[[duty]]
name = "idle"
share = "60 %"
speed = "800 rpm"
power = { alternator = "0.6 kW", steering = "0.3 kW" }
[[duty]]
name = "highway"
share = "40 %"
speed = "2200 rpm"
power = { alternator = "1.2 kW", steering = "0.2 kW" }
[simulation]
duration = 1.0
"""
FAN = """
name = "Fan, two wrapped belts"
[belt]
profile = "SPA"
ribs = 2
installed_tension = "1300 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "165.5 mm"
diameter_kind = "outside"
speed = "1460 rpm"
[[pulley]]
name = "fan"
center = ["700 mm", "0 mm"]
diameter = "250 mm"
diameter_kind = "datum"
inertia = 0.8
load = [{ kind = "fan", rated_power = "11 kW", rated_speed = "930 rpm" }]
[simulation]
duration = 1.0
"""
WASHING = """
name = "Washing machine"
[belt]
profile = "PJ-elastic"
ribs = 6
installed_tension = "260 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "24 mm"
speed = "10000 rpm"
[[pulley]]
name = "drum"
center = ["20 mm", "280 mm"]
diameter = "250 mm"
inertia = 0.3
[[duty]]
name = "wash"
duration = "50 min"
speed = "600 rpm"
power = { drum = "60 W" }
[[duty]]
name = "spin"
duration = "8 min"
speed = "12000 rpm"
power = { drum = "450 W" }
[simulation]
duration = 1.0
"""
FLAT = """
name = "Conveyor, flat belt on a slide"
[belt]
profile = "flat-polyamide"
width = "60 mm"
[contact]
friction = 0.5
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "200 mm"
speed = "970 rpm"
[[pulley]]
name = "drum"
center = ["1200 mm", "100 mm"]
diameter = "400 mm"
inertia = 0.6
load = [{ kind = "power", speeds = ["485 rpm"], powers = ["6 kW"] }]
[[pulley]]
name = "idler"
center = ["300 mm", "190 mm"]
diameter = "160 mm"
diameter_kind = "flat"
inertia = 0.02
mass = "4 kg"
[[tensioner]]
kind = "rotary"
pulley = "idler"
pivot = ["550 mm", "420 mm"]
preload = "150 N m"
rate = "1 N m/deg"
inertia = "0.1 kg m^2"
damping = 2.0
[simulation]
duration = 1.0
"""
SPINDLE = """
name = "Spindle of a lathe"
[belt]
profile = "PL"
ribs = 8
nominal_length = "1600 mm"
installed_tension = "900 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "140 mm"
speed = "2000 rpm"
[[pulley]]
name = "spindle"
center = ["560 mm", "80 mm"]
diameter = "180 mm"
diameter_kind = "effective"
inertia = 0.06
load = [{ kind = "power", speeds = ["1500 rpm", "4000 rpm"], powers = ["9 kW", "11 kW"] }]
[[tensioner]]
kind = "fixed"
pulley = "motor"
direction = [-1, 0]
[simulation]
duration = 1.0
"""
FORMS = {"accessory": ACCESSORY, "fan": FAN, "washing": WASHING, "flat": FLAT, "spindle": SPINDLE}


@cache
def sheet_of(name: str) -> bd.Result:
    return bd.sheet(loads(FORMS[name]), points=3)


def lumped(name: str, row: int) -> tuple[Drive, LumpedBalance, Balanced]:
    """The independent model at an operating point: the belt's length is that with bending, at rest."""
    held = bring_to_stand(prepare(at_instant(loads(FORMS[name]), None))).drive
    columns = duty_of(held, None)
    drive = held if columns is None else at_row(held, columns, row)
    assert drive.driver is not None
    speed = float(drive.pulleys[drive.driver].speed.at([0.0])[0]) * drive.path.radii[drive.driver]  # type: ignore[union-attr]
    torques = torques_of(drive, drive.driver)(speed)
    pulleys = [
        one if one.prescribed else one.replace(torque={"kind": "constant", "value": torque}, load=())
        for one, torque in zip(drive.pulleys, torques.tolist(), strict=True)
    ]
    balance = LumpedBalance.of(drive.replace(pulley=pulleys))
    return drive, balance, balance.at(1.0)


@pytest.mark.parametrize("name", FORMS)
def test_tensions_hub_loads_and_positions(name: str, measured: Callable[..., None]) -> None:
    """Within 1 % of the largest ones; positions within 1 % of the radius of the pulley."""
    dataset = sheet_of(name).dataset
    for row in range(dataset.sizes["row"]):
        _, balance, state = lumped(name, row)
        found = dataset.isel(row=row)
        largest = float(state.tensions.max())
        tension = np.abs(found.span_tension.values - state.tensions).max() / largest
        route = route_of(balance, state.positions)
        pressing = (state.tensions - balance.lifted)[:, None] * route.directions
        hub_load = np.linalg.norm(pressing - np.roll(pressing, 1, axis=0), axis=1)
        hub = np.abs(found.hub_load.values - hub_load).max() / float(hub_load.max())
        measured(row=row, tension=tension, hub=hub)
        assert tension < 0.01
        assert hub < 0.01
        for number, spring in enumerate(balance.springs):
            away = float(found.tensioner_position.values[number] - state.positions[number]) / spring.scale
            measured(position=away)
            assert abs(away) < 0.01


def route_of(balance: LumpedBalance, positions: FloatArray) -> Route:
    centers = balance.centers.copy()
    for spring, position in zip(balance.springs, positions.tolist(), strict=True):
        centers[spring.pulley] = spring.place(position)
    return Route.around(centers, balance.radii)


def modes_of(drive: Drive, balance: LumpedBalance, state: Balanced) -> FloatArray:
    """Frequencies, Hz, of rims and tensioners on spans between arcs on which strain flows and creeps."""
    count, springs, radii = balance.radii.size, balance.springs, balance.radii
    pressing, ways = state.tensions - balance.lifted, np.eye(count + len(springs))
    stretch = np.array([radii[(i + 1) % count] * ways[(i + 1) % count] - radii[i] * ways[i] for i in range(count)])

    def length(positions: FloatArray) -> FloatArray:
        """Of spans less the belt that rolls on their rims, m."""
        route = route_of(balance, positions)
        angle = np.unwrap(np.arctan2(route.directions[:, 1], route.directions[:, 0]))
        return np.asarray(route.spans + (radii - np.roll(radii, -1)) * (angle - angle[0]))

    stiffness, route, step = np.zeros(ways.shape), route_of(balance, state.positions), 1e-4
    inertia = [one.inertia for one in drive.pulleys]
    for number, spring in enumerate(springs):
        one, moved = drive.moving_tensioners[number], step * np.eye(len(springs))[number]
        ahead, here, behind = (length(state.positions + sign * moved) for sign in (1.0, 0.0, -1.0))
        stretch[:, count + number] = (ahead - behind) / (2.0 * step)
        bend = pressing @ (ahead - 2.0 * here + behind) / step**2
        stiffness[count + number, count + number] = one.spring["rate"] + bend
        inertia.append(one.moved_inertia(np.array(drive.centers[spring.pulley]), drive.pulleys[spring.pulley].mass))
    mass = np.diag(np.array(inertia))
    for i in range(count):
        j, rod = (i + 1) % count, balance.mass * route.spans[i] / 6.0
        mass[i, i] += 2.0 * rod * radii[i] ** 2 + balance.mass * abs(radii[i]) ** 3 * route.wraps[i]
        mass[j, j] += 2.0 * rod * radii[j] ** 2
        mass[[i, j], [j, i]] += rod * radii[i] * radii[j]
    free = [number for number in range(ways.shape[0]) if number != balance.driver]
    dashpots = np.diag([0.0] * count + [one.spring["damping"] for one in drive.moving_tensioners])[np.ix_(free, free)]
    mass, stiffness, stretch = mass[np.ix_(free, free)], stiffness[np.ix_(free, free)], stretch[:, free]
    flow = Flow.along(drive, balance, state, route)
    elastic = balance.axial + state.tensions

    def dynamic(rate: complex, part: float) -> ComplexArray:
        """M s^2 + C s + K with a part of what flows."""
        tension = np.linalg.solve(flow.at(rate, part), np.diag(elastic * rate) @ stretch)
        return np.asarray(mass * rate**2 + dashpots * rate + stiffness + stretch.T @ tension)

    inverse, size = np.linalg.inv(mass), len(free)
    still = stiffness + stretch.T @ np.diag(elastic / flow.lengths) @ stretch
    values = np.linalg.eigvals(
        np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ still, -inverse @ dashpots]])
    )
    found = [followed(dynamic, complex(one)) for one in values[values.imag > 1.0]]
    return np.sort([one.imag for one in found if -one.real < 0.5 * abs(one)]) / (2.0 * np.pi)


def followed(dynamic: Callable[[complex, float], ComplexArray], root: complex) -> complex:
    """A root of det A(s) as the belt starts to flow, by Newton's method: ds = -1 / tr(A^-1 A')."""
    for part in np.linspace(0.05, 1.0, 20).tolist():
        for _ in range(50):
            step = 1e-6 * abs(root)
            slope = (dynamic(root + step, part) - dynamic(root - step, part)) / (2.0 * step)
            try:
                away = 1.0 / np.trace(np.linalg.solve(dynamic(root, part), slope))
            except np.linalg.LinAlgError:
                break  # A is singular at the root itself
            root -= complex(away)
            if abs(away) < 1e-9 * abs(root):
                break
    return root


class Flow(NamedTuple):
    """A belt that carries strain through spans, shape (spans,), and over the arcs before them.

    On an arc the slip velocity w = |v| b T' / EA, with the law of creep, moves strain: T. + |v| T' = |v| b T''.
    """

    speed: float
    sense: float
    lengths: FloatArray
    """That stretch with spans, m, where nothing flows: with what lifts off and slides."""
    arcs: FloatArray
    """Where the belt creeps, m."""
    layers: FloatArray
    """b, m."""

    @classmethod
    def along(cls, drive: Drive, balance: LumpedBalance, state: Balanced, route: Route) -> "Flow":
        radii, pressing = np.abs(balance.radii), state.tensions - balance.lifted
        entry, leaving = (np.roll(pressing, 1), pressing) if balance.sense > 0.0 else (pressing, np.roll(pressing, 1))
        held = balance.friction * leaving
        creep = prepare(drive).friction_parameters.saturation(leaving / radii, balance.friction, balance.speed)
        layers = radii * balance.axial * creep / (balance.speed * held)
        slid = radii * np.abs(np.log(entry / leaving)) / balance.friction
        stored = radii * np.abs(entry - leaving) / held
        lifted, arcs = np.sqrt(balance.bending / pressing), radii * route.wraps
        lifts = np.minimum(lifted, 0.5 * arcs), np.minimum(np.roll(lifted, 1), 0.5 * arcs)
        adhering = np.maximum(arcs - lifts[0] - lifts[1] - slid, 1e-9)
        before = (one if balance.sense > 0.0 else np.roll(one, -1) for one in (stored, adhering, layers))
        stored, adhering, layers = before
        lengths = route.spans + lifts[0] + np.roll(lifts[1], -1) + stored
        return cls(balance.speed, balance.sense, lengths, adhering, layers)

    def at(self, rate: complex, part: float) -> ComplexArray:
        """Of tensions of spans, in l T. = EA e. + w EA at the next arc - w EA behind the last one."""
        count = self.lengths.size
        found = np.diag(self.lengths * rate).astype(complex)
        for span, (arc, layer) in enumerate(zip(self.arcs.tolist(), self.layers.tolist(), strict=True)):
            before = (span - 1) % count if self.sense > 0.0 else (span + 1) % count
            root = np.sqrt(1.0 + 4.0 * rate * layer / self.speed)
            decay, growth = (1.0 - root) / (2.0 * layer), (1.0 + root) / (2.0 * layer)
            ends = np.array([[1.0, np.exp(-growth * arc)], [np.exp(decay * arc), 1.0]])
            slopes = np.array([[decay, growth * np.exp(-growth * arc)], [decay * np.exp(decay * arc), growth]])
            slips = part * self.speed * layer * slopes @ np.linalg.inv(ends)
            for neighbor, sign, slip in ((before, -1.0, slips[0]), (span, 1.0, slips[1])):
                found[neighbor, before] += sign * slip[0]
                found[neighbor, span] += sign * slip[1]
        return found


@pytest.mark.parametrize("name", FORMS)
def test_first_modes(name: str, measured: Callable[..., None]) -> None:
    """Of the row of the largest power, within 3 %; how loads change with the speed is left out of the lumped model."""
    dataset = sheet_of(name).dataset
    row = int(np.argmax(np.abs(dataset.power.values[:, 0])))
    expected, found = modes_of(*lumped(name, row)), dataset.mode_frequency.values
    for one, other in zip(found[:3], expected, strict=False):
        measured(sheet=one, lumped=other)
        assert one == pytest.approx(other, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMS)
def test_finite_elements(name: str, measured: Callable[..., None]) -> None:
    """Tensions and hub loads within 1 %; within 3 % each mode, up to the last one that the finite elements list."""
    drive = loads(FORMS[name])
    dataset = bd.sheet(drive, points=2, full=True).dataset
    error = np.abs(dataset.full_span_tension - dataset.span_tension).max() / dataset.full_span_tension.max()
    hub = np.abs(dataset.full_hub_load - dataset.hub_load).max() / dataset.full_hub_load.max()
    measured(tension=float(error), hub=float(hub))
    assert error < 0.01
    assert hub < 0.01
    row = int(np.argmax(np.abs(dataset.power.values[:, 0])))
    columns = duty_of(drive, None)
    at = drive if columns is None else at_row(at_instant(drive, None), columns, row)
    modes = bd.modes(at, about=bd.steady_state(at)).dataset
    turning = modes.frequency.values[(modes.kind != "span").values & (modes.damping_ratio < 0.5).values]
    found = dataset.mode_frequency.values
    found = found[found < 1.03 * modes.frequency.values.max()]
    assert found.size
    for one in found:
        measured(mode=one, off=float(np.abs(turning / one - 1.0).min()))
        assert np.abs(turning / one - 1.0).min() < 0.03
