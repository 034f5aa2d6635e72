"""The models that the paper compares itself with: truss and three-node beam elements, and contact at nodes."""

from collections.abc import Callable, Mapping, Sequence
from math import isfinite

from beltdyn.model import Drive
from beltdyn.report.numbers import shown
from beltdyn.report.paper.model_errors import Comparison, Errors, Series, compare
from beltdyn.report.paper.model_runs import (
    BEAM,
    BEAMS,
    CASES,
    COARSER_REFERENCE,
    PAPER,
    PAPER_NODAL,
    REFERENCE,
    REFERENCE_RTOL,
    TRUSS,
    TRUSSES,
    TRUSSES_DISTRIBUTED,
    compared_cases,
)
from beltdyn.report.paper.model_tables import NAMES, error_table, measures_of, order_table
from beltdyn.report.paper.work_precision import draw_convergence, draw_distributions, draw_work
from beltdyn.report.runs import Runs
from beltdyn.report.statement import Finding, Number, Section, Statement, Value, verdict

TARGETS = {"speed": 0.01, "tension": 0.05, "normal": 0.10, "friction": 0.10}
"""Errors that a model has to stay below."""

_SIGNIFICANT = 0.5
"""Significantly smaller means at most this part."""

_GEOMETRY = ("tension", "normal")
"""The errors that come from how well the belt follows the pulleys."""

_PEERS = (TRUSSES, BEAMS)
_PEER_ELEMENTS = {TRUSSES: (TRUSS, 100, 202), BEAMS: (BEAM, 38, 154)}
"""Elements around the belt; elements and unknowns that the paper counts on half a pulley."""


def cases() -> Mapping[str, Drive]:
    """Every model on every case with all its meshes, and the references."""
    return compared_cases()


def section(runs: Runs) -> Section:
    """What each model needs for the same accuracy."""
    comparisons = [compare(runs, case) for case in CASES]
    return Section(
        "other-models",
        "The models it compares itself with",
        "The same belt is cut into the paper's elements, into straight truss elements, and into three-node beam "
        "elements (two links with torsional springs), with contact all along the elements or at nodes only, as in "
        "the models of Leamy and Wasfy. Solver, tolerance (rtol = 10⁻³), contact law and equilibrium start are the "
        f"same for all. Errors are those against {REFERENCE} of the paper's elements with distributed contact and "
        f"rtol = {REFERENCE_RTOL:g}: driven speed, rms over the run, over the driver's speed; mean span tensions of "
        "the last 0.2 s, relative; mean force over the arcs of both pulleys in the last 0.2 s, in 36 parts of each "
        "arc, rms, over that of the reference. The unevenness is what the normal force at a place of the arc "
        "changes by as the belt runs over it, rms, over its mean. Run times were taken with two runs side by side. "
        f"{_own_errors(comparisons)}",
        [
            _peers_agree(comparisons),
            *(_fewer(comparisons, measures) for measures in (("speed",), ("tension",), ("normal", "friction"))),
            _same_accuracy(comparisons),
            _distributed(comparisons),
            _smooth(comparisons),
            _time(comparisons),
        ],
        [
            *(draw_convergence(comparison, TARGETS) for comparison in comparisons),
            *(draw_work(comparison, TARGETS) for comparison in comparisons),
            *(draw_distributions(runs, comparison) for comparison in comparisons),
        ],
        [*(error_table(comparison) for comparison in comparisons), order_table(comparisons)],
    )


def _own_errors(comparisons: Sequence[Comparison]) -> str:
    """How far the reference has converged."""
    parts = [
        f"{c.case.title}: " + ", ".join(f"{NAMES[m]} {shown(c.coarser.of(m), '%')}" for m in measures_of(c))
        for c in comparisons
    ]
    return f"{COARSER_REFERENCE} elements differ from it by ({'; '.join(parts)})."


def _count(found: Series, measure: str, cost: str = "unknowns") -> Value:
    """What a target takes, in words where it lies outside the meshes."""
    target = TARGETS[measure]
    needed = found.needed(measure, target, cost)
    if not isfinite(needed):
        return f"more than {shown(getattr(found.errors[-1], cost))}"
    if found.suffices(measure, target):
        return f"{shown(_rounded(needed, cost))} or fewer" if cost == "unknowns" else f"{shown(needed)} or less"
    return _rounded(needed, cost)


def _rounded(value: float, cost: str) -> Value:
    return round(value) if cost == "unknowns" else value


