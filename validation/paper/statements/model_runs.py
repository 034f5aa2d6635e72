"""The runs that compare the paper's element with the elements of Leamy and Wasfy, by name."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from beltdyn.model import Drive
from validation.published import better, loaded_case_1, loaded_two_pulley, two_pulley

Kind = Literal["ancf", "truss", "three-node-beam"]
Sampling = Literal["distributed", "nodal"]

REFERENCE, COARSER_REFERENCE = 240, 160
"""Elements of the paper, with contact all along them, that errors are measured against, and those that tell its own."""

REFERENCE_RTOL = 1e-4
TRUSS, BEAM = 501, 192
"""Elements around the belt that make 100 truss or 38 three-node beam elements on half a pulley."""

_SHORTER = 1.3


@dataclass(frozen=True, slots=True)
class Model:
    """A way to cut the belt, and the numbers of elements that are run.

    Attributes
    ----------
    kind, sampling : str
        Values of ``belt.discretization`` and ``contact.sampling``.
    title : str
        What it is called on the page.
    meshes : tuple of int
        Numbers of elements, from coarse to fine.
    coarse : tuple of int
        Smaller numbers, for a belt that is stretched by so much that few links do not leave it slack.
    """

    kind: Kind
    sampling: Sampling
    title: str
    meshes: tuple[int, ...]
    coarse: tuple[int, ...] = ()


PAPER = Model("ancf", "distributed", "paper's element, distributed", (14, 20, 30, 36, 45, 60, 90, 120), (8, 10))
TRUSSES = Model("truss", "nodal", "truss, nodal", (90, 120, 135, 180, 240, 360, TRUSS), (30, 45, 60))
BEAMS = Model("three-node-beam", "nodal", "three-node beam, nodal", (45, 60, 66, 90, 120, BEAM), (15, 24, 30))
PAPER_NODAL = Model("ancf", "nodal", "paper's element, nodal", (30, 45, 60, 90, 120), (14, 20))
TRUSSES_DISTRIBUTED = Model("truss", "distributed", "truss, distributed", (60, 120, 240))
BEAMS_DISTRIBUTED = Model("three-node-beam", "distributed", "three-node beam, distributed", (30, 60, 120))

MODELS = (PAPER, TRUSSES, BEAMS, PAPER_NODAL, TRUSSES_DISTRIBUTED, BEAMS_DISTRIBUTED)
"""All of them; the first is the paper's, the next two are those of Leamy and Wasfy."""


@dataclass(frozen=True, slots=True)
class Case:
    """A drive that all models are run on.

    Attributes
    ----------
    name : str
        Begins the names of its runs.
    title : str
        What it is called on the page.
    elements : int
        Elements that the paper takes for it.
    speed : float
        Speed of its driver after the ramp, rad/s.
    build : callable
        Makes it; settings other than the belt's elements and contact places are the same for all models.
    loaded, tight : bool
        Whether friction carries a load at the end, and whether the belt stays taut with few links.
    """

    name: str
    title: str
    elements: int
    speed: float
    build: Callable[[], Drive]
    loaded: bool
    tight: bool = False

    def meshes(self, model: Model) -> tuple[int, ...]:
        """Numbers of elements that a model is run with, from coarse to fine."""
        return (*(model.coarse if self.tight else ()), *model.meshes)


CASES = (
    Case("case_1", "case 1", 20, 12.0, lambda: better(two_pulley()), loaded=False),
    Case("loaded_1", "case 1 with load", 20, 12.0, lambda: better(loaded_case_1(), duration=_SHORTER), loaded=True),
    Case("case_2", "case 2", 30, 120.0, lambda: better(loaded_two_pulley()), loaded=True, tight=True),
)
"""The drives of the comparison."""


def run_name(case: Case, model: Model, elements: int) -> str:
    """Name of a run."""
    return f"{case.name}_{model.kind}_{model.sampling}_{elements}"


def reference_name(case: Case, elements: int = REFERENCE) -> str:
    """Name of the reference run, or of the coarser one."""
    return f"{case.name}_reference_{elements}"


def make(case: Case, model: Model, elements: int) -> Drive:
    """The drive of a case with a belt cut in the way of a model."""
    drive = case.build()
    kind = None if model is PAPER else model.kind  # by default, so that drives of other parts are the same
    return drive.replace(
        belt=drive.belt.replace(discretization=kind, elements=elements),
        contact=drive.contact.replace(sampling=model.sampling),
    )


def compared_cases() -> dict[str, Drive]:
    """Every model on every case with all its meshes, and the references."""
    drives = {
        run_name(case, model, elements): make(case, model, elements)
        for case in CASES
        for model in MODELS
        for elements in case.meshes(model)
    }
    for case in CASES:
        for elements in (REFERENCE, COARSER_REFERENCE):
            drive = make(case, PAPER, elements)
            tight = drive.simulation.replace(rtol=REFERENCE_RTOL)
            drives[reference_name(case, elements)] = drive.replace(simulation=tight)
    return drives
