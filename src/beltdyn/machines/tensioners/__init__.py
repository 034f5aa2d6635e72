"""Tensioners, which press a pulley against the belt."""

from beltdyn.machines.tensioners.rotary import RotaryTensioner as RotaryTensioner
from beltdyn.machines.tensioners.sliding import SlidingTensioner as SlidingTensioner
from beltdyn.machines.tensioners.tensioner import FixedTensioner as FixedTensioner
