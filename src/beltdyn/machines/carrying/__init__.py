"""What carries a belt between its pulleys, and the goods that it carries."""

from beltdyn.machines.carrying.goods import Goods as Goods
from beltdyn.machines.carrying.support import Guide as Guide
from beltdyn.machines.carrying.support import Idlers as Idlers
