"""Figs. 10-13: friction and normal force on both pulleys under load, and their shape."""

from collections.abc import Iterator, Mapping
from itertools import product

import numpy as np
from matplotlib.figure import Figure

from beltdyn.model import Drive, layer_lengths
from beltdyn.results import Run
from beltdyn.show.plot.style import INK, color, dash, new_figure
from validation.paper.distribution import END, Line, distribution, fit_line
from validation.paper.hand_formulas import creep_lag
from validation.paper.measures import DRIVER, settled, settled_mean, speed
from validation.paper.picture import picture
from validation.paper.runs import Runs
from validation.paper.statement import (
    Finding,
    Number,
    Picture,
    Section,
    Statement,
    Verdict,
    all_hold,
    clearly_below,
    verdict,
)
from validation.paper.statements.loaded_runs import (
    FACTORS,
    FINE,
    KINDS,
    LOAD,
    POINTS,
    POWERS,
    PUBLISHED,
    PULLEYS,
    SETTINGS,
    fine_name,
    loaded_cases,
    published_name,
)
from validation.paper.statements.peaks import peak_statements

_LINEAR = 0.05
_STEADY = 1e-3
_BALANCED = 0.01
_EXCEPTION = ("driver", "friction")
_FIGURES = {("1e4", "friction"): 10, ("1e4", "normal"): 11, ("1e5", "friction"): 12, ("1e5", "normal"): 13}


def cases() -> Mapping[str, Drive]:
    """All runs under load."""
    return loaded_cases()


def section(runs: Runs) -> Section:
    """Shape of the distributions."""
    tension = float(settled(runs[published_name("1e4")], "span_tension").mean())
    _, layer = layer_lengths(runs[published_name("1e4")].drive, tension)
    return Section(
        "contact-forces",
        "Friction and normal forces (Figs. 10-13)",
        "The drive of Eq. 29 at t = 1 s: 120 rad/s, 45 N m, 30 elements, the torque as printed. A straight line is "
        "fitted to each force over the "
        f"middle {1 - 2 * END:.0%} of the arc: what is left out at each end is about four times the length √(T/kₚ) = "
        f"{1e3 * layer:.0f} mm over which "
        "a belt under tension settles into the penalty contact. A deviation is the rms distance from that line over "
        "the mean magnitude of the force "
        "there. The paper does not say with how many points its figures were made: a verdict is that of 5, 7 and 11 "
        "points if they agree, and undecided if not. "
        f"Better settings are {FINE} elements, contact "
        "zones and equilibrium start.",
        [_steady(runs), _linear(runs), _exception(runs), _nonlinear(runs), *peak_statements(runs), _literature()],
        [_draw(runs, factor, kind) for factor, kind in _FIGURES],
    )


def _lines(runs: Runs, name: str) -> dict[tuple[str, str], Line]:
    """Straight lines of a run by pulley and kind of force."""
    return {
        (pulley, kind): fit_line(distribution(runs[name], number), kind)
        for (number, pulley), kind in product(enumerate(PULLEYS), KINDS)
    }


def _lag(run: Run) -> float:
    """Mean speed of the driver less that of the driven pulley at the end, rad/s."""
    return settled_mean(run, "pulley_speed", DRIVER) - settled_mean(run, "pulley_speed")


