"""Drives at other operating points: a speed in place of a motor, other loads, a prescribed speed of any pulley."""

from math import floor

from beltdyn.errors import ModelError
from beltdyn.machines import Constant, Goods
from beltdyn.machines.loads.load import Load
from beltdyn.model import Drive, Pulley, prepare
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import instant_given
from beltdyn.transient.sweep import without_schedules


def held_at(drive: Drive, at: float | str | None) -> Drive:
    """Hold speeds, torques and schedules as they are at an instant, with the belt's length or take-up found."""
    held = at_instant(drive, at)
    prepared = prepare(held)
    return held if prepared.installed_tension is None else bring_to_stand(prepared).drive


def at_instant(drive: Drive, at: float | str | None) -> Drive:
    """Hold speeds, torques and schedules as they are at an instant, as from `instant_given`."""
    return without_schedules(drive, instant_given(drive, at))[0]


def sense_of(drive: Drive, number: int) -> float:
    """Sense in which a pulley turns, 1 or -1: that of its prescribed speed, or else the positive one."""
    speed = drive.pulleys[number].speed
    return -1.0 if speed is not None and float(speed.at([0.0])[0]) < 0.0 else 1.0


def driver_of(drive: Drive) -> int:
    """Number of the pulley that drives: the first whose speed is prescribed, or else the first with a motor."""
    if drive.driver is None:
        raise ModelError(
            "nothing drives the belt: no pulley has a speed or a motor. Prescribe the speed of one in the drive file, "
            "or name it in the option pulley of analyses that have one, such as an operating map."
        )
    return drive.driver


def is_motor(load: Load) -> bool:
    """Whether a load drives its shaft."""
    return load.driven_speed != 0.0


def at_speed(drive: Drive, number: int, speed: float) -> Drive:
    """Prescribe the speed of a pulley, in place of its motor, torque and loads; a web line keeps its draws."""
    return drive.replace(pulley=turned(drive, list(drive.pulleys), number, speed))


def at_speed_under(drive: Drive, number: int, speed: float, factor: float) -> Drive:
    """Multiply all torques and loads, as `with_load`, and prescribe the speed of a pulley, as `at_speed`."""
    return drive.replace(pulley=turned(drive, under_load(drive, factor), number, speed), goods=_under(drive, factor))


def turned(drive: Drive, pulleys: list[Pulley], number: int, speed: float) -> list[Pulley]:
    """The pulleys with the speed of one; other prescribed speeds of a web line change in proportion."""
    given = drive.pulleys[number].speed
    before = 0.0 if given is None else float(given.at([0.0])[0])
    if drive.is_web and before != 0.0:
        for other, one in enumerate(pulleys):
            if one.speed is not None:
                pulleys[other] = turned_at(one, speed * float(one.speed.at([0.0])[0]) / before)
    pulleys[number] = turned_at(pulleys[number], speed)
    return pulleys


def require_belt(drive: Drive, analysis: str, instead: str) -> None:
    """Refuse a web line, for an analysis that is one of belts."""
    if drive.is_web:
        raise ModelError(f"{analysis} needs a closed belt, and this is a web line. Use {instead}.")


def under_torque(pulley: Pulley, torque: float) -> Pulley:
    """A pulley with a torque (N m) on its shaft, in place of its torque and loads, but for motors."""
    if pulley.prescribed:
        raise ModelError(
            f"{pulley.name} has a prescribed speed, so its torque cannot be given. Give the torque of another pulley."
        )
    return pulley.replace(torque=Constant(value=torque), load=tuple(load for load in pulley.load if is_motor(load)))


def under_power(drive: Drive, number: int, power: float, pulleys: list[Pulley]) -> Pulley:
    """A pulley whose shaft takes a power (W) at its speed without slip; pulleys are those of the drive, changed."""
    driver = driver_of(drive)
    speed = pulleys[driver].speed
    turning = 0.0 if speed is None else float(speed.at([0.0])[0]) * float(drive.path.radii[driver])
    if turning == 0.0:
        raise ModelError(
            f"the power of {pulleys[number].name} needs the speed of {pulleys[driver].name}. Give the speed, or a "
            "torque in place of the power."
        )
    return under_torque(pulleys[number], -power / (turning / float(drive.path.radii[number])))


def with_load(drive: Drive, factor: float) -> Drive:
    """Multiply all torques and loads, but for those of motors, and the goods on the belt.

    A load times 1.3 is the load and another one with the schedule 0.3, as schedules reach up to 1.
    """
    if factor == 1.0:
        return drive
    return drive.replace(pulley=under_load(drive, factor), goods=_under(drive, factor))


def with_pulley(drive: Drive, number: int, pulley: Pulley) -> Drive:
    """The drive with another pulley in the place of one."""
    return drive.replace(pulley=[*drive.pulleys[:number], pulley, *drive.pulleys[number + 1 :]])


def turned_at(pulley: Pulley, speed: float) -> Pulley:
    """A pulley with a prescribed speed, in place of its motor, torque and loads."""
    return pulley.replace(speed=Constant(value=speed), torque=None, load=(), harmonics=())


def under_load(drive: Drive, factor: float) -> list[Pulley]:
    """The pulleys with all torques and loads multiplied."""
    if factor == 1.0:
        return list(drive.pulleys)
    return [one.replace(torque=_scaled(one, factor), load=_multiplied(one.load, factor)) for one in drive.pulleys]


def _under(drive: Drive, factor: float) -> list[Goods]:
    """The goods with their mass multiplied."""
    return [one.replace(mass_per_length=factor * one.mass_per_length) for one in drive.goods if factor > 0.0]


def _scaled(pulley: Pulley, factor: float) -> Constant | None:
    return None if pulley.torque is None else Constant(value=factor * float(pulley.torque.at([0.0])[0]))


def _multiplied(loads: tuple[Load, ...], factor: float) -> tuple[Load, ...]:
    found = list[Load]()
    for load in loads:
        whole, part = (1, 0.0) if is_motor(load) else (floor(factor), factor - floor(factor))
        given = 1.0 if load.schedule is None else float(load.schedule.at([0.0])[0])
        found += [load] * whole + [load.replace(schedule=Constant(value=part * given))] * (part > 0.0)
    return tuple(found)
