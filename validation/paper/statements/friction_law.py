"""Fig. 3: the friction law."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction import ForceSlope, friction_force
from beltdyn.model import Drive
from beltdyn.show.plot.style import color, dash, new_figure
from validation.paper.numbers import power_of_ten
from validation.paper.picture import picture
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, verdict
from validation.published import two_pulley

_NORMAL = 2e4  # N/m: about what Figs. 11 and 13 show
_FACTORS = (1e4, 1e5)
_ROUNDING = 1e-12


def cases() -> Mapping[str, Drive]:
    """Nothing is simulated."""
    return {}


def section(_: Runs) -> Section:
    """The law of the code, evaluated."""
    statement = Statement(
        name="tri-linear-friction",
        title="Friction is tri-linear in the slip velocity",
        quote="In this method, a penalty formulation is applied with a Coulomb-like tri-linear creep-rate dependent "
        "friction.",
        page=244,
        criterion="The slope at rest is νₛ, and the force at large slip is μ fₙ, both to rounding.",
        findings=[_finding()],
        remark="μ = 1.2 is that of Table 1. νₛ is “the slope of the friction force with respect to tangent velocity at "
        "small sliding velocities” (p. 246), here of the force per unit length (p. 254).",
    )
    return Section(
        "friction-law",
        "Friction law (Fig. 3)",
        f"The kernel that every simulation calls, at a normal force of {_NORMAL / 1e3:g} kN/m, which is the level of "
        "Figs. 11 and 13.",
        [statement],
        [_draw()],
    )


def _finding() -> Finding:
    numbers, met = [], True
    for factor in _FACTORS:
        small = 1e-6
        slope = -_friction(np.array([small]), factor)[0] / small
        full = _friction(np.array([-10.0]), factor)[0]
        met &= abs(slope / factor - 1.0) < _ROUNDING
        met &= abs(full / (_friction_coefficient() * _NORMAL) - 1.0) < _ROUNDING
        numbers += [
            Number(f"slope for νₛ = {power_of_ten(factor)}", float(slope), "kg/(m·s)"),
            Number("slip velocity of full friction", _friction_coefficient() * _NORMAL / factor, "m/s"),
        ]
    return Finding("as published", numbers, verdict(bool(met)))


def _friction_coefficient() -> float:
    return float(two_pulley().frictions[0])


def _friction(slip: FloatArray, factor: float) -> FloatArray:
    """Friction force of the kernel, N/m."""
    law, friction = ForceSlope(factor), _friction_coefficient()
    return np.array([friction_force(law, float(value), _NORMAL, friction, 0.0)[0] for value in slip])


@picture("Friction force on the belt over its slip velocity, for the two creep-rate factors of the paper.")
def _draw() -> Figure:
    figure = new_figure((5.2, 3.4))
    ax = figure.add_subplot()
    slip = np.linspace(-3.6, 3.6, 721)
    for number, factor in enumerate(_FACTORS):
        values = _friction(slip, factor) / 1e3
        label = f"νₛ = {power_of_ten(factor)} kg/(m·s)"
        ax.plot(slip, values, color=color(number), linestyle=dash(number), label=label)
    ax.set(xlabel="Slip velocity [m/s]", ylabel="Friction force [kN/m]")
    ax.legend()
    return figure
