"""Fewer elements where pulleys are of very different sizes, for the smallest sets the length of all elements."""

from collections.abc import Mapping

from beltdyn.model import Drive
from validation.paper.numbers import shown
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, all_hold
from validation.paper.statements.model_errors import Series, Values, errors_of
from validation.paper.statements.model_runs import BEAMS, PAPER, TRUSSES, Case, Model, make, reference_name, run_name
from validation.published import better, two_pulley

_SPEED, _RAMP = 12.0, {"start": 0.02, "end": 0.15}
_CENTER, _STRETCH = 0.3, 1.0028
_SMALL, _LARGE = 0.04, 0.16
_MESHES = {
    PAPER: (20, 30, 45, 60, 90),
    TRUSSES: (120, 180, 240, 360),
    BEAMS: (60, 90, 120, 180),
}
_REFERENCE = 180
_LIMIT = 0.05


def _drive(radius: float) -> Drive:
    """Two pulleys on the belt of Table 1, stretched as in case 1; the driver has a radius, the driven one is large."""
    drive = better(two_pulley(), duration=0.4)
    driver, driven = drive.pulleys
    laid = drive.replace(
        pulley=[
            driver.replace(center=(-_CENTER, 0.0), radius=radius, speed={"kind": "ramp", "value": _SPEED, **_RAMP}),
            driven.replace(center=(_CENTER, 0.0), radius=_LARGE),
        ],
        belt=drive.belt.replace(length=1.5),
    )
    return laid.replace(belt=laid.belt.replace(length=laid.path.length / _STRETCH))


UNEQUAL = Case("unequal_radii", "pulleys of 40 and 160 mm", 20, _SPEED, lambda: _drive(_SMALL), loaded=False)
EQUAL = Case("equal_radii", "two pulleys of 160 mm", 20, _SPEED, lambda: _drive(_LARGE), loaded=False)


def cases() -> Mapping[str, Drive]:
    """Both drives with all meshes and a reference."""
    drives: dict[str, Drive] = {}
    for case in (UNEQUAL, EQUAL):
        drives |= {run_name(case, model, n): make(case, model, n) for model, counts in _MESHES.items() for n in counts}
        drives[reference_name(case, _REFERENCE)] = make(case, PAPER, _REFERENCE)
    return drives


def section(runs: Runs) -> Section:
    """Elements for the same tension."""
    return Section(
        "small-pulley",
        "Pulleys of very different sizes (section 3)",
        "The belt of Table 1, stretched as in case 1, on pulleys of 40 and 160 mm that are 0.6 m apart, and on two of "
        f"160 mm; run up to 12 rad/s in {_RAMP['end']:g} s. Errors are those of the mean span tensions in the last "
        f"0.2 s against {_REFERENCE} of the paper's elements.",
        [_fewer(runs)],
    )


def _series(runs: Runs, case: Case, model: Model) -> Series:
    exact = Values.of(runs[reference_name(case, _REFERENCE)])
    return Series(case, model, [errors_of(runs[run_name(case, model, n)], exact, case) for n in _MESHES[model]])


def _fewer(runs: Runs) -> Statement:
    def finding(case: Case) -> Finding:
        path = case.build().path
        on_large = float(path.wrap_angles[1]) * _LARGE / path.length
        brackets = {model: _series(runs, case, model).bracket("tension", _LIMIT) for model in _MESHES}
        numbers: list[Number] = []
        for model, bracket in brackets.items():
            needed = bracket.needed("elements")
            sides = [str(mesh.elements) if mesh else "–" for mesh in (bracket.misses, bracket.meets)]
            numbers += [
                Number(f"{model.title}: elements", f"{shown(needed)} ({sides[0]}–{sides[1]})"),
                Number("of them on the large pulley", on_large * needed),
            ]
        own, *others = brackets.values()
        return Finding(case.title, numbers, all_hold(own.fewer_than(other) for other in others))

    return Statement(
        name="fewer-elements-with-unequal-pulleys",
        title="Where pulleys differ in size, fewer elements on the small one save many in all",
        quote="the smallest pulley forces to use an excessive number of elements for the larger one. Hence, the total "
        "number of elements in the model can be considerably decreased with a reduction in the number of elements "
        "needed per pulley.",
        page=247,
        criterion="For span tensions to 5 % on unequal pulleys, the paper's element needs fewer elements and fewer "
        "unknowns in all than truss and than three-node beam elements with contact at nodes, by more than the distance "
        "between meshes.",
        findings=[finding(UNEQUAL), finding(EQUAL)],
        remark="All elements have one length: what the small pulley needs, the large one and the spans get too, as the "
        "numbers for two large pulleys show. Numbers are interpolated; in brackets the meshes on either side.",
        departures=("tension-on-coarse-meshes",),
    )
