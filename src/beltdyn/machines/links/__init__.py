"""The links of a hub chain, the couplings between the rim of a pulley and the bodies behind it."""

from collections.abc import Sequence
from typing import Annotated, NamedTuple

import numpy as np

from beltdyn.arrays import Records, records
from beltdyn.kernel import KindRows, choice, kernel
from beltdyn.machines.links.couplings import FrictionClutch as FrictionClutch
from beltdyn.machines.links.couplings import Isolator as Isolator
from beltdyn.machines.links.couplings import OneWayClutch as OneWayClutch
from beltdyn.machines.links.link import LINKS, HubLink, LinkTorque
from beltdyn.machines.profiles.functions import Profiles, schedule_value
from beltdyn.parts.kind_fields import OneOf

AnyHubLink = Annotated[HubLink, OneOf(LINKS)]

LINK_ROWS = KindRows(
    LINKS,
    lambda kind: kind.constants,
    front="i8",  # body on the belt's side: 0 to P - 1 are the rims, then come the hub bodies
    back="i8",  # body behind it
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
)
"""Rows of links of hub chains, with the constants of their kinds; those of others are zero."""
LINK = LINK_ROWS.row_type()
"""The row of a link of the package."""

torque_of_kind = choice("torque_of_kind", LINKS.functions("torque_at"), ["scale", "twist", "rate"])


class PlacedLink(NamedTuple):
    """A link between two bodies."""

    link: HubLink
    front: int
    back: int
    turning: int
    """Turning sense of the pulley by an advancing belt: 1 counter-clockwise, -1 clockwise."""
    schedule: int
    """Number of the profile of its schedule, or `NO_SCHEDULE`."""


def link_rows(placed: Sequence[PlacedLink]) -> Records:
    """Rows of `LINK` of some links."""
    table = records(LINK_ROWS.row_type(type(one.link) for one in placed), front=[one.front for one in placed])
    for row, one in zip(table, placed, strict=True):
        row.back, row.schedule = one.back, one.schedule
        LINK_ROWS.fill(row, type(one.link), one.link.values(one.turning))
    return table


@kernel
def link_torque(profiles: Profiles, link: np.record, time: float, twist: float, rate: float) -> LinkTorque:
    """Torque of a link.

    Parameters
    ----------
    profiles, link
        Functions of time, and a row of `LINK`.
    time
        s.
    twist, rate
        Angle of the front body less that of the back one, and its rate, rad and rad/s.
    """
    result: LinkTorque = torque_of_kind(link, schedule_value(profiles, link.schedule, time), twist, rate)
    return result
