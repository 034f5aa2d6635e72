"""From a belt at rest to steady running: continuation in the loads, from a belt that runs without any.

Without loads all rims have the belt's speed, and a web the same tension at both ends: what is found at rest runs on as
it is, but for its inertia and losses.  Torques, resistances, differences of prescribed speeds and of tensions grow from
there in proportion (`solvers.continuation`).
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import product

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.machines.loads.shaft import ShaftLoads
from beltdyn.model import Drive, Prepared
from beltdyn.parts.messages import listing
from beltdyn.parts.quantity import RPM
from beltdyn.results.checks.machines import FRICTION_USED
from beltdyn.solvers.continuation import Solution, extrapolated, follow, turn
from beltdyn.state.newton import FOUND, SteadyWork, find_steady, make_step, steady_work
from beltdyn.state.slip_limit import GROSS, Passed, Refusal, Setting, Tensions, gross_slips, slack, slip_limit
from beltdyn.state.staying import TOLERANCE, Standing, transfer
from beltdyn.state.way import Way
from beltdyn.system.arc_mesh import fitted, shifts_of
from beltdyn.system.arrays import System
from beltdyn.system.build import loses_in_bending, on_other_mesh, with_bending_loss
from beltdyn.system.build_machines import with_resistance
from beltdyn.system.constant_drive import (
    constant_drive,
    drive_shafts,
    dry_friction_of,
    guess_hubs,
    operating_point,
    own_torque,
    rigid_links,
    twists,
    with_speeds_unknown,
)
from beltdyn.system.meshing import fit_phases, has_teeth, led_by, mesh_speeds, on_lengths, phases
from beltdyn.system.nips import nip_loads, pressed_on, with_own_rollers
from beltdyn.system.ring_matrix import clear, determinant_sign, substitute
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at
from beltdyn.system.web import content, rebased, set_content, with_part_of_tensions

_MAX_NEWTON_STEPS = 25
"""Iterations of a step."""
_ON_THE_WAY = 1e-6
"""Tolerance of solutions that only lead to others, over the smallest radius.  With 1e-5 Newton's method stops short of
where no solution is any more, and what a drive transmits comes out 0.2 % too large."""
_SOFT = 0.05
"""Length over which slow changes of the stretch are smoothed at first on another mesh, over that of the drive."""
_SMOOTHINGS = 10.0, 100.0
"""Of friction at first on another mesh, where the search fails without."""
_SHORTEST = 0.01
"""Step towards the setting on another mesh, over the whole way, below which smoother friction takes over.  In the
accessory drive, whose idlers of small wrap turn the sense of hysteresis, 0.001 takes three times as many iterations."""
_FIRST_SETTINGS = (0.0, 1.0), (0.05, 1.0), (0.0, 30.0)
"""Part of the loads with which a belt begins to run, and factor that smooths friction up to the full loads.  Without
loads shafts behind open clutches turn along, which slip under the least of them; a web whose rollers begin to slide one
after the other passes sharp corners, which smoothing rounds."""
_SLOW = 0.01
"""Speed of a belt that begins to run where it does not at its full speed, over that."""
_NEAR = 1e-3
"""Part of the way to another push at which the tangent still tells the solution."""
_FIRST_CHANGE, _SAME_SPEED, _MOST_SPEEDS = 1e-4, 1e-11, 30
"""Of the speed of a motor that drives a belt with teeth, relative, and how often it is changed at most."""
_MOTOR_SPEEDS = 201
"""Speeds from standstill on at which the largest torque of a motor is looked for."""
_MOST_PRESSES = 20
"""Of rollers of nips that are loaded by forces."""
_STALLED = 0.5
"""Slip of a pulley that has stalled, beyond elastic creep: `slip_through` has 0.9, usable drives a few percent."""
_USED_UP = 0.9
"""Part of its friction that a pulley uses which has stalled: nearly 1 with laws as steep as creep needs."""
_SLIDES = 0.05
"""Difference of a prescribed speed of a rim from that of the belt, relative, from which the belt slides on it: friction
grows there with the loads, in place of the difference, which would be passed in a thousandth of the way."""
_LOST = 0.2
"""Slip of a pulley, beside elastic creep, behind which a curve is not followed any more."""
_BEFORE = 2
"""Solutions before the last one from which a curve is followed, where it is not from that."""
_GENTLE = 0.3
"""Slip velocity at which friction is fully used at first, over the belt's speed, at least."""


