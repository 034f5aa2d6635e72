"""What the loads of a drive demand of its belt: powers, pulls, and the tension at rest by the rules of makers."""

from beltdyn.arrays import FloatArray
from beltdyn.model.belt_loads import RequiredTension, torque_of_file
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation
from beltdyn.model.path import Path


def required_tension(drive: Drive, installation: Installation) -> RequiredTension | None:
    """The tension at rest that the loads require by the rules of makers; None where these do not apply.

    They apply to belts of a rated profile between fixed centers, with a driver and loads that are known. The design
    power is that at the highest speed of the driver times `limits.service_factor`.
    """
    held = bool(drive.moving_tensioners) or bool(drive.ends) or drive.carriage is not None
    if drive.driver is None or held:
        return None
    return drive.belt_loads(drive.driver).required_tension(installation.path)


def powers_drawn(drive: Drive, driver: int, path: Path) -> tuple[FloatArray, float]:
    """Power drawn from the belt by each pulley, W, and belt speed, m/s, at the highest speed of a driver."""
    return drive.belt_loads(driver).powers_drawn(path)


def prescribed_torque(drive: Drive, number: int) -> float:
    """Torque that the drive file gives a pulley beside its loads, at the end of the run, N m."""
    return torque_of_file(drive.pulleys[number], drive.simulation.end)
