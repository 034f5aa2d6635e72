"""Stretch laws, tension over stretch, one per file; importing one here registers it."""

from collections import ChainMap

from beltdyn.kernel import by_type
from beltdyn.stretch.common import CommonStretch as CommonStretch
from beltdyn.stretch.common import as_common as as_common
from beltdyn.stretch.common import common_stretch
from beltdyn.stretch.law import LAWS as LAWS
from beltdyn.stretch.law import Stretching as Stretching
from beltdyn.stretch.law import StretchLaw as StretchLaw
from beltdyn.stretch.law import StretchParameters as StretchParameters
from beltdyn.stretch.laws import Green as Green
from beltdyn.stretch.laws import Linear as Linear
from beltdyn.stretch.laws import Measured as Measured
from beltdyn.stretch.laws import through as through

stretching = by_type(ChainMap(LAWS.by_class("stretching"), {CommonStretch: common_stretch}), "stretching")
"""Strain energy of stretch per reference length and its derivatives in G = q . q; see `StretchLaw.stretching`."""
