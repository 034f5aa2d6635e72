"""Standard integrators on the equations of motion, with a shared node and with multipliers."""

from collections.abc import Mapping

from beltdyn.model import Drive
from validation.paper.measures import largest, speed
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, verdict
from validation.published import better, two_pulley

_TITLES = {
    "generalized_alpha": "generalised-α",
    "cvode": "CVODE",
    "ida": "IDA",
    "bdf": "SciPy BDF",
}
_RUNS = {"shared_node": tuple(_TITLES), "multipliers": ("generalized_alpha", "cvode", "ida")}
_JOINTS = {"shared_node": "shared node (Eq. 27)", "multipliers": "multipliers (Eq. 26)"}
_ELEMENTS, _DURATION, _RAMP = 10, 0.1, {"start": 0.01, "end": 0.06}
_SAME = 0.01


def cases() -> Mapping[str, Drive]:
    """Case 1 with a shorter ramp, by several integrators and both forms of the joint."""
    return {_name(joint, name): _drive(joint, name) for joint, names in _RUNS.items() for name in names}


def _name(joint: str, integrator: str) -> str:
    return f"integrator_{joint}_{integrator}"


def _drive(joint: str, integrator: str) -> Drive:
    drive = better(two_pulley(_ELEMENTS), duration=_DURATION, joint=joint, integrator=integrator)
    driver, driven = drive.pulleys
    return drive.replace(pulley=[driver.replace(speed={"kind": "ramp", "value": 2.0, **_RAMP}), driven])


def section(runs: Runs) -> Section:
    """Agreement of integrators."""
    return Section(
        "integrators",
        "Integrators (Eqs. 26 and 27)",
        f"Case 1 with {_ELEMENTS} elements and better settings, run up to 2 rad/s within {_DURATION:g} s, by the "
        "integrator of this package and by those of SUNDIALS and SciPy.",
        [_any(runs)],
    )


def _any(runs: Runs) -> Statement:
    def finding(joint: str) -> Finding:
        own = speed(runs[_name("shared_node", "generalized_alpha")])
        numbers, met = [], True
        for integrator in _RUNS[joint]:
            title, run = _TITLES[integrator], runs[_name(joint, integrator)]
            apart = largest(speed(run) - own) / largest(own)
            met &= apart < _SAME
            numbers += [
                Number(f"{title}: driven speed differs by at most", apart, "%"),
                Number("steps", int(run.dataset.attrs["steps"])),
                Number("processor time", float(run.dataset.attrs["cpu_time"]), "s"),
            ]
        return Finding(_JOINTS[joint], numbers, verdict(met))

    return Statement(
        name="any-standard-integrator",
        title="Any standard integrator serves",
        quote="both Equations (26) and (27) present a very simple structure that facilitates the use of any standard "
        "integrator",
        page=248,
        criterion="Integrators of SUNDIALS and SciPy finish, and their driven speeds are within 1 % of generalized-α "
        "with a shared node, over the largest driven speed.",
        findings=[finding(joint) for joint in _JOINTS],
        remark="Contact and friction make the equations stiff: explicit integrators would take steps of a microsecond.",
    )
