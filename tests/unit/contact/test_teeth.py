"""Force of teeth, spread and single: derivatives against differences, potential, nearest groove, backlash."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import ContactFactors, ContactTotals, contact_force, contact_workspace
from beltdyn.contact.contact_zone import Curve
from beltdyn.contact.friction import LAWS
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import NoPull
from beltdyn.contact.penetration import approach
from beltdyn.contact.surface import Polygon, Toothed
from beltdyn.contact.teeth import CREST, LOOSE, Tooth, tooth_at, tooth_of, tooth_traction
from beltdyn.quadrature import gauss_points

LENGTH, RULE = 0.06, gauss_points(6)
GROOVE = 2.0 * np.pi / 40
SPACINGS = pytest.mark.parametrize("spacing", [0.0, 0.0157], ids=["spread", "single"])
LAID = pytest.mark.parametrize(
    ("spacing", "land"), [(0.0, 0.0), (0.0157, 0.0), (0.0157, 5e-3)], ids=["spread", "single", "polygon"]
)
RIM = 0.1 - 1e-6
"""Distance from the shaft of a belt that touches the rim, m."""


def pulley(
    phase: float = 0.01,
    damping: float = 0.0,
    half_gap: float = 0.0,
    speed: float = 7.0,
    *,
    flank: float = 0.3,
    spacing: float = 0.0,
    land: float = 0.0,
) -> PulleyState:
    """A pulley of 40 teeth and 0.1 m, spread or at their middles alone, on a circle or on lands of a radius."""
    teeth = (0.1, 2e6, damping, half_gap, 0.1005, GROOVE / 0.0157, GROOVE, flank, spacing, 5e-3)
    corner = 0.5 * GROOVE * (0.1 - land) / np.sin(0.5 * GROOVE)
    surface = Polygon(*teeth, phase, 1.0, 1.0, land, corner) if land else Toothed(*teeth, phase, 1.0, 1.0)
    return PulleyState(0.3, -0.2, surface, speed=speed, friction=0.2)


def law() -> ContactLaw:
    friction = LAWS["relative_creep"]
    made = friction.record(*(one.example for one in friction.parameters)).smoothed(40.0)
    return ContactLaw(NoPull(1e6, 40.0), made, follow_zone=True, arm_to_rim=True)


def sunk() -> tuple[FloatArray, FloatArray]:
    """Control points of a curve that enters the pulley, and their velocities."""
    along = np.linspace(-0.3, 0.3, 4)
    out = np.stack([np.cos(along), np.sin(along)], axis=1)
    control = np.array([0.3, -0.2]) + (0.1 + 0.002 * np.arange(4)[:, None] / 3 - 5e-4) * out
    return control, 0.7 * np.stack([-out[:, 1], out[:, 0]], axis=1) - 0.02 * out


def act(
    control: FloatArray,
    rates: FloatArray,
    one: PulleyState,
    factors: tuple[float, float] = (0.0, 0.0),
    start: float = 0.0,
) -> tuple[Any, ContactTotals]:
    work = contact_workspace(4, 4)
    curve = Curve(control, rates, np.eye(4), LENGTH, start)
    by = ContactFactors(factors[0], factors[1], factors[1], 0.0, 0.0, False)
    return work, contact_force(curve, one, law(), RULE, by, work)


def answer(*arguments: Any, **more: Any) -> FloatArray:
    """Forces on the vectors, then the moment on the pulley."""
    work, totals = act(*arguments, **more)
    return np.append(work.force.ravel(), totals.moment)


@pytest.mark.parametrize("damping", [0.0, 300.0])
@pytest.mark.parametrize("factors", [(1.0, 0.0), (0.0, 1.0), (1.0, 300.0)])
@pytest.mark.parametrize("phase", [0.01, 0.46 * GROOVE], ids=["seated", "on the crests"])
@LAID
def test_tangent(factors: tuple[float, float], damping: float, spacing: float, land: float, phase: float) -> None:
    control, rates = sunk()
    one, step = pulley(phase, damping, spacing=spacing, land=land), 1e-8 if factors[0] else 1e-5
    work, _ = act(control, rates, one, factors)
    tangent = np.block([[work.xx, work.xy], [work.yx, work.yy]])
    columns = []
    for axis in range(2):
        for b in range(4):
            change = np.zeros((4, 2))
            change[b, axis] = step
            there, back = (
                answer(control + s * factors[0] * change, rates + s * factors[1] * change, one) for s in (1.0, -1.0)
            )
            columns.append((there - back) / (2.0 * step))
    found, size = np.array(columns).T, np.abs(tangent).max()
    forces = np.concatenate([found[:-1:2], found[1:-1:2]])
    np.testing.assert_allclose(tangent, forces, atol=2e-6 * size)  # truncation and rounding of central differences
    np.testing.assert_allclose(work.moment.T.ravel(), found[-1], atol=2e-6 * np.abs(found[-1]).max())


@pytest.mark.parametrize("factors", [(1.0, 0.0), (0.0, 1.0), (1.0, 300.0)])
@LAID
def test_derivative_by_the_turning_of_the_pulley(factors: tuple[float, float], spacing: float, land: float) -> None:
    control, rates = sunk()
    kind = {"spacing": spacing, "land": land}
    work, _ = act(control, rates, pulley(damping=300.0, **kind), factors)
    there, back = (
        answer(control, rates, pulley(0.01 + s * factors[0], 300.0, speed=7.0 + s * factors[1], **kind))
        for s in (1e-7, -1e-7)
    )
    expected = (there - back) / 2e-7
    given = np.append(work.by_turn.ravel(), work.moment_by_turn)
    np.testing.assert_allclose(given, expected, atol=2e-6 * np.abs(expected).max())


def test_derivative_by_the_length_of_belt_that_passes() -> None:
    control, rates = sunk()
    work, _ = act(control, rates, pulley(), (1.0, 0.0))
    there, back = (answer(control, rates, pulley(), start=-s) for s in (1e-7, -1e-7))
    expected = (there - back) / 2e-7
    given = np.append(work.by_flow.ravel(), work.moment_by_flow)
    np.testing.assert_allclose(given, expected, atol=2e-6 * np.abs(expected).max())


def traction(one: PulleyState, angle: float, along: float = 0.0) -> float:
    """Force of teeth at a place on the rim that stands still."""
    x, y = 0.3 + RIM * np.cos(angle), -0.2 + RIM * np.sin(angle)
    here = approach(x, y, 0.0, 0.0, one)
    return float(tooth_traction(tooth_at(one.surface, here, 0.0, along), here))


def test_a_groove_ahead_pulls_and_the_nearest_one_holds() -> None:
    one = pulley(phase=0.0, speed=0.0)
    assert traction(one, -0.01) == pytest.approx(2e6 * 0.1005 * 0.01 * 0.1005 / RIM, rel=1e-12)
    assert traction(one, -0.01 + 3 * GROOVE) == pytest.approx(traction(one, -0.01), rel=1e-9)
    assert traction(one, 0.49 * GROOVE) < 0.0 < traction(one, 0.51 * GROOVE)  # more than half a pitch: a jump
    assert traction(one, -0.01, along=0.0157) == pytest.approx(traction(one, -0.01), rel=1e-9)  # the next tooth


def test_backlash() -> None:
    one = pulley(phase=0.0, half_gap=5e-4, speed=0.0)
    inside, beyond = traction(one, -0.004), traction(one, -0.01)
    assert inside == pytest.approx(LOOSE * 2e6 * 0.1005 * 0.004 * 0.1005 / RIM, rel=1e-9)
    held = (1.0 - LOOSE) * (0.1005 * 0.01 - 5e-4) + LOOSE * 0.1005 * 0.01
    assert beyond == pytest.approx(2e6 * held * 0.1005 / RIM, rel=1e-9)
    assert traction(one, 0.01) == pytest.approx(-beyond, rel=1e-9)


@SPACINGS
def test_what_teeth_take_of_belt_and_pulley_is_power_on_both(spacing: float) -> None:
    control, rates = sunk()
    one = pulley(spacing=spacing)
    work, totals = act(control, rates, one)
    surface = one.surface
    assert isinstance(surface, Toothed)
    smooth = one._replace(surface=surface._replace(stiffness=0.0))
    bare, without = act(control, rates, smooth)
    given = np.sum((work.force - bare.force) * rates) + (totals.moment - without.moment) * 7.0
    assert totals.compression_power - without.compression_power == pytest.approx(-given, rel=1e-9)


def pushed(one: PulleyState, angle: float, distance: float) -> Tooth:
    """A tooth at a place that stands still."""
    here = approach(0.3 + distance * np.cos(angle), -0.2 + distance * np.sin(angle), 0.0, 0.0, one)
    assert isinstance(one.surface, Toothed)
    return tooth_of(one.surface, here, 0.0, 0.0)


def test_flanks_push_the_belt_off_and_let_it_go_as_it_lifts() -> None:
    one = pulley(phase=0.0, speed=0.0)
    seated, lifted = pushed(one, -0.01, RIM), pushed(one, -0.01, 0.102)
    assert seated.push == pytest.approx(0.3 * (1.0 - LOOSE) * seated.traction, rel=1e-12)
    beyond = 0.1005 * 0.01 - 0.3 * 0.002
    left = 1.0 - 0.4**2  # by 2 of 5 mm
    pull = (1.0 - LOOSE) * beyond + LOOSE * 0.1005 * 0.01
    stored = 0.5 * ((1.0 - LOOSE) * beyond**2 + LOOSE * (0.1005 * 0.01) ** 2)
    assert lifted.traction == pytest.approx(2e6 * left**2 * pull, rel=1e-9)
    wedged = 0.3 * (1.0 - LOOSE) * 2e6 * left**2 * beyond
    assert lifted.push == pytest.approx(wedged + 2e6 * 4.0 * left * 0.002 / 0.005**2 * stored, rel=1e-9)
    # play of 1.2 mm on each side of a tooth that is off by 1 mm
    assert abs(pushed(one, -0.01, 0.104).traction) < LOOSE * seated.traction
    assert pushed(one, -0.01, 0.1051).traction == 0.0


@pytest.mark.parametrize("distance", [0.1 + 1e-9, 0.102, 0.1049])
def test_the_force_of_a_tooth_has_a_potential(distance: float) -> None:
    """The work on a path around a groove is that back on another one."""
    one = pulley(phase=0.0, speed=0.0, half_gap=2e-4)
    step, angles = 1e-6, np.linspace(0.0, GROOVE, 4001)
    inner, outer = ([pushed(one, -a, r) for a in angles] for r in (distance, distance + step))
    off = np.array([0.5 * (a.push + b.push) for a, b in zip(inner, outer, strict=True)]) * step
    along = 0.1005 * np.diff(angles)
    work = [np.array([one.traction for one in row]) for row in (inner, outer)]
    stored = [np.concatenate([[0.0], np.cumsum(0.5 * (row[1:] + row[:-1]) * along)]) for row in work]
    lost = stored[0] - stored[1] - (off - off[0])
    assert np.abs(stored[0]).max() > 0.0
    np.testing.assert_allclose(lost, 0.0, atol=1e-3 * np.abs(off).max())


def test_the_force_of_a_tooth_is_even_where_crests_meet_and_where_it_leaves() -> None:
    one = pulley(phase=0.0, speed=0.0)
    size = pushed(one, -0.5 * (1.0 - CREST) * GROOVE, RIM).traction
    for beside in (0.5 - 1e-9, 0.5 + 1e-9):
        assert abs(pushed(one, -beside * GROOVE, RIM).traction) < 1e-6 * size
    leaving = pushed(one, -0.3 * GROOVE, 0.105 - 1e-8)
    assert max(abs(leaving.traction), leaving.push) < 1e-4 * size


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_tooth_pulls_in_proportion_to_its_way_over_four_fifths_of_half_a_pitch(side: float) -> None:
    one = pulley(phase=0.0, speed=0.0)
    near, far, beyond = (pushed(one, side * part * 0.5 * GROOVE, RIM).traction / part for part in (0.1, 0.79, 0.9))
    assert far == pytest.approx(near, rel=1e-9)
    assert abs(beyond) < 0.99 * abs(near)


def test_single_teeth_leave_no_force_to_the_points_between() -> None:
    one = pulley(phase=0.0, spacing=0.0157)
    here = approach(0.3 + RIM * np.cos(0.02), -0.2 + RIM * np.sin(0.02), 0.1, 0.2, one)
    tooth = tooth_at(one.surface, here, 7.0, 0.0)
    assert isinstance(one.surface, Toothed)
    spread = tooth_of(one.surface, here, 7.0, 0.0)
    kept = {"pitch_radius", "rate", "by_flow"}
    assert {name for name, value in tooth._asdict().items() if value != 0.0} == kept
    assert {name for name, value in spread._asdict().items() if value != 0.0} > kept


def test_a_single_tooth_has_the_force_of_a_pitch_of_spread_ones() -> None:
    control, rates = sunk()
    one, around = pulley(spacing=0.0157), np.arange(4) * 0.0157
    work, totals = act(control, rates, one)
    assert isinstance(one.surface, Toothed)
    smooth = one._replace(surface=one.surface._replace(stiffness=0.0))
    bare, without = act(control, rates, smooth)
    moment = 0.0
    for along in around:
        xi = along / LENGTH
        x, y = np.array([(1 - xi) ** 3, 3 * xi * (1 - xi) ** 2, 3 * xi**2 * (1 - xi), xi**3]) @ control
        tooth = pushed(one, np.arctan2(y + 0.2, x - 0.3), np.hypot(x - 0.3, y + 0.2))
        here = approach(x, y, 0.0, 0.0, one)
        moment -= 0.0157 * 0.1005 * tooth_of(one.surface, here, 0.0, along).traction
        assert tooth.pitch_radius == 0.1005
    assert totals.moment - without.moment == pytest.approx(moment, rel=1e-9)
    assert np.abs(work.force - bare.force).max() > 0.0


def test_a_tooth_at_the_end_of_an_element_acts_once() -> None:
    control, rates = sunk()
    one = pulley(spacing=LENGTH / 3.0, speed=0.0)
    assert isinstance(one.surface, Toothed)
    one = one._replace(surface=one.surface._replace(rate=GROOVE / (LENGTH / 3.0)))
    alone = act(control, 0.0 * rates, one)[1].moment
    ahead = act(control, 0.0 * rates, one, start=LENGTH * (1.0 - 1e-15))[1].moment
    assert alone == pytest.approx(ahead, rel=1e-6)
