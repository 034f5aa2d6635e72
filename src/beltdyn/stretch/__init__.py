"""Stretch laws, tension over stretch, one per file; importing one here registers it."""

from beltdyn.kernel import by_type
from beltdyn.stretch.law import LAWS as LAWS
from beltdyn.stretch.law import Stretching as Stretching
from beltdyn.stretch.law import StretchLaw as StretchLaw
from beltdyn.stretch.law import StretchParameters as StretchParameters
from beltdyn.stretch.laws import Green as Green
from beltdyn.stretch.laws import Linear as Linear
from beltdyn.stretch.laws import Measured as Measured
from beltdyn.stretch.laws import through as through

stretching = by_type(LAWS.by_class("stretching"), "stretching")
"""Strain energy of stretch per reference length and its derivatives in G = q . q; see `StretchLaw.stretching`."""