class SteadySearch:
    """A drive on a staying mesh on its way to steady running; its state is changed in place.

    `tolerance` is that of the last step of a search, over the smallest radius; `is_limited` tells whether what ended it
    is a limit of the drive.
    """

    def __init__(self, prepared: Prepared, system: System, state: State, time: float) -> None:
        self.prepared, self._time = prepared, time
        self.state, self.iterations, self.setting = state, 0, Setting()
        self.tolerance, self.is_limited = TOLERANCE, has_teeth(system)
        self._passed = list[Passed]()
        self._loading: Way | None = None
        self._held: int | None = None
        self._motor: int | None = None
        self._supported: int | None = None
        self._held_speed = self._support = 0.0
        self._moments = np.zeros(system.pulleys.size)
        self._shifts_at_rest = shifts_of(system.frame).copy()
        own = system._replace(rims=on_lengths(system.rims, system.length))
        self.constant, self._tensioners = with_own_rollers(constant_drive(own, time)), system.tensioners
        self._wanted = self.constant.profiles.segment.offset.copy()
        self._uniform, self._tension = self._wanted[: system.pulleys.size], 0.0
        self._prescribed = self.constant.bodies.unknown[self.constant.pulleys.shaft] < 0
        self._has_clutches = not np.all(rigid_links(self.constant))
        self._controls = self.constant.shaft_loads.table["state"][:-1] >= 0
        self._errors = np.zeros(self._controls.size)
        self._hold(None)

    def _hold(self, pulley: int | None) -> None:
        """Hold the shaft of a pulley at a speed, or none beyond those that are prescribed."""
        self._held = pulley
        self.system = led_by(
            with_speeds_unknown(self.constant, () if pulley is None else (pulley,)), self._leader(pulley)
        )
        self.work, self._sign = steady_work(self.system), 0

    def _leader(self, held: int | None) -> int:
        """The pulley whose known speed gives that of a belt with teeth, -1 without one."""
        known = [held] if held is not None else np.flatnonzero(self._prescribed).tolist()
        return next((p for p in known if self.prepared.toothed[p]), -1)

    def running(self) -> State:
        """The state that was found last, with the twists of hub chains."""
        place = self.state.position.copy()
        rims = slice(self.constant.first_body, place.size - self.constant.tensioners.size)
        place[rims] = twists(self.constant, self._moments, self.state)
        return State(place, self.state.velocity, np.zeros_like(place))

    @property
    def drive(self) -> Drive:
        """The drive, with the length, or the take-up, that gives the tension asked for."""
        return self.prepared.drive

    @property
    def belt_parameter(self) -> float:
        """Length of unstretched belt that passes in a second, m/s."""
        return float(self.constant.frame.speed[0])

    def unknowns(self) -> FloatArray:
        """All that steady running consists of: position, velocity, speed of the belt, phases, shifts, content."""
        own, here, frame = self.constant, self.state, self.constant.frame
        return np.concatenate([here.position, here.velocity, frame.speed, phases(own), shifts_of(frame), content(own)])

    def place(self, unknowns: FloatArray) -> None:
        """Put the search in its place."""
        size = self.state.position.size
        self.state.position[:], self.state.velocity[:] = unknowns[:size], unknowns[size : 2 * size]
        self.constant.frame.speed[:] = unknowns[2 * size : 2 * size + 1]
        others, own = unknowns[2 * size + 1 :], self.constant
        grooves, shifts = phases(own), shifts_of(own.frame)
        grooves[:], shifts[:] = others[: grooves.size], others[grooves.size :][: shifts.size]
        if content(own).size:
            set_content(own.carriage, own, float(unknowns[-1]))
        fitted(own, self.state.position)

    def resume(self, tangent: SteadyWork | None = None) -> bool:
        """Find steady running under the required loads from that under others; False if that fails."""
        if has_teeth(self.constant) and not np.any(self._prescribed):
            return self._resume_with_motor()
        if tangent is not None:
            self.work = tangent
        self._require_stability(tangent)
        found = (tangent is not None and self._try(Setting(), factorised=True)) or self._try(Setting())
        found = found and self._press()
        if found:
            self._keep_content()
        return found

    def _resume_with_motor(self) -> bool:
        """Find steady running of a belt with teeth whose driver has a motor, near its present speed."""
        driver = self.prepared.drive.driver
        if driver is None:
            return False
        self._held_speed, self._motor = self._speed_of(driver), driver
        self._hold(driver)
        self._require_stability()
        return self._try(Setting()) and self._balance(driver)

    def _speed_of(self, pulley: int) -> float:
        """Speed of the shaft of a pulley, rad/s."""
        return float(self.state.velocity[self.system.first_body + self.system.pulleys.shaft[pulley]])

    def factorised(self) -> SteadyWork:
        """The factorized tangent at the state, for small changes of the drive."""
        system = self.at(self.setting)
        drive_shafts(system, self.state.velocity)
        mesh_speeds(system, self.state.velocity)
        anchor = anchor_at(self.state, False)
        find_steady(system, self.state.at(0.0), anchor, 0.0, 0, False, self.work)
        return self.work

    def run(self, rest: Standing) -> None:
        """Find steady running under the required loads."""
        try:
            speed, driver = operating_point(self.constant, self.prepared.path.radii, self._prescribed)
        except ModelError as error:
            raise _without_machine(self.prepared.drive) or error from None
        if driver is not None:
            self._held_speed = speed / float(self.prepared.path.radii[driver])
            self._hold(driver)
        self._uniform, self._tension = speed / self.prepared.path.radii, rest.tension
        self._errors = self._errors_at(rest.place)
        if not self._run_up(rest.place, speed, self._gentle(speed, rest.tension)):
            raise self._refusal()
        if driver is not None:
            self._release(driver)
        if not self._press() or self._stalls():
            raise self._refusal()
        self._keep_content()

    def _stalls(self) -> bool:
        """Whether a pulley that ran with the belt without loads has come to a standstill, or nearly so, under them.

        With nearly all of its friction: a flat friction law needs large slip for little of it, and tells so itself.
        A web may stand still, held by a roller of speed zero, while others slide below it.
        """
        rims = self.state.velocity[self.system.first_body :][: self._uniform.size]
        slow, is_web = np.abs(rims) < (1.0 - _STALLED) * np.abs(self._uniform), self.prepared.drive.is_web
        if is_web:
            stalls = np.all(self.belt_parameter < (1.0 - _STALLED) * np.abs(self._driving_rims()))
            stalls &= self._driving_rims().size > 0
        else:
            stalls = np.any(slow & (self._here().used > _USED_UP))
        if self._loading is None or not stalls:
            return False
        if not self._passed:
            here, setting = self.unknowns(), self.setting
            self._passed = [self._seen(self._loading, solution) for solution in self._loading.solutions]
            self.place(here)
            self.setting = setting
        return is_web or self._largest_slip() > _STALLED

    def _largest_slip(self) -> float:
        """Largest slip of a pulley beyond elastic creep, against the first of the solutions that were passed."""
        return float(np.max(gross_slips([*self._passed[:1], self._here()])))

    def _keep_content(self) -> None:
        """Take the content of a web line that was found for the length of its belt."""
        found = content(self.constant)
        if found.size and found[0] != 1.0:
            self.prepared = self.prepared.with_length(float(np.sum(self.constant.length)))
            self.constant = rebased(self.constant)
            self._hold(self._held)

    def _press(self) -> bool:
        """Move the rollers of nips until they press with their forces; False if that fails."""
        loads = nip_loads(self.prepared)
        for _ in range(_MOST_PRESSES):
            moved = pressed_on(self.constant, loads, self.work.equations.forces.hub, float(np.min(self.prepared.radii)))
            if not moved:
                return True
            if not self._try(self.setting):
                return False
        return not loads

    def _run_up(self, place: FloatArray, speed: float, gentle: float) -> bool:
        """Continue from rest to the required speeds and loads; if that ends without a limit, on other ways.

        Where the belt bends over an idler of small wrap, its curvature nowhere settles, and hysteresis that turns its
        sign there leaves Newton's method no way from a belt at rest.
        """
        passed = list[Passed]()
        for bending_loss, (load, smoothing) in product(
            (1.0, 0.0) if loses_in_bending(self.system) else (1.0,), _FIRST_SETTINGS
        ):
            first = Setting(load=load, smoothing=smoothing, bending_loss=bending_loss)
            starts = first, first._replace(smoothing=gentle), first._replace(smoothing=gentle, speed=_SLOW)
            if not any(self._start(place, speed, start) and self._reach(first) for start in starts):
                continue
            self._passed = []
            if self._reach(first._replace(load=1.0)) and self._reach(Setting()):
                return True
            passed = max(passed, self._passed, key=_largest_load)
            if self._passed and not has_teeth(self.constant) and self._limit().is_limit:
                break
        self._passed = passed
        return False

    def _limit(self) -> Refusal:
        """What ends the increase of the loads."""
        return slip_limit(self.prepared, self.constant, self.at(Setting()), self._passed)

    def _refusal(self) -> ConvergenceError:
        """Say why there is no steady running."""
        if has_teeth(self.constant):
            return ConvergenceError(f"no steady running found at t = {self._time:g} s: {self._jump()}")
        found = self._limit()
        self.is_limited = found.is_limit
        return ConvergenceError(f"no steady running found at t = {self._time:g} s: {found.reason}")

    def _jump(self) -> str:
        """Say which pulley is the first to lose a belt with teeth: that with the largest pull over an arc."""
        here = self._here()
        worst = int(np.argmax(np.where(self.prepared.toothed, np.abs(here.torques) / self.prepared.radii, 0.0)))
        takes = f"`{self.prepared.pulleys[worst].name}` takes {abs(float(here.torques[worst])):.4g} N m"
        ends = f"the search ends at {here.setting.load:.1%} of the loads, where"
        remedy = "The belt jumps beyond that. Raise its tension, reduce the loads, or use a wider belt."
        if not np.isfinite(here.tensions).all():  # a belt off its pulleys has no spans
            return f"{ends} {takes}. {remedy}"
        reason = slack(self.prepared, Tensions.of(self.prepared, [here])) or takes
        return f"{ends} {reason} and spans have {here.tensions.min():.4g} to {here.tensions.max():.4g} N. {remedy}"

    def _here(self) -> Passed:
        return Passed.at(self.setting, self.prepared, self.at(self.setting), self.state)

    def move_to(self, lengths: FloatArray) -> None:
        """Go on to another mesh of the same drive, with elements of lengths (m).

        A small element has little between damping in proportion to the rate of its stretch and full hysteresis, and the
        rate of a transferred curve is far off there. So damping comes first.
        """
        other = on_other_mesh(self.prepared, self.constant, lengths)
        self.state, self.constant = transfer(self.constant, self.state, other), other
        self._hold(self._held)
        target = self.setting
        soft = target._replace(stretch_length=_SOFT if other.hysteresis.size else 1.0)
        softer = soft._replace(bending_loss=0.0), *(soft._replace(bending_loss=0.0, smoothing=s) for s in _SMOOTHINGS)
        if not any(self._try(first) and self._reaches(target) for first in (soft, *softer)):
            raise ConvergenceError(
                f"steady running was found with fewer elements, but not with the {other.nodes} required by "
                "force_tolerance. Increase force_tolerance."
            )
        if self._motor is not None and not self._balance(self._motor):
            raise self._refusal()
        if not self._press():
            raise self._refusal()
        self._keep_content()

    def friction_band(self, known: Mapping[str, FloatArray] | None = None) -> dict[str, FloatArray]:
        """Ends of the bands in which dry friction may hold tensioners, m or rad; empty without friction.

        "tensioner_position_after_tensioning" and "tensioner_position_after_yielding" have shape (K,): the path had
        become longer before, or shorter. Where the belt slips on the way, or the tensioner loses its balance, the end
        is there, and "friction_used_after_..." the part of dry friction that held it. "tensioner_factor_after_..." are
        ways to other ends over those by the tangent; with such of a neighbor in `known`, the ends follow from these.
        """
        found, count = dict[str, FloatArray](), self.constant.tensioners.size
        tensioners = slice(self.state.position.size - count, self.state.position.size)
        here, ends = self.state.position[tensioners].copy(), list[tuple[FloatArray, FloatArray]]()
        given = {
            name: sense * dry_friction_of(self._tensioners, f"{name}_friction")
            for name, sense in (("tensioning", -1.0), ("yielding", 1.0))
        }
        pushes = {name: push for name, push in given.items() if np.any(push)}
        ways = self._pushed_by_tangent(pushes.values()) if pushes else []
        for (name, push), way in zip(pushes.items(), ways, strict=True):
            mark = f"tensioner_factor_after_{name}"
            factor = None if known is None or mark not in known else np.atleast_1d(known[mark])
            if factor is None:
                end = self._pushed(push, way, ends)
                position = end.unknowns[tensioners]
                found[f"tensioner_position_after_{name}"] = position
                if end.place < 1.0:
                    found[f"{FRICTION_USED}{name}"] = np.array(end.place)
                    continue
                ends.append((push, end.unknowns))
                factor = np.divide(position - here, way[tensioners], out=np.ones(count), where=way[tensioners] != 0.0)
            found |= {f"tensioner_position_after_{name}": here + factor * way[tensioners], mark: factor}
        return found

    def _pushed(self, push: FloatArray, way: FloatArray, ends: Sequence[tuple[FloatArray, FloatArray]]) -> Solution:
        """Unknowns where tensioners are pushed, N or N m, or by the largest part of it without gross slip.

        The way there to first order, and ends that are known, each with its push, serve the guesses.
        """
        begin, moments, own = self.unknowns(), self._moments, self.constant.tensioners.push
        given = own.copy()
        reached, first = Solution(0.0, begin), self._here()

        def solve(part: float, guess: FloatArray) -> FloatArray | None:
            nonlocal reached
            own[:] = given + part * push
            found = self.solve(self.setting, guess, part)
            if found is None or np.max(gross_slips([first, self._here()])) > GROSS:
                return None
            reached = Solution(part, found)
            return found

        parts = [(float(other @ push) / float(push @ push), other, end) for other, end in ends]
        known = [Solution(part, end) for part, other, end in parts if np.allclose(other, part * push)]
        nearest = Solution(_NEAR, begin + _NEAR * way)
        follow(solve, *known, reached, nearest, step=0.5)
        own[:], self._moments = given, moments
        self.place(begin)
        return reached

    def _pushed_by_tangent(self, pushes: Iterable[FloatArray]) -> list[FloatArray]:
        """By how much unknowns change where tensioners are pushed, N or N m, to first order."""
        matrix, found, here = self.factorised().equations.matrix, list[FloatArray](), self.unknowns()
        unknown = self.system.bodies.unknown[-self.system.tensioners.size :]
        for push in pushes:
            clear(matrix, False)
            matrix.border_side[unknown] = push
            substitute(matrix, True, self.work.ahead_node, self.work.ahead_border)
            make_step(self.system, self.state.at(0.0), False, 1.0, self.work.ahead_node, self.work.ahead_border)
            found.append(self.unknowns() - here)
            self.place(here)
        return found

    def solve(self, setting: Setting, guess: FloatArray, part: float) -> FloatArray | None:
        """Steady running at a part of a way, from a guess; None, and all as it was, if it is not found."""
        before = self.unknowns()
        self.place(guess)
        if self._try(setting, self.tolerance if part == 1.0 else _ON_THE_WAY):
            return self.unknowns()
        self.place(before)
        return None

    def _gentle(self, speed: float, tension: float) -> float:
        """Smoothing with which friction is not fully used anywhere."""
        pulleys = self.system.pulleys
        limits = self.system.law.friction.saturation(tension / self.prepared.radii, pulleys.friction, speed)
        least = float(np.min(limits[pulleys.friction > 0.0], initial=np.inf))
        return max(1.0, _GENTLE * abs(speed) / least)

    def _start(self, place: FloatArray, speed: float, setting: Setting) -> bool:
        """Begin at a setting, from a place at rest, with a belt of a speed (m/s) that sticks to all pulleys."""
        state, running, path = self.state, setting.speed * speed, self.prepared.path
        self._sign = 0
        state.position[:] = place
        shifts_of(self.constant.frame)[:] = self._shifts_at_rest
        self.constant.frame.speed[0] = running * self.prepared.belt_length / path.length
        state.velocity[self.system.first_body :][: path.count] = running / path.radii
        guess_hubs(self.at(setting), state.velocity)
        fit_phases(self.system, state)
        return self._try(setting)

    def _reach(self, target: Setting) -> bool:
        """Go on to another setting, around limit points; False if the way ends before.

        The tangent serves where loads grow; what smooths changes by factors, and teeth meet their flanks.
        """
        if self.setting == target:
            return True
        way = Way(self, self.setting, target)
        if target.load > self.setting.load:
            self._loading = way
        tangent = way.tangent if target.load != self.setting.load and not has_teeth(self.constant) else None
        if follow(way.solve, *way.solutions, tangent=tangent) is not None:
            return True
        if has_teeth(self.constant) or self.setting.smoothing != 1.0 or target.smoothing != 1.0:
            return False
        return self._turn(way)

    def _reaches(self, target: Setting) -> bool:
        """Whether a setting is found on the way that smooths least; its curve is not followed where it turns."""
        way = Way(self, self.setting, target)
        return self.setting == target or (
            follow(way.solve, *way.solutions, shortest=_SHORTEST, tangent=way.tangent) is not None
        )

    def _turn(self, way: Way) -> bool:
        """Follow the curve around limit points, from the last solution without gross slip; False if it ends before 1.

        Solutions are kept to tell what ends the way.
        """
        begin, here = self.setting, self.unknowns()
        passed = [self._seen(way, solution) for solution in way.solutions]
        sliding = np.max(gross_slips(passed), axis=1) > GROSS
        count = int(np.argmax(sliding)) if sliding.any() else len(passed)
        # at a sharp corner, where all friction is used, no direction is known: the curve is followed from before it
        starts = [(count, self._is_lost), (max(count - _BEFORE, 1), self._is_lost)]
        if count < len(passed):
            starts.insert(1, (len(passed), lambda: False))
        for start, is_lost in starts:
            self._seen(way, way.solutions[start - 1])
            place, allowed = way.solutions[start - 1].place, _ON_THE_WAY * float(np.min(self.prepared.radii))
            turned = turn(way, place, allowed, is_lost)
            if turned[-1].place >= 1.0 and way.solve(1.0, extrapolated(turned[-2:], 1.0)) is not None:
                return True
            if start == count:
                self._passed = passed[:count] + [self._seen(way, solution) for solution in turned[1:]]
        self.setting = begin
        self.place(here)
        return False

    def _seen(self, way: Way, solution: Solution) -> Passed:
        """A solution on a way, in which the search is put."""
        self.place(solution.unknowns)
        self.setting = way.at(solution.place)
        return self._here()

    def _is_lost(self) -> bool:
        """Whether a pulley slides so fast that a curve need not be followed any more."""
        return self._largest_slip() > _LOST

    def _release(self, driver: int) -> None:
        """Let a driver turn as its torque says."""
        if has_teeth(self.constant):
            self._motor = driver
            if not self._balance(driver):
                raise self._refusal()
            return
        speed = float(self.state.velocity[self.system.first_body + self.system.pulleys.shaft[driver]])
        reaction = float(self.work.equations.forces.shaft[driver])
        self._hold(None)
        own = own_torque(self.at(Setting()), self.state, driver, speed)
        self._supported, self._support, self.setting = driver, reaction - own, Setting(support=1.0)
        speeds = self.state.velocity[self.system.first_body :][self.system.pulleys.shaft].copy()
        if not self._reach(Setting()):
            raise self._weak_motor(speeds, driver, reaction) or self._refusal()

    def _weak_motor(self, speeds: FloatArray, driver: int, required: float) -> ConvergenceError | None:
        """Machines that at no speed of the belt give what it takes; None if they do.

        At the speeds of shafts (rad/s) the held one requires a torque (N m). Torques count by their powers.
        """
        free, parts = self.at(Setting()), np.linspace(0.0, 1.0, _MOTOR_SPEEDS)
        torques = np.array(
            [
                [own_torque(free, self.state, p, part * speed) for p, speed in enumerate(speeds.tolist())]
                for part in parts.tolist()
            ]
        )
        powers = torques * speeds
        best, others = int(powers.sum(axis=1).argmax()), np.arange(speeds.size) != driver
        missing = required * float(speeds[driver]) + float(powers[-1, others].sum() - powers[best].sum())
        motor = int(powers[best].argmax())
        if not (missing > 0.0 and powers[best, motor] > 0.0):
            return None
        self.is_limited = True
        most, speed = abs(float(torques[best, motor])), abs(float(speeds[motor]))
        return ConvergenceError(
            f"no steady running found at t = {self._time:g} s: the machine of "
            f"`{self.prepared.pulleys[motor].name}`, less other loads of its shaft, gives at most {most:.4g} N m (at "
            f"{RPM * parts[best] * speed:.4g} rpm) of the {most + missing / speed:.4g} N m required. Use a larger "
            "motor, or reduce the load."
        )

    def _balance(self, driver: int) -> bool:
        """Find the speed at which a motor drives a belt with teeth, by the secant method; False if that fails."""

        def lacking() -> float:
            self._held = None  # the profile of a held pulley is its speed, in place of its torque
            free, self._held = self.at(Setting()), driver
            own = own_torque(free, self.state, driver, self._speed_of(driver))
            return float(self.work.equations.forces.shaft[driver]) - own

        speed, missing = self._held_speed, lacking()
        self._held_speed = (1.0 - _FIRST_CHANGE) * speed
        for _ in range(_MOST_SPEEDS):
            if not self._try(Setting()):
                return False
            still = lacking()
            change = still * (self._held_speed - speed) / (still - missing) if still != missing else 0.0
            if abs(change) <= _SAME_SPEED * abs(self._held_speed):
                return True
            speed, missing = self._held_speed, still
            self._held_speed -= change
        return False

    def _try(self, setting: Setting, tolerance: float | None = None, *, factorised: bool = False) -> bool:
        """Look for steady running at a setting from the state that there is, which stays where that fails.

        The first corrections are by the tangent that is factorized already, if it is.  The tolerance is that of the
        search by default.  Behind a clutch that begins to slip, speeds jump from those of the rim to near standstill:
        where Newton's method fails, it starts anew with those that balance their loads.
        """
        before, system = self.unknowns(), self.at(setting)
        allowed = (self.tolerance if tolerance is None else tolerance) * float(np.min(self.prepared.radii))
        found = self._converges(system, allowed, factorised)
        if not found and self._has_clutches:
            self.place(before)
            speed = self.belt_parameter
            found = self._lets_slip(system) and self._converges(system, allowed, False)
            found = found and abs(self.belt_parameter - speed) <= _SLIDES * abs(speed)
        if found:
            fitted(self.constant, self.state.position)
            self.setting, self._moments = setting, self.work.equations.forces.moment.copy()
            return True
        self.place(before)
        return False

    def _lets_slip(self, system: System) -> bool:
        """Let hub bodies turn as their loads say; whether one begins to slip, or ends."""
        velocity = self.state.velocity[self.system.first_body :]
        before = velocity.copy()
        guess_hubs(system, self.state.velocity)
        return bool(np.any(np.abs(velocity - before) > _SLIDES * np.abs(before).max()))

    def _converges(self, system: System, allowed: float, factorised: bool) -> bool:
        """Whether Newton's method leads from the state to steady running, up to an error of nodes, m."""
        state = self.state
        drive_shafts(system, state.velocity)
        mesh_speeds(system, state.velocity)
        anchor = anchor_at(state, False)
        status, iterations = find_steady(
            system, state.at(0.0), anchor, allowed, _MAX_NEWTON_STEPS, factorised, self.work
        )
        self.iterations += iterations
        if status != FOUND or self._runs_away():
            return False
        if not has_teeth(self.constant):
            return True
        find_steady(system, state.at(0.0), anchor, 0.0, 0, False, self.work)
        sign = determinant_sign(self.work.equations.matrix, True)
        self._sign = self._sign or sign
        return sign == self._sign

    def _require_stability(self, tangent: SteadyWork | None = None) -> None:
        """Let a belt with teeth be found only where it is as stable as now; the tangent here may be known.

        Beyond a jump there are states without stability: a real eigenvalue has passed zero, so that the determinant of
        the tangent has another sign.
        """
        if has_teeth(self.constant):
            self._sign = determinant_sign((tangent or self.factorised()).equations.matrix, True)

    def _runs_away(self) -> bool:
        """Whether a web runs backwards, or faster than all rims that drive it, lifted off by its own inertia."""
        rims = self._driving_rims()
        if not self.prepared.drive.is_web or not rims.size:
            return False
        ratio = self.belt_parameter / float(rims[np.argmax(np.abs(rims))])
        return not 0.0 < ratio < 1.0 + _SLIDES

    def _driving_rims(self) -> FloatArray:
        """Speeds of the rims with a prescribed one that is not zero, m/s."""
        rims = (self._wanted[: self._prescribed.size] * self.prepared.path.radii)[self._prescribed]
        return np.asarray(rims[rims != 0.0])

    def at(self, setting: Setting) -> System:
        """The system at a setting."""
        system, segment = self.system, self.system.profiles.segment.copy()
        offset, count, driven = segment.offset, system.pulleys.size, self._prescribed.copy()
        offset[:] = self._wanted
        away = self._uniform - offset[:count]
        sliding = driven & (np.abs(away) > _SLIDES * np.abs(self._uniform))
        pulleys = system.pulleys.copy()
        pulleys["friction"][sliding] *= setting.load
        offset[:count] += np.where(driven & ~sliding, (1.0 - setting.load) * away, 0.0)
        if self._held is not None:
            driven[self._held], offset[self._held] = True, self._held_speed
        offset[:count] *= np.where(driven, setting.speed, setting.load)
        offset[system.shaft_loads.table.schedule[:-1]] *= np.where(self._controls, 1.0, setting.load)
        if self._supported is not None:
            offset[self._supported] += setting.support * self._support
        friction, hysteresis = system.law.friction.smoothed(setting.smoothing), system.hysteresis.copy()
        hysteresis["stretch_length"] *= setting.stretch_length
        system = system._replace(
            pulleys=pulleys,
            law=system.law._replace(friction=friction),
            hysteresis=hysteresis,
            profiles=system.profiles._replace(segment=segment),
            carrying=with_resistance(system.carrying, setting.load),
            carriage=with_part_of_tensions(system.carriage, self._tension, setting.load),
            shaft_loads=self._with_set_values(system.shaft_loads, setting.load),
        )
        return system if setting.bending_loss == 1.0 else with_bending_loss(system, setting.bending_loss)

    def _errors_at(self, place: FloatArray) -> FloatArray:
        """Errors that integrating controllers see in a place at rest, m or N; shape (L,)."""
        table = self.constant.shaft_loads.table
        errors = [row.sensor_rate * place[-row.sensor] + row.sensor_zero if row.sensor else 0.0 for row in table[:-1]]
        return np.where(self._controls, errors, 0.0)

    def _with_set_values(self, loads: ShaftLoads, load: float) -> ShaftLoads:
        """Controllers with a part of the way from what they see at rest to their set values.

        An integrating controller holds its set value with any torque: without torque there is no such state.
        """
        if load == 1.0 or not np.any(self._errors):
            return loads
        table = loads.table.copy()
        table["sensor_zero"][:-1] -= (1.0 - load) * self._errors
        return loads._replace(table=table)


def _largest_load(passed: Sequence[Passed]) -> float:
    """Largest part of the loads in solutions; -1 without any."""
    return max((one.setting.load for one in passed), default=-1.0)


def _without_machine(drive: Drive) -> ModelError | None:
    """That nothing drives a belt; None where something is meant to."""
    if drive.driver is not None:
        return None
    names = listing([f'"{one.name}"' for one in drive.pulleys])
    return ModelError(
        f"no machine drives the belt: {names} have neither a speed nor a motor, and their torques and loads balance at "
        'no speed. Give the pulley of the machine speed = "1500 rpm", or a motor as its load.'
    )
