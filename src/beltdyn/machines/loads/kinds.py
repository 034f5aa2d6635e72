"""All kinds of loads and motors, one a line."""

from beltdyn.machines.loads.motor import Motor as Motor
from beltdyn.machines.loads.resistance import Resistance as Resistance
from beltdyn.machines.loads.table import LoadTable as LoadTable
