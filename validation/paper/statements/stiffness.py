"""Fig. 8: the ripple of the driven speed and the stiffness of the belt."""

from collections.abc import Mapping
from math import pi

from matplotlib.figure import Figure

from beltdyn.model import Drive
from beltdyn.show.plot.style import INK, color, dash, new_figure
from validation.paper.hand_formulas import creeping_torsional_swing, torsional_swing
from validation.paper.measures import DRIVER, largest, ripple, ripple_frequency, speed, times
from validation.paper.numbers import power_of_ten
from validation.paper.picture import picture
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Section, Statement, verdict
from validation.published import better, two_pulley

_FINE = 120
_MODULI = (1e8, 1e9)
_RTOL = 1e-4
_LIMIT = 0.05
_PUBLISHED = {1e8: "two_pulley_20", 1e9: "stiff_20"}
_BETTER = {1e8: f"two_pulley_{_FINE}_better", 1e9: f"stiff_{_FINE}_better"}


def cases() -> Mapping[str, Drive]:
    """Both stiffnesses with published and with better settings."""
    return {
        **{_PUBLISHED[modulus]: two_pulley(20, modulus) for modulus in _MODULI},
        **{_BETTER[modulus]: better(two_pulley(20, modulus), _FINE, rtol=_RTOL) for modulus in _MODULI},
    }


def section(runs: Runs) -> Section:
    """Amplitude and frequency of the ripple."""
    return Section(
        "stiffness",
        "Stiffness of the belt (Fig. 8)",
        "Case 1 with E = 10⁸ and 10⁹ Pa. The ripple is the driven speed less the driver's after the ramp, from 0.6 s "
        "on; its frequency is that of its "
        f"first six crossings. Better settings are {_FINE} elements, contact zones, equilibrium start and rtol = "
        f"{_RTOL:g}.",
        [_amplitude(runs), _frequency(runs)],
        [_draw(runs)],
    )


def _label(modulus: float) -> str:
    return f"E = {power_of_ten(modulus)} Pa"


def _amplitude(runs: Runs) -> Statement:
    def finding(settings: str, names: Mapping[float, str]) -> Finding:
        sizes = {modulus: largest(ripple(runs[name])) for modulus, name in names.items()}
        numbers = [Number(f"{_label(modulus)}: largest ripple", size, "rad/s") for modulus, size in sizes.items()]
        for modulus, name in names.items():
            omega = torsional_swing(runs[name].drive).frequency * 2.0 * pi
            numbers.append(Number(f"{_label(modulus)}: slope of the ramp / ω", 12.0 / 0.55 / omega, "rad/s"))
        return Finding(
            settings, [*numbers, Number("quotient", sizes[1e9] / sizes[1e8])], verdict(sizes[1e9] < sizes[1e8])
        )

    return Statement(
        name="stiffness-reduces-ripple",
        title="A stiffer belt swings less",
        quote="The amplitude of the oscillations of the angular velocity of the driven pulley around the velocity of "
        "the driver pulley can be reduced if the stiffness of the belt is increased",
        page=251,
        criterion="The largest ripple is smaller with the larger modulus.",
        findings=[finding("as published", _PUBLISHED), finding("better settings", _BETTER)],
        remark="A ramp that ends suddenly leaves a swing of its slope over ω when nothing damps: it falls with the "
        "square root of the modulus, to 0.32.",
    )


def _frequency(runs: Runs) -> Statement:
    def finding(settings: str, names: Mapping[float, str]) -> Finding:
        numbers, worst = [], 0.0
        for modulus, name in names.items():
            run = runs[name]
            measured = ripple_frequency(run)
            plain, creeping = torsional_swing(run.drive), creeping_torsional_swing(run.drive)
            worst = max(worst, abs(measured / creeping.frequency - 1.0))
            numbers += [
                Number(f"{_label(modulus)}: measured", measured, "Hz"),
                Number("spans between tangent points", plain.frequency, "Hz"),
                Number("with creep on the arcs", creeping.frequency, "Hz"),
                Number("measured to that", measured / creeping.frequency - 1.0, "%"),
                Number("its decay rate", creeping.decay, "1/s"),
            ]
        return Finding(settings, numbers, verdict(worst < _LIMIT))

    return Statement(
        name="torsional-frequency",
        title="The ripple is the torsional swing of the driven pulley on two spans",
        quote="",
        page=None,
        criterion="Measured frequencies are within 5 % of the hand formula with creep.",
        findings=[finding("as published", _PUBLISHED), finding("better settings", _BETTER)],
        remark="A check of our own. I θ″ + 2 k R² θ = 0 with k = EA/L. L is the span of 0.383 m or, with creep, "
        "longer at each end by (EA/B) coth(λa/2)/λ, "
        "λ = √(iωνₛ/B), a the arc, 1/B = 1/EA + 1/(R² kₚ): the stretch of a span reaches into the arcs, where a taut "
        "belt sinks in and shortens its way, and "
        "creep there damps the swing.",
    )


@picture("Fig. 8: driver and driven speed for both moduli, published settings; below, after the ramp.")
def _draw(runs: Runs) -> Figure:
    figure = new_figure((6.4, 5.2))
    whole, after = figure.subplots(2, 1, height_ratios=(3, 2))
    for ax in (whole, after):
        first = runs[_PUBLISHED[1e8]]
        ax.plot(times(first), speed(first, DRIVER), color=INK, linewidth=1.0, label="driver")
        for number, (modulus, name) in enumerate(_PUBLISHED.items()):
            run = runs[name]
            ax.plot(
                times(run), speed(run), color=color(number), linestyle=dash(number), label=f"driven, {_label(modulus)}"
            )
        ax.set_ylabel("Speed [rad/s]")
    after.set(xlim=(0.55, 1.0), ylim=(11.5, 12.5), xlabel="Time [s]")
    whole.legend()
    return figure