def _saves(own: Series, peer: Series, measure: str, cost: str = "unknowns") -> bool:
    """Whether a target takes at most half of the cost; not, where the peer's coarsest mesh is good enough already."""
    half = _SIGNIFICANT * peer.needed(measure, TARGETS[measure], cost)
    return not peer.suffices(measure, TARGETS[measure]) and own.needed(measure, TARGETS[measure], cost) <= half


def _error_numbers(errors: Errors, measures: Sequence[str]) -> list[Number]:
    return [Number(f"{NAMES[measure]}, error", errors.of(measure), "%") for measure in measures]


def _findings(comparisons: Sequence[Comparison], make: Callable[[Comparison], Finding]) -> list[Finding]:
    return [make(comparison) for comparison in comparisons]


def _peers_agree(comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        numbers, met, measures = [], True, measures_of(comparison)
        for model, (elements, on_half, counted) in _PEER_ELEMENTS.items():
            errors = comparison.series[model].at(elements)
            met &= errors.half_pulley == counted and all(errors.of(m) <= TARGETS[m] for m in measures)
            numbers += [
                Number(f"{model.title}, {on_half} on half a pulley: unknowns there", errors.half_pulley),
                *_error_numbers(errors, measures),
            ]
        return Finding(comparison.case.title, numbers, verdict(met))

    return Statement(
        name="leamy-and-wasfy-agree",
        title="100 truss or 38 three-node beam elements on half a pulley are in good agreement",
        quote="the results of the proposed models and analytical values are in good agreement for discretizations "
        "with 38 (three node beam elements, 154 degrees of freedom) or 100 (truss elements, 202 degrees of freedom) "
        "elements per half pulley",
        page=240,
        criterion="The counts come out, and both are within 1 % in speed, 5 % in span tension and 10 % in the mean "
        "forces of the reference.",
        findings=_findings(comparisons, finding),
        remark="Their agreement was with analytical values of another drive; here it is with a converged mesh of the "
        "paper's.",
    )


def _fewer(comparisons: Sequence[Comparison], measures: Sequence[str]) -> Statement:
    names = " and ".join(NAMES[measure] for measure in measures)
    targets = " and ".join(f"{TARGETS[measure]:.0%} in {NAMES[measure]}".replace("%", " %") for measure in measures)

    def finding(comparison: Comparison) -> Finding:
        own, peers = comparison.series[PAPER], [comparison.series[model] for model in _PEERS]
        used = [measure for measure in measures if measure in measures_of(comparison)]
        numbers = [
            Number(f"{NAMES[measure]}: {found.model.title}", _count(found, measure))
            for measure in used
            for found in (own, *peers)
        ]
        met = all(_saves(own, peer, measure) for measure in used for peer in peers)
        return Finding(comparison.case.title, numbers, verdict(met))

    return Statement(
        name=f"fewer-unknowns-{measures[0]}",
        title=f"For the same {names} the paper's element needs significantly fewer unknowns",
        quote="using the distributed contact forces and high-order elements based on the absolute nodal coordinate "
        "formulation, the realistic behavior of the belt-drives can be obtained with a significantly smaller number "
        "of elements and degrees of freedom in comparison to the previously published finite element models of "
        "belt-drives",
        page=255,
        criterion=f"For an error of {targets} it needs at most half the unknowns of truss and of three-node beam "
        "elements with contact at nodes.",
        findings=_findings(comparisons, finding),
        remark=_REMARKS[measures[0]],
    )


_REMARKS = {
    "speed": "Where the coarsest mesh is good enough, its unknowns are an upper limit, and the statement is not "
    "shown. Few links change the tension, not the length of belt that runs on, so that speeds hardly depend on them.",
    "tension": "Nodes on a circle cut its arcs short by the part φ²/24 of their length, with φ the angle of a link, "
    "and links all along which contact acts bulge by as much: the belt is too slack or too tight by E A φ²/24 times "
    "the part of it that lies on pulleys.",
    "normal": "Friction is judged where a load makes it.",
}


def _same_accuracy(comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        elements, measures = comparison.case.elements, measures_of(comparison)
        own = comparison.series[PAPER].at(elements)
        numbers, met = [], True
        for measure in measures:
            peers = {model: comparison.series[model].at(_PEER_ELEMENTS[model][0]).of(measure) for model in _PEERS}
            met &= own.of(measure) <= max(peers.values())
            numbers += [
                Number(f"{NAMES[measure]}, error: {elements} of the paper's elements", own.of(measure), "%"),
                *(Number(f"{model.title}", value, "%") for model, value in peers.items()),
            ]
        return Finding(comparison.case.title, numbers, verdict(met))

    return Statement(
        name="as-accurate-as-leamy-and-wasfy",
        title="The paper's mesh does what their meshes do with far more unknowns",
        quote="the model uses only four elements (30 degrees of freedom) to discretize half of the pulley, which is "
        "significantly smaller than the number of elements and degrees of freedom used in the models of Leamy and "
        "Wasfy",
        page=250,
        criterion="With the paper's 20 elements (30 in case 2), no error is larger than the larger one of 100 truss "
        "and 38 three-node beam elements on half a pulley.",
        findings=_findings(comparisons, finding),
        remark="That the number is smaller is plain; the criterion asks whether it buys the same accuracy.",
    )


def _distributed(comparisons: Sequence[Comparison]) -> Statement:
    pairs = (("the paper's elements", PAPER, PAPER_NODAL), ("trusses", TRUSSES_DISTRIBUTED, TRUSSES))

    def finding(comparison: Comparison) -> Finding:
        numbers = [
            Number(f"{NAMES[measure]}, {name}, contact {model.sampling}", _count(comparison.series[model], measure))
            for measure in _GEOMETRY
            for name, *pair in pairs
            for model in pair
        ]
        own, nodal = comparison.series[PAPER], comparison.series[PAPER_NODAL]
        return Finding(comparison.case.title, numbers, verdict(all(_saves(own, nodal, m) for m in _GEOMETRY)))

    return Statement(
        name="distributed-contact",
        title="Contact all along the elements, not at nodes, is what saves unknowns",
        quote="With this contribution to the contact model there is no need to use a high number of nodes for "
        "realistic representation of the boundary of the pulley",
        page=255,
        criterion="For 5 % in span tension and 10 % in mean normal force, the paper's element needs at most half as "
        "many unknowns with distributed contact as with contact at nodes.",
        findings=_findings(comparisons, finding),
    )


def _smooth(comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        elements, own = comparison.case.elements, comparison.series[PAPER]
        at_nodes = comparison.series[TRUSSES].at(TRUSS).unevenness
        coarse = own.at(elements).unevenness
        numbers = [Number(f"{mesh.elements} of the paper's elements", mesh.unevenness, "%") for mesh in own.errors] + [
            Number(f"{model.title}, {mesh.elements}", mesh.unevenness, "%")
            for model in (TRUSSES, TRUSSES_DISTRIBUTED)
            for mesh in comparison.series[model].errors
            if mesh.elements in (120, 240, TRUSS)
        ]
        numbers.append(Number("the reference", comparison.reference.unevenness, "%"))
        return Finding(comparison.case.title, numbers, verdict(coarse <= 2.0 * at_nodes))

    return Statement(
        name="even-forces",
        title="Distributed contact forces are even along the arc",
        quote="the contact forces can be distributed along the length of the element instead of concentrating them "
        "at the nodes",
        page=255,
        criterion="The unevenness with the paper's elements (20, or 30 in case 2) is at most twice that of 100 truss "
        "elements with contact at nodes.",
        findings=_findings(comparisons, finding),
        remark="A force at a node is a force per metre times the length that the node stands for; per metre, nodes "
        "show no ripple, since all lie equally deep. A cubic or a link that lies partly above and partly below the "
        "rim does. What is left in the reference is the swing of the drive itself.",
    )


def _time(comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        own, peers = comparison.series[PAPER], [comparison.series[model] for model in _PEERS]
        numbers = [
            Number(f"{NAMES[measure]}: {found.model.title}", _count(found, measure, "wall_time"), "s")
            for measure in _GEOMETRY
            for found in (own, *peers)
        ]
        met = all(_saves(own, peer, measure, "wall_time") for measure in _GEOMETRY for peer in peers)
        return Finding(comparison.case.title, numbers, verdict(met))

    return Statement(
        name="less-time",
        title="It takes less computing time",
        quote="",
        page=None,
        criterion="For 5 % in span tension and 10 % in mean normal force it takes at most half the run time of truss "
        "and of three-node beam elements with contact at nodes.",
        findings=_findings(comparisons, finding),
        remark="A check of our own: the paper gives no times, and says why. Nodes that enter and leave contact end "
        "steps early, the more of them the fewer and heavier they are.",
    )
