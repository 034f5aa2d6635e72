"""What the loads of a drive demand of its belt: the tension at rest by the rules of makers."""

from beltdyn.model.axis_tension import axis_tension
from beltdyn.model.belt_loads import RequiredTension
from beltdyn.model.drive import Drive
from beltdyn.model.installation import Installation


def required_tension(drive: Drive, installation: Installation) -> RequiredTension | None:
    """The tension at rest that the loads require by the rules of makers; None where these do not apply.

    They apply to belts of a rated profile between fixed centers, with a driver and loads that are known. The design
    power is that at the highest speed of the driver times `limits.service_factor`. For a linear axis it is the tension
    that its moves require (`axis_tension`).
    """
    if drive.carriage is not None:
        return axis_tension(drive, installation.path, installation.tension)
    if drive.driver is None or drive.moving_tensioners or drive.ends:
        return None
    return drive.belt_loads(drive.driver).required_tension(installation.path)
