"""A two-pulley drive in Exudyn (ANCFCable2D, ObjectContactFrictionCircleCable2D), with its settings tuned.

Constants of contact are per length here and per contact segment there.  Circles are made smaller by the sagitta of a
segment, the start is the frictionless equilibrium, and time integration is generalized-alpha with modified Newton, one
thread.
"""

import time
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from math import cos
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.beams import CreateReevingCurve, PointsAndSlopes2ANCFCable2D
from exudyn.utilities import (
    Cable2D,
    CoordinateConstraint,
    LoadCoordinate,
    MarkerBodyCable2DShape,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    NodeGenericData,
    NodePointGround,
    NodeRigidBody2D,
    ObjectContactFrictionCircleCable2D,
    ObjectRigidBody2D,
    SensorNode,
)

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Profile, Pulley


@dataclass(frozen=True)
class Settings:
    """Choices in Exudyn: step (s), contact segments an element, tolerances of Newton, spectral radius."""

    step: float = 1e-3
    segments: int = 12
    rtol: float = 1e-5
    atol: float = 1e-6
    spectral_radius: float = 0.3


@dataclass(frozen=True, eq=False)
class PeerRun:
    """Driven speed over time, and seconds of the processor for the transient alone."""

    time: FloatArray
    speed: FloatArray
    seconds: float


def simulate(drive: Drive, settings: Settings) -> PeerRun:
    """Simulate a drive of two pulleys, the first prescribed.

    Raises
    ------
    RuntimeError
        If Exudyn gives up.
    """
    model = _Model(drive, settings)
    model.settle()
    return model.march()


