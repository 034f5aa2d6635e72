"""The models that the paper compares itself with: truss and three-node beam elements, and contact at nodes."""

from collections.abc import Callable, Mapping, Sequence

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from validation.paper.numbers import shown
from validation.paper.runs import REPEATS, Runs
from validation.paper.statement import Finding, Number, Section, Statement, Value, Verdict, all_hold, verdict
from validation.paper.statements.model_errors import Bracket, Comparison, Errors, Series, compare
from validation.paper.statements.model_runs import (
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
    Case,
    Model,
    compared_cases,
    run_name,
)
from validation.paper.statements.model_tables import NAMES, error_table, measures_of, order_table
from validation.paper.statements.work_precision import draw_convergence, draw_distributions, draw_work
from validation.paper.timing import below, with_spread

TARGETS = {"speed": (0.01, 0.002), "tension": (0.05, 0.01), "normal": (0.10, 0.02), "friction": (0.10, 0.05)}
"""Errors that a model has to stay below: what a figure shows, and what a design wants."""

_GEOMETRY = ("tension", "normal")
"""The errors that come from how well the belt follows the pulleys."""

_PEERS = (TRUSSES, BEAMS)
_PEER_ELEMENTS = {TRUSSES: (TRUSS, 100, 202), BEAMS: (BEAM, 38, 154)}
"""Elements around the belt; elements and unknowns that the paper counts on half a pulley."""


def cases() -> Mapping[str, Drive]:
    """Every model on every case with all its meshes, and the references."""
    return compared_cases()


