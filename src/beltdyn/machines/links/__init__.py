"""The links of a hub chain, the couplings between the rim of a pulley and the bodies behind it."""

from beltdyn.machines.links.couplings import FrictionClutch as FrictionClutch
from beltdyn.machines.links.couplings import Isolator as Isolator
from beltdyn.machines.links.couplings import OneWayClutch as OneWayClutch
