"""What a unit of FMI 3.0 begins with: it is copied into the unit, and imports beltdyn from the Python of the host."""

from pythonfmu3 import Float64, Fmi3Causality, Fmi3Initial, Fmi3Slave, Fmi3Status, Fmi3StepResult, Fmi3Variability

from beltdyn.cosimulation.slave import DriveSlave, Standard


class BeltDrive(DriveSlave, Fmi3Slave):  # type: ignore[misc]
    """A drive behind FMI 3.0."""

    standard = Standard(Float64, Fmi3Causality, Fmi3Initial, Fmi3Variability)

    def do_step(self, current_time: float, step_size: float) -> Fmi3StepResult:
        """Simulate a step, and tell its status."""
        succeeded = self.advance(current_time, step_size)
        return Fmi3StepResult(status=Fmi3Status.ok if succeeded else Fmi3Status.error)
