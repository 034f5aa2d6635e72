"""The links of a hub chain, the couplings between the rim of a pulley and the bodies behind it."""

from beltdyn.machines.links.clutches import FrictionClutch as FrictionClutch
from beltdyn.machines.links.clutches import OneWayClutch as OneWayClutch
from beltdyn.machines.links.isolator import Isolator as Isolator