def timed(runs: Runs) -> list[str]:
    """The meshes on either side of the targets whose computing time is compared."""
    pairs = [pair for case in CASES for pair in _sides(case, _brackets(compare(runs, case))).values()]
    return sorted({name for pair in pairs for name in pair})


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
        "changes by as the belt runs over it, rms, over its mean. "
        f"{_own_errors(comparisons)}",
        [
            _peers_agree(comparisons),
            *(_fewer(comparisons, measures) for measures in (("speed",), ("tension",), ("normal", "friction"))),
            _same_accuracy(comparisons),
            _distributed(comparisons),
            _smooth(comparisons),
            _time(runs, comparisons),
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


def _count(found: Series, measure: str, target: float) -> Value:
    """Elements and unknowns that a target takes, in words where they lie outside the meshes."""
    bracket = found.bracket(measure, target)
    if bracket.meets is None:
        return f"more than {found.errors[-1].elements} / {found.errors[-1].unknowns}"
    counts = f"{bracket.needed('elements'):.0f} / {bracket.needed():.0f}"
    if bracket.misses is None:
        return f"{counts} or fewer"
    return f"{counts} ({bracket.misses.elements}–{bracket.meets.elements})"


def _judge(own: Series, peer: Series, measure: str, targets: Sequence[float]) -> Verdict:
    """Whether a model needs fewer elements and unknowns than another for all targets."""
    return all_hold(own.bracket(measure, limit).fewer_than(peer.bracket(measure, limit)) for limit in targets)


def _error_numbers(errors: Errors, measures: Sequence[str]) -> list[Number]:
    return [Number(f"{NAMES[measure]}, error", errors.of(measure), "%") for measure in measures]


def _findings(comparisons: Sequence[Comparison], make: Callable[[Comparison], Finding]) -> list[Finding]:
    return [make(comparison) for comparison in comparisons]


def _peers_agree(comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        numbers, met, measures = [], True, measures_of(comparison)
        for model, (elements, on_half, counted) in _PEER_ELEMENTS.items():
            errors = comparison.series[model].at(elements)
            met &= errors.half_pulley == counted and all(errors.of(m) <= TARGETS[m][0] for m in measures)
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
    limits = " and ".join(f"{_limits(measure)} in {NAMES[measure]}" for measure in measures)

    def finding(comparison: Comparison) -> Finding:
        own, peers = comparison.series[PAPER], [comparison.series[model] for model in _PEERS]
        used = [measure for measure in measures if measure in measures_of(comparison)]
        numbers = [
            Number(f"{NAMES[measure]}, {shown(target, '%', 1)}: {found.model.title}", _count(found, measure, target))
            for measure in used
            for target in TARGETS[measure]
            for found in (own, *peers)
        ]
        met = all_hold(_judge(own, peer, measure, TARGETS[measure]) for measure in used for peer in peers)
        return Finding(comparison.case.title, numbers, met)

    return Statement(
        name=f"fewer-unknowns-{measures[0]}",
        title=f"For the same {names} the paper's element needs fewer elements and degrees of freedom",
        quote="using the distributed contact forces and high-order elements based on the absolute nodal coordinate "
        "formulation, the realistic behavior of the belt-drives can be obtained with a significantly smaller number "
        "of elements and degrees of freedom in comparison to the previously published finite element models of "
        "belt-drives",
        page=255,
        criterion=f"For errors of {limits} it needs fewer elements and fewer unknowns than truss and than three-node "
        "beam elements with contact at nodes, by more than the distance between meshes: one of its meshes meets the "
        "target with fewer of both than a mesh of theirs that misses it. Where meshes lie too far apart, or the "
        "coarsest are good enough already, it is undecided. Numbers are elements / unknowns, interpolated, and the "
        "elements of the meshes on either side.",
        findings=_findings(comparisons, finding),
        remark=f"The paper does not say how much is significant. {_REMARKS[measures[0]]}",
    )


def _limits(measure: str) -> str:
    return " and ".join(shown(target, "%", 1) for target in TARGETS[measure])


_REMARKS = {
    "speed": "Few links change the tension, not the length of belt that runs on, so that speeds hardly depend on them.",
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
        quote="",
        page=None,
        criterion="With the paper's 20 elements (30 in case 2), no error is larger than the larger one of 100 truss "
        "and 38 three-node beam elements on half a pulley.",
        findings=_findings(comparisons, finding),
        remark="A check of our own: the paper says that its mesh is smaller, not that it gives what theirs give.",
    )


def _distributed(comparisons: Sequence[Comparison]) -> Statement:
    pairs = (("the paper's elements", PAPER, PAPER_NODAL), ("trusses", TRUSSES_DISTRIBUTED, TRUSSES))

    def finding(comparison: Comparison) -> Finding:
        numbers = [
            Number(
                f"{NAMES[measure]}, {shown(TARGETS[measure][0], '%', 1)}: {name}, contact {model.sampling}",
                _count(comparison.series[model], measure, TARGETS[measure][0]),
            )
            for measure in _GEOMETRY
            for name, *pair in pairs
            for model in pair
        ]
        own, nodal = comparison.series[PAPER], comparison.series[PAPER_NODAL]
        met = all_hold(_judge(own, nodal, measure, TARGETS[measure][:1]) for measure in _GEOMETRY)
        return Finding(comparison.case.title, numbers, met)

    return Statement(
        name="distributed-contact",
        title="Contact all along the elements, not at nodes, is what saves unknowns",
        quote="With this contribution to the contact model there is no need to use a high number of nodes for "
        "realistic representation of the boundary of the pulley",
        page=255,
        criterion="For 5 % in span tension and 10 % in mean normal force, the paper's element needs fewer unknowns "
        "with distributed contact than with contact at nodes, by more than the distance between meshes.",
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
        quote="",
        page=None,
        criterion="The unevenness with the paper's elements (20, or 30 in case 2) is at most twice that of 100 truss "
        "elements with contact at nodes.",
        findings=_findings(comparisons, finding),
        remark="A check of our own: the paper says that forces are distributed, not that they are even. A force at a "
        "node is a force per meter times the length that the node stands for; per meter, nodes "
        "show no ripple, since all lie equally deep. A cubic or a link that lies partly above and partly below the "
        "rim does. What is left in the reference is the swing of the drive itself.",
    )


def _time(runs: Runs, comparisons: Sequence[Comparison]) -> Statement:
    def finding(comparison: Comparison) -> Finding:
        brackets = _brackets(comparison)
        times = _times(runs, comparison.case, brackets)
        numbers = [
            Number(
                f"{NAMES[measure]}: {model.title}", "not between meshes" if taken is None else with_spread(taken), "s"
            )
            for (measure, model), taken in times.items()
        ]
        return Finding(comparison.case.title, numbers, all_hold(_sooner(times, measure) for measure in _GEOMETRY))

    return Statement(
        name="less-time",
        title="It takes less computing time",
        quote="",
        page=None,
        criterion="For 5 % in span tension and 10 % in mean normal force it takes less processor time than truss and "
        "than three-node beam elements with contact at nodes: the longest of its repetitions is shorter than the "
        "shortest of theirs. Where they overlap it is undecided.",
        findings=_findings(comparisons, finding),
        remark=f"A check of our own: the paper gives no times, and says why. The two meshes on either side of a target "
        f"were run {REPEATS} times more in turns, side by side and without outputs, and their times interpolated; "
        "numbers are the median and the range. Nodes that enter and leave contact end steps early, the more of them "
        "the fewer and heavier they are.",
    )


_Brackets = dict[tuple[str, Model], Bracket]
_Times = dict[tuple[str, Model], FloatArray | None]


def _brackets(comparison: Comparison) -> _Brackets:
    """Where the compared models meet the targets of `less-time`."""
    series = [comparison.series[model] for model in (PAPER, *_PEERS)]
    return {
        (measure, found.model): found.bracket(measure, TARGETS[measure][0]) for measure in _GEOMETRY for found in series
    }


def _sides(case: Case, brackets: _Brackets) -> dict[tuple[str, Model], tuple[str, str]]:
    """Names of the runs on either side of each target that lies between two meshes."""
    return {
        key: (run_name(case, key[1], bracket.misses.elements), run_name(case, key[1], bracket.meets.elements))
        for key, bracket in brackets.items()
        if bracket.misses and bracket.meets
    }


def _times(runs: Runs, case: Case, brackets: _Brackets) -> _Times:
    """Processor times of every target in every repetition, s; None where it does not lie between two meshes."""
    sides = _sides(case, brackets)
    taken = runs.cpu_times({name for pair in sides.values() for name in pair})
    return {
        key: bracket.interpolate(*(taken[name] for name in sides[key])) if key in sides else None
        for key, bracket in brackets.items()
    }


def _sooner(times: _Times, measure: str) -> Verdict:
    own, *peers = (times[measure, model] for model in (PAPER, *_PEERS))
    return all_hold(Verdict.OPEN if own is None or peer is None else below(own, peer) for peer in peers)
