"""Errors of the compared models against a converged mesh, the order at which they fall, and what a target takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, prepare
from beltdyn.results import Run
from beltdyn.system.build import drive_system
from validation.paper.averages import mean_forces
from validation.paper.measures import rms, settled, speed
from validation.paper.runs import Runs
from validation.paper.statement import Verdict
from validation.paper.statements.model_runs import COARSER_REFERENCE, MODELS, Case, Model, reference_name, run_name

MEASURES = ("speed", "tension", "normal", "friction")
"""The errors, in the order of the page."""

_FALLS = 0.8
_FEWEST_POINTS = 3


@dataclass(frozen=True, slots=True)
class Errors:
    """What a run costs and how far it is from the reference.

    Attributes
    ----------
    elements, unknowns, half_pulley : int
        Elements and unknowns of the belt; unknowns of the elements on half a pulley, as the paper counts.
    speed : float
        Driven speed over the whole run, root mean square, over the driver's speed.
    tension : float
        Mean tension of the spans at the end, root mean square over the spans, relative.
    normal, friction : float
        Mean force over the arc at the end, root mean square over the arcs of both pulleys, over that of the
        reference's.
    unevenness : float
        Root mean square in the middle of the arcs of the momentary normal force less its mean at the place, relative.
    cpu_time : float, s
        Processor time, outputs included.
    steps : int
        With those that were rejected.
    """

    elements: int
    unknowns: int
    half_pulley: int
    speed: float
    tension: float
    normal: float
    friction: float
    unevenness: float
    cpu_time: float
    steps: int

    def of(self, measure: str) -> float:
        """One of the errors by its name."""
        return float(getattr(self, measure))


@dataclass(frozen=True, eq=False)
class Values:
    """What the errors of a run are made of.

    Attributes
    ----------
    speed : ndarray, shape (outputs,), rad/s
        Of the driven pulley.
    tension : ndarray, shape (2,), N
        Of the spans, mean over the end of the run.
    normal, friction : ndarray, shape (2 BINS,), N/m
        Mean forces over the arcs of both pulleys.
    unevenness : float
        As in `Errors`.
    """

    speed: FloatArray
    tension: FloatArray
    normal: FloatArray
    friction: FloatArray
    unevenness: float

    @classmethod
    def of(cls, run: Run) -> Self:
        """Read them from a run."""
        normal, friction = (mean_forces(run, kind) for kind in ("normal", "friction"))
        tension = settled(run, "span_tension").mean("time").values
        return cls(speed(run), tension, normal, friction, rms(run.dataset["unevenness"].values))


def errors_of(run: Run, exact: Values, case: Case) -> Errors:
    """Measure a run.

    Parameters
    ----------
    run : Run
        The run.
    exact : Values
        Those of the reference, at the same instants.
    case : Case
        Their drive.
    """
    found, attributes = Values.of(run), run.dataset.attrs
    return Errors(
        elements=run.drive.elements,
        unknowns=unknowns(run.drive),
        half_pulley=half_pulley(run.drive),
        speed=rms(found.speed - exact.speed) / case.speed,
        tension=rms(found.tension / exact.tension - 1.0),
        normal=rms(found.normal - exact.normal) / rms(exact.normal),
        friction=rms(found.friction - exact.friction) / rms(exact.friction) if case.loaded else float("nan"),
        unevenness=found.unevenness,
        cpu_time=float(attributes["cpu_time"]),
        steps=int(attributes["steps"] + attributes["rejected_steps"]),
    )


def unknowns(drive: Drive) -> int:
    """Nodal coordinates of a belt; the driven pulley's angle is counted apart."""
    system = drive_system(prepare(drive))
    return int(system.supports.fixed.size)


def half_pulley(drive: Drive) -> int:
    """Nodal coordinates of the elements on half a pulley, the nodes at both ends included."""
    belt, arc = drive.belt, float(drive.path.wrap_angles[0]) * float(drive.radii[0])
    elements = round(arc / (drive.path.length / belt.given_elements))
    kind = belt.element_kind
    return len(kind.coordinates) * (kind.points * elements + 1)