class _Model:
    """The multibody system."""

    def __init__(self, drive: Drive, settings: Settings) -> None:
        exu.SetWriteToConsole(False)
        self._drive, self._settings = drive, settings
        self._container = exu.SystemContainer()
        self._system = self._container.AddSystem()
        self._contacts: list[Any] = []
        self._held: list[Any] = []
        ground = self._system.AddNode(NodePointGround())
        self._ground = self._system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        self._cables = self._add_belt()
        self._driver = self._add_pulley(drive.pulleys[0])
        self._add_pulley(drive.pulleys[1])
        self._system.Assemble()

    def settle(self) -> None:
        """Find the equilibrium without friction, then let go."""
        options = self._options()
        solver = options.staticSolver
        solver.numberOfLoadSteps, solver.adaptiveStep, solver.stabilizerODE2term = 10, True, 1e5
        solver.newton.relativeTolerance = solver.newton.absoluteTolerance = 1e-6
        solver.discontinuous.iterationTolerance, solver.discontinuous.maxIterations = 1e-3, 20
        self._system.SolveStatic(options, updateInitialValues=True)
        for contact in self._contacts:
            self._system.SetObjectParameter(contact, "frictionCoefficient", self._drive.contact.friction)
        for constraint in self._held:
            self._system.SetObjectParameter(constraint, "activeConnector", False)
        self._system.SetObjectParameter(self._driver, "activeConnector", True)

    def march(self) -> PeerRun:
        """Integrate over time."""
        options, duration = self._options(), self._drive.simulation.duration
        options.solutionSettings.sensorsWritePeriod = self._drive.simulation.output_interval
        integration = options.timeIntegration
        integration.endTime, integration.numberOfSteps = duration, round(duration / self._settings.step)
        integration.adaptiveStep, integration.newton.useModifiedNewton = True, True
        integration.newton.relativeTolerance = self._settings.rtol
        integration.newton.absoluteTolerance = self._settings.atol
        integration.discontinuous.maxIterations, integration.discontinuous.iterationTolerance = 5, 1e-3
        integration.generalizedAlpha.spectralRadius = self._settings.spectral_radius
        begin = time.process_time()
        self._system.SolveDynamic(options, solverType=exu.DynamicSolverType.GeneralizedAlpha)
        seconds = time.process_time() - begin
        rows = np.array(self._system.GetSensorStoredData(self._sensor))
        return PeerRun(rows[:, 0], rows[:, 3], seconds)

    def _options(self) -> Any:
        options: Any = exu.SimulationSettings()
        options.solutionSettings.writeSolutionToFile = False
        options.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        options.parallel.numberOfThreads = 1
        options.timeIntegration.verboseMode = options.staticSolver.verboseMode = 0
        return options

    def _add_belt(self) -> list[Any]:
        belt, pulleys = self._drive.belt, self._drive.pulleys
        circles = [[list(pulley.center), pulley.radius, "L"] for pulley in pulleys]
        curve = CreateReevingCurve(circles, numberOfANCFnodes=belt.given_elements, closedCurve=True)
        stretch = curve["totalLength"] / belt.given_length
        nodes = [np.array([x, y, dx * stretch, dy * stretch]) for x, y, dx, dy in curve["ancfPointsSlopes"]]
        cable = Cable2D(
            massPerLength=belt.mass_per_length,
            bendingStiffness=belt.bending_stiffness,
            axialStiffness=belt.axial_stiffness,
            useReducedOrderIntegration=2,
        )
        made = PointsAndSlopes2ANCFCable2D(
            self._system,
            nodes,
            [belt.given_length / belt.given_elements] * belt.given_elements,
            cable,
            fixedConstraintsNode0=[1, 0, 0, 0],
            firstNodeIsLastNode=True,
        )
        self._stretch = stretch
        self._held += made[4]
        return list(made[1])

    def _add_pulley(self, pulley: Pulley) -> Any:
        """Add a pulley with its contacts; gives the constraint that drives it, if it is prescribed."""
        system, x, y = self._system, *pulley.center
        node = system.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0.0]))
        inertia = pulley.inertia or 1.0  # that of a prescribed pulley does not matter
        body = system.AddObject(ObjectRigidBody2D(mass=1.0, inertia=inertia, nodeNumber=node))
        markers = [system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=c)) for c in range(3)]
        for marker in markers[:2]:
            system.AddObject(CoordinateConstraint(markerNumbers=[self._ground, marker]))
        self._held.append(system.AddObject(CoordinateConstraint(markerNumbers=[self._ground, markers[2]])))
        driver = None
        if pulley.speed is not None:
            driver = system.AddObject(
                CoordinateConstraint(
                    markerNumbers=[self._ground, markers[2]],
                    velocityLevel=True,
                    offsetUserFunction_t=_profile(pulley.speed),
                    activeConnector=False,
                )
            )
        elif pulley.torque is not None:
            torque = _profile(pulley.torque)
            system.AddLoad(LoadCoordinate(markerNumber=markers[2], load=0, loadUserFunction=torque))
        quantity = exu.OutputVariableType.AngularVelocity
        self._sensor = system.AddSensor(SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=quantity))
        self._add_contacts(pulley, body)
        return driver

    def _add_contacts(self, pulley: Pulley, body: Any) -> None:
        belt, contact, count = self._drive.belt, self._drive.contact, self._settings.segments
        segment = belt.given_length / (belt.given_elements * count)
        circle = self._system.AddMarker(MarkerBodyRigid(bodyNumber=body))
        for cable in self._cables:
            shape = self._system.AddMarker(MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=count))
            memory = NodeGenericData(
                initialCoordinates=[0.1] * count + [-2] * count + [0] * count, numberOfDataCoordinates=3 * count
            )
            made = ObjectContactFrictionCircleCable2D(
                markerNumbers=[circle, shape],
                nodeNumber=self._system.AddNode(memory),
                numberOfContactSegments=count,
                contactStiffness=contact.given("stiffness") * segment,
                contactDamping=contact.given("damping") * segment,
                frictionVelocityPenalty=(contact.creep_rate_factor or 0.0) * segment,
                frictionStiffness=0.0,
                frictionCoefficient=0.0,
                circleRadius=pulley.radius * cos(segment * self._stretch / (2 * pulley.radius)),
                useSegmentNormals=True,
            )
            self._contacts.append(self._system.AddObject(made))


def _profile(profile: Profile) -> Callable[..., float]:
    """A user function of Exudyn from a profile over time, in plain floats; its other arguments do not matter."""
    pieces = profile.segments()
    starts, parts = pieces.start.tolist(), pieces[["offset", "slope", "amplitude", "frequency", "phase"]].tolist()

    def function(_system: Any, t: float, *_: Any) -> float:
        k = max(bisect_left(starts, t) - 1, 0)
        constant, slope, amplitude, omega, phase = parts[k]
        rise = slope * (t - starts[k]) if slope else 0.0
        return float(constant + rise + amplitude * cos(omega * t + phase))

    return function
