"""All kinds of tensioners, one a line."""

from beltdyn.machines.tensioners.fixed import FixedTensioner as FixedTensioner
from beltdyn.machines.tensioners.rotary import RotaryTensioner as RotaryTensioner
from beltdyn.machines.tensioners.sliding import SlidingTensioner as SlidingTensioner