def _steady(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        numbers, met = [], True
        for factor in FACTORS:
            run = runs[SETTINGS[settings](factor)]
            driven, torque = (settled(run, name)[:, 1].values for name in ("pulley_speed", "pulley_torque"))
            change = float(np.ptp(driven) / driven.mean())
            balance = float(torque.mean()) / LOAD - 1.0
            met &= change < _STEADY and abs(balance) < _BALANCED
            numbers += [
                Number(f"νₛ = {POWERS[factor]}: range of the driven speed", change, "%"),
                Number("mean torque on the driven pulley less 45 N m", balance, "%"),
                Number("rms of that torque's noise", float(torque.std()) / LOAD, "%"),
                Number("driven behind driver", _lag(run), "rad/s"),
                Number("creep by hand", creep_lag(run.drive, LOAD, float(speed(run, DRIVER)[-1])), "rad/s"),
            ]
        return Finding(settings, numbers, verdict(met))

    return Statement(
        name="steady-at-one-second",
        title="At 1 s the drive has reached its steady state",
        quote="The results have been taken at a simulation time of 1 s when the belt and pulley system under "
        "consideration has achieved the steady state running condition.",
        page=253,
        criterion="In the last 0.2 s the driven speed stays within 0.1 %, and the belt's mean torque on the driven "
        "pulley within 1 % of the load.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
        remark="The noise of the torque with fixed points comes from points that enter and leave contact.",
        departures=("the-torque-of-eq-29", "integration-of-contact"),
    )


def _deviation_numbers(lines: Mapping[tuple[str, str], Line], start: str = "") -> Iterator[Number]:
    for (pulley, kind), line in lines.items():
        yield Number(f"{start}{pulley}, {kind}: deviation", line.deviation, "%")


def _linear(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        lines = _lines(runs, SETTINGS[settings]("1e4"))
        linear = all_hold(
            clearly_below(line.deviation, _LINEAR) for place, line in lines.items() if place != _EXCEPTION
        )
        return Finding(settings, list(_deviation_numbers(lines)), linear)

    return Statement(
        name="linear-with-low-factor",
        title="With νₛ = 10⁴ the forces have an approximately linear pattern",
        quote="When the friction creep-rate factor is 1.0 × 10⁴ kg/(m s), the force distributions have an "
        "approximately linear pattern",
        page=253,
        criterion="In the middle of the arc, both normal forces and the friction of the driven pulley deviate from a "
        "line by less than 5 %; undecided within a fifth of that, by which forces at an instant change with time "
        "steps.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
    )


def _exception(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        lines = _lines(runs, SETTINGS[settings]("1e4"))
        driver, driven = lines["driver", "friction"], lines["driven", "friction"]
        numbers = [
            Number("driver: deviation with the ends", driver.deviation_with_ends, "%"),
            Number("driven: deviation with the ends", driven.deviation_with_ends, "%"),
            Number("driver: in the middle", driver.deviation, "%"),
            Number("driven: in the middle", driven.deviation, "%"),
        ]
        excepted = all_hold(
            [clearly_below(_LINEAR, driver.deviation_with_ends), clearly_below(driven.deviation_with_ends, _LINEAR)]
        )
        return Finding(settings, numbers, excepted)

    return Statement(
        name="except-driver-friction",
        title="… with exception of the friction of the driver",
        quote="with exception of the tangential force distribution of the driver pulley",
        page=253,
        criterion="Over the whole arc, but for points that glide, friction on the driver deviates from its line by "
        "more than 5 %, and friction on the driven pulley by less; undecided within a fifth of that.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
        remark="Where contact begins and ends the belt runs at an angle to the rim, and so slower along it. That "
        "adds to the slip on the driver, where friction rises, and takes from it "
        "on the driven pulley, where friction falls. A rise is more easily seen than a fall, but it is no more of an "
        "exception.",
    )


def _nonlinear(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        low, high = (_lines(runs, SETTINGS[settings](factor)) for factor in FACTORS)
        numbers = [*_deviation_numbers(low, "10⁴: "), *_deviation_numbers(high, "10⁵: ")]
        return Finding(settings, numbers, verdict(all(high[place].deviation > low[place].deviation for place in low)))

    return Statement(
        name="nonlinear-with-high-factor",
        title="With νₛ = 10⁵ the forces become more nonlinear",
        quote="The force distributions become more nonlinear when the creep-rate factor is increased to 1.0 × 10⁵ "
        "kg/(m s)",
        page=253,
        criterion="In the middle of the arc, each of the four forces deviates more from its line than with νₛ = 10⁴.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
        remark="Creep carries friction over a length E A / (νₛ v): 1.0 m with 10⁴, which on an arc of 0.26 m is a "
        "line, and 0.1 m with 10⁵.",
    )


def _literature() -> Statement:
    return Statement(
        name="like-leamy-and-wasfy",
        title="Leamy and Wasfy found the same change of shape",
        quote="This occurrence can be also found from the studies of Leamy and Wasfy",
        page=253,
        criterion="The text would have to give their distributions; theirs is another drive, as the paper says.",
        findings=[Finding("as published", [], Verdict.OPEN)],
    )


def _draw(runs: Runs, factor: str, kind: str) -> Picture:
    caption = (
        f"Fig. {_FIGURES[factor, kind]}: {kind} force on the belt, νₛ = {POWERS[factor]} kg/(m s), "
        f"with 5, 7 and 11 points as published, and with {FINE} elements and better settings. "
        "Gray dots: the line fitted to the latter."
    )
    return picture(caption)(_figure)(runs, factor, kind)


def _figure(runs: Runs, factor: str, kind: str) -> Figure:
    figure = new_figure((9.0, 3.5))
    names = {f"{points} points": published_name(factor, points) for points in POINTS}
    for number, ax in enumerate(figure.subplots(1, 2)):
        for index, (label, name) in enumerate(names.items()):
            forces = distribution(runs[name], number)
            values = forces.force(kind) / 1e3
            ax.plot(
                forces.distance,
                values,
                color=color(index),
                linestyle=dash(index),
                marker="o",
                markersize=2.2,
                label=label,
            )
        forces = distribution(runs[fine_name(factor)], number)
        ax.plot(forces.distance, forces.force(kind) / 1e3, color=INK, linewidth=0.9, label=f"{FINE} elements")
        line = fit_line(forces, kind).at(forces.place) / 1e3
        middle = (forces.place > END) & (forces.place < 1.0 - END)
        ax.plot(forces.distance[middle], line[middle], color="0.35", linestyle=":", linewidth=1.6)
        ax.set(xlabel="Belt from its first point in contact [m]", ylabel=f"{kind.capitalize()} force [kN/m]")
        ax.set_title(PULLEYS[number])
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
