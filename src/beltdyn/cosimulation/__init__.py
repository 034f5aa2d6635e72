"""A drive as a component of other programs: functional mock-up units for co-simulation (FMI 2.0 and 3.0)."""

from beltdyn.cosimulation.archive import fmu

__all__ = ["fmu"]