@dataclass(frozen=True, slots=True)
class Series:
    """The meshes of a model on a case, from coarse to fine.

    Attributes
    ----------
    case, model
        Which ones.
    errors : sequence of Errors
        One for each mesh.
    """

    case: Case
    model: Model
    errors: Sequence[Errors]

    def at(self, elements: int) -> Errors:
        """The mesh of a number of elements."""
        return next(error for error in self.errors if error.elements == elements)

    def values(self, measure: str) -> FloatArray:
        """An error over the meshes."""
        return np.array([error.of(measure) for error in self.errors])

    def falling(self, measure: str) -> Sequence[Errors]:
        """The meshes from the largest error on while each has less than 0.8 of the error of the one before."""
        values = self.values(measure)
        first = last = int(np.argmax(values))
        while last + 1 < len(values) and values[last + 1] < _FALLS * values[last]:
            last += 1
        return self.errors[first : last + 1]

    def order(self, measure: str) -> float:
        """Slope of log error over log unknowns where it falls, fitted; NaN for fewer than three meshes."""
        meshes = self.falling(measure)
        if len(meshes) < _FEWEST_POINTS:
            return float("nan")
        counts, values = zip(*((mesh.unknowns, mesh.of(measure)) for mesh in meshes), strict=True)
        return -float(np.polyfit(np.log(counts), np.log(values), 1)[0])

    def bracket(self, measure: str, target: float) -> "Bracket":
        """The meshes between which an error falls below a target for good.

        Parameters
        ----------
        measure : str
            Which error.
        target : float
            Its limit.
        """
        values = self.values(measure)
        too_large = np.flatnonzero(~(values <= target))
        if not too_large.size:
            return Bracket(None, self.errors[0], 1.0)
        last = int(too_large[-1])
        if last + 1 == len(values):
            return Bracket(self.errors[last], None, np.inf)
        part = np.log(values[last] / target) / np.log(values[last] / values[last + 1])
        return Bracket(self.errors[last], self.errors[last + 1], float(part))


@dataclass(frozen=True, slots=True)
class Bracket:
    """Where the meshes of a model begin to meet a target.

    Attributes
    ----------
    misses : Errors or None
        The finest mesh whose error is too large; None if the coarsest is good enough.
    meets : Errors or None
        The next finer one, from which on all are good enough; None if the finest mesh is not.
    part : float
        Where the target lies between them, 0 to 1, interpolated on logarithmic scales.
    """

    misses: Errors | None
    meets: Errors | None
    part: float

    def interpolate(self, misses: FloatArray | float, meets: FloatArray | float) -> FloatArray:
        """What the target takes, between what the two meshes take."""
        return np.asarray(misses) ** (1.0 - self.part) * np.asarray(meets) ** self.part

    def needed(self, cost: str = "unknowns") -> float:
        """What the target costs: infinite if the finest mesh is not good enough, the coarsest mesh's if that is.

        Parameters
        ----------
        cost : str
            "elements" or "unknowns".
        """
        if self.meets is None:
            return float("inf")
        high = float(getattr(self.meets, cost))
        return high if self.misses is None else float(self.interpolate(float(getattr(self.misses, cost)), high))

    def fewer_than(self, other: Self) -> Verdict:
        """Whether the target takes fewer elements and fewer unknowns than another model takes.

        It does where a mesh that meets it has fewer of both than a mesh of the other model that misses it; it does not
        where a mesh that misses it has as many of one as a mesh of the other that meets it.  Else meshes lie too far
        apart to tell.

        Parameters
        ----------
        other : Bracket
            That of the other model.
        """
        costs = ("elements", "unknowns")
        if self.meets and other.misses and all(getattr(self.meets, c) < getattr(other.misses, c) for c in costs):
            return Verdict.HOLDS
        if self.misses and other.meets and any(getattr(self.misses, c) >= getattr(other.meets, c) for c in costs):
            return Verdict.FAILS
        return Verdict.OPEN


@dataclass(frozen=True, slots=True)
class Comparison:
    """All models on a case.

    Attributes
    ----------
    case : Case
        Which one.
    series : dict
        Model -> its meshes.
    reference, coarser : Errors
        The reference measured by itself, and the next coarser mesh, which tells how far it has converged.
    """

    case: Case
    series: Mapping[Model, Series]
    reference: Errors
    coarser: Errors


def compare(runs: Runs, case: Case) -> Comparison:
    """Measure all models on a case."""
    finest = runs[reference_name(case)]
    exact = Values.of(finest)

    def series(model: Model) -> Series:
        return Series(case, model, [errors_of(runs[run_name(case, model, n)], exact, case) for n in case.meshes(model)])

    coarser = errors_of(runs[reference_name(case, COARSER_REFERENCE)], exact, case)
    return Comparison(case, {model: series(model) for model in MODELS}, errors_of(finest, exact, case), coarser)
