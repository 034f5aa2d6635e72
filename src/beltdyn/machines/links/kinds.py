"""All kinds of links, one a line."""

from beltdyn.machines.links.friction_clutch import FrictionClutch as FrictionClutch
from beltdyn.machines.links.isolator import Isolator as Isolator
from beltdyn.machines.links.one_way_clutch import OneWayClutch as OneWayClutch
