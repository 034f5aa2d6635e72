"""What a unit of FMI 2.0 begins with: it is copied into the unit, and imports beltdyn from the Python of the host."""

from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

from beltdyn.cosimulation.slave import DriveSlave, Standard


class BeltDrive(DriveSlave, Fmi2Slave):  # type: ignore[misc]
    """A drive behind FMI 2.0."""

    standard = Standard(Real, Fmi2Causality, Fmi2Initial, Fmi2Variability)

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        """Take the stop time, s, and the tolerance of the host, unless the parameter has another one already."""
        self.component.stop = stop_time
        if tolerance and self.component.tolerance == self.component.interface.tolerance:
            self.component.tolerance = tolerance

    def do_step(self, current_time: float, step_size: float) -> Any:
        """Simulate a step; the host discards it if it has failed."""
        return self.advance(current_time, step_size)
