"""Slip and stick within an element, and the cost of friction as it comes near to Coulomb's law."""

from collections.abc import Mapping

import numpy as np

from beltdyn.model import Drive
from validation.paper.measures import times
from validation.paper.numbers import power_of_ten
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, judged, verdict
from validation.paper.statements.loaded_runs import FACTORS, POWERS, loaded_cases, published_name
from validation.published import better, two_pulley

_STEEP = {1e5: "two_pulley_20", 1e7: "coulomb_1e7_20"}
_STEEP_BETTER = {factor: f"{name}_better" for factor, name in _STEEP.items()}
_CLEARLY = 1.1


def cases() -> Mapping[str, Drive]:
    """Case 1 with friction that comes nearer and nearer to Coulomb's, and the drives under load."""
    steep = {name: two_pulley(creep_rate_factor=factor) for factor, name in _STEEP.items()}
    smooth = {name: better(two_pulley(creep_rate_factor=factor)) for factor, name in _STEEP_BETTER.items()}
    loaded = {name: drive for name, drive in loaded_cases().items() if name in map(published_name, FACTORS)}
    return {**steep, **smooth, **loaded}


def section(runs: Runs) -> Section:
    """What friction does along an element, and to the integrator."""
    return Section(
        "slip-and-stick",
        "Slip and stick",
        "A contact point slides where friction is 99.9 % of what Coulomb’s law allows or more, and sticks, but for "
        "creep, where it is less. The tri-linear law is Coulomb’s with its jump replaced by the slope νₛ, so that it "
        "comes near to Coulomb’s as νₛ grows.",
        [_coulomb(runs), _within_an_element(runs)],
    )


def _coulomb(runs: Runs) -> Statement:
    def finding(settings: str, names: Mapping[float, str]) -> Finding:
        numbers, spent = [], []
        for factor, name in names.items():
            attributes = runs[name].dataset.attrs
            spent.append(int(attributes["newton_iterations"]))
            numbers += [
                Number(f"νₛ = {power_of_ten(factor)}: Newton iterations", spent[-1]),
                Number("steps", int(attributes["steps"])),
                Number("rejected", int(attributes["rejected_steps"])),
            ]
        dearer = spent[-1] / spent[0]
        numbers.append(Number("iterations, last over first", dearer))
        return Finding(settings, numbers, judged(holds=dearer > _CLEARLY, fails=dearer < 1.0 / _CLEARLY))

    return Statement(
        name="coulomb-is-costlier",
        title="Coulomb’s law is costlier to integrate than the tri-linear law",
        quote="considering the pure Coulomb model, the integration of the equation of motion results in a cumbersome "
        "process. The use of a tri-linear creep-rate law … alleviates the friction model difficulties; therefore, the "
        "resulting system of equations is, in a computational sense, less expensive to integrate",
        page=245,
        criterion="With a slope a hundred times that of Table 1, case 1 takes more Newton iterations by over a tenth. "
        "It does not hold if it takes fewer by as much, and is undecided in between.",
        findings=[finding("as published", _STEEP), finding("better settings", _STEEP_BETTER)],
        remark="Coulomb’s law itself, with a jump of friction at rest, has no tangent and is not run: it is the limit "
        "of larger and larger slopes.",
    )


def _within_an_element(runs: Runs) -> Statement:
    def finding(title: str, name: str) -> Finding:
        mixed = np.asarray(runs[name].dataset["mixed_elements"])
        numbers = [
            Number("outputs with such an element", int(np.count_nonzero(mixed))),
            Number("of", mixed.size),
            Number("such elements at once, at most", int(mixed.max())),
            Number("at the last output", int(mixed[-1])),
            Number("first at", float(times(runs[name])[int(np.argmax(mixed > 0))]) if mixed.any() else "–", "s"),
        ]
        return Finding(title, numbers, verdict(bool(mixed.any())))

    return Statement(
        name="slip-and-stick-within-an-element",
        title="Parts of an element slide while others stick",
        quote="the normal and friction forces can be different from point to point and, indeed, it should be possible "
        "to find areas of slippage and areas of sticking within the same element",
        page=246,
        criterion="At some output an element has integration points that slide and others that touch and stick.",
        findings=[
            finding("case 1, as published", "two_pulley_20"),
            *(finding(f"case 2, νₛ = {POWERS[factor]}, 11 points", published_name(factor)) for factor in FACTORS),
        ],
    )
