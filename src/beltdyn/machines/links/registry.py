"""Links of any kind: their field type, their rows, and the kernel that evaluates them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.kernel import choice, kernel
from beltdyn.machines import links as kinds
from beltdyn.machines.family import any_of, constants_of, kinds_in
from beltdyn.machines.links.link import HubLink, LinkTorque
from beltdyn.machines.profiles.functions import Profiles, schedule_value
from beltdyn.records import Records, fill, record, records

KINDS = kinds_in(kinds)

if TYPE_CHECKING:
    AnyHubLink = HubLink
else:
    AnyHubLink = any_of(KINDS)

LINK = record(
    front="i8",  # body on the belt's side: 0 to P - 1 are the rims, then come the hub bodies
    back="i8",  # body behind it
    schedule="i8",  # number of the profile that multiplies it, or `NO_SCHEDULE`
    kind="i8",  # place among `KINDS`
    **constants_of(KINDS),
)
"""A link of a hub chain, with the constants of its kind; those of the others are zero."""

torque_of_kind = choice("torque_of_kind", {k: v.torque_at for k, v in KINDS.items()}, ["scale", "twist", "rate"])


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
    table, names = records(LINK, front=[one.front for one in placed]), list(KINDS)
    for row, one in zip(table, placed, strict=True):
        row.back, row.schedule, row.kind = one.back, one.schedule, names.index(one.link.kind)
        fill(row[one.link.kind], one.link.values(one.turning))
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
