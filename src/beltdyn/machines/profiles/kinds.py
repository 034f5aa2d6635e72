"""All kinds of profiles, one a line."""

from beltdyn.machines.profiles.constant import Constant as Constant
from beltdyn.machines.profiles.cosine_ramp import CosineRamp as CosineRamp
from beltdyn.machines.profiles.cosine_ramp_published import CosineRampPublished as CosineRampPublished
from beltdyn.machines.profiles.ramp import Ramp as Ramp
from beltdyn.machines.profiles.step import Step as Step
from beltdyn.machines.profiles.table import Table as Table
