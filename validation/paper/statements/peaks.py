"""Peaks of the friction force at the ends of contact (Figs. 10 and 12)."""

from collections.abc import Iterator

from beltdyn.model import layer_lengths
from beltdyn.results import Run
from validation.paper.distribution import Peak, distribution, find_peak, fit_line
from validation.paper.measures import settled
from validation.paper.runs import Runs
from validation.paper.statement import Finding, Number, Statement, verdict
from validation.paper.statements.loaded_runs import FACTORS, POWERS, PUBLISHED, PULLEYS, SETTINGS

_PEAK = 0.1
_ENDS = {"inlet": False, "exit": True}
_MEASURE = (
    "A peak rises above the line fitted in the middle, carried on to its place, by more than 10 % of the mean "
    "magnitude in the middle"
)


def peak_statements(runs: Runs) -> list[Statement]:
    """What the paper says of peaks.

    Parameters
    ----------
    runs : Runs
        The runs under load.
    """
    return [_driver(runs), _emphasised(runs), _driven(runs)]


def _peaks(runs: Runs, name: str, pulley: str) -> dict[str, Peak]:
    forces = distribution(runs[name], PULLEYS.index(pulley))
    return {end: find_peak(forces, at_exit) for end, at_exit in _ENDS.items()}


def _numbers(peaks: dict[str, Peak], start: str) -> Iterator[Number]:
    for end, peak in peaks.items():
        yield Number(f"{start}{end}: rises by", peak.excess, "%")
        yield Number("force there", peak.force, "N/m")
        yield Number(f"from the {end}", peak.distance, "m")


def _rise_by_hand(run: Run) -> float:
    """Largest rise of friction on the driver that the angle between belt and rim can cause, over its level."""
    level = fit_line(distribution(run, PULLEYS.index("driver")), "friction").level
    _, layer = layer_lengths(run.drive, float(settled(run, "span_tension").mean()))
    radius = float(run.drive.radii[0])
    factor: float = run.drive.contact.creep_rate_factor
    belt_speed = float(settled(run, "belt_speed").mean())
    return factor * belt_speed * 0.5 * (layer / radius) ** 2 / level


def _is_peak(peaks: dict[str, Peak]) -> bool:
    return all(peak.excess > _PEAK for peak in peaks.values())


def _driver(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        peaks = {factor: _peaks(runs, SETTINGS[settings](factor), "driver") for factor in FACTORS}
        numbers: list[Number] = []
        for factor in FACTORS:
            numbers += _numbers(peaks[factor], f"νₛ = {POWERS[factor]}, ")
            numbers.append(Number("by hand at most", _rise_by_hand(runs[SETTINGS[settings](factor)]), "%"))
        return Finding(settings, numbers, verdict(all(map(_is_peak, peaks.values()))))

    return Statement(
        name="driver-peaks",
        title="Friction has peaks at the inlet and the exit of the driver",
        quote="In this study, however, the friction force has peaks on the arriving (inlet) and leaving (exit) zones "
        "of the driver pulley.",
        page=253,
        criterion=f"{_MEASURE}, at both ends and for both factors.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
        remark="Where contact begins and ends, the belt runs at an angle β to the rim and slower along it by the "
        "part β²/2. A string that settles into the penalty "
        "contact has β = √(T/kₚ)/R at most, so that friction rises by νₛ v T / (2 kₚ R²) at most; Coulomb's limit "
        "and bending cut it. The peaks belong to the "
        "penalty, not to the belt: they shrink as kₚ grows.",
        departures=("the-peaks-of-friction-belong-to-the-penalty",),
    )


def _emphasised(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        numbers, met = [], True
        for end in _ENDS:
            low, high = (_peaks(runs, SETTINGS[settings](factor), "driver")[end].excess for factor in FACTORS)
            numbers += [Number(f"{end}: 10⁴ rises by", low, "%"), Number("10⁵ rises by", high, "%")]
            met &= high > low
        return Finding(settings, numbers, verdict(met))

    return Statement(
        name="peaks-emphasised",
        title="The peaks grow with the creep-rate factor",
        quote="This pattern is emphasized when the creep-rate factor increases.",
        page=253,
        criterion="Both peaks of the driver rise further above the line with the larger factor, over the mean "
        "magnitude in the middle.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
    )


def _driven(runs: Runs) -> Statement:
    def finding(settings: str) -> Finding:
        peaks = {factor: _peaks(runs, SETTINGS[settings](factor), "driven") for factor in FACTORS}
        numbers = [number for factor in FACTORS for number in _numbers(peaks[factor], f"νₛ = {POWERS[factor]}, ")]
        return Finding(settings, numbers, verdict(_is_peak(peaks["1e5"]) and not _is_peak(peaks["1e4"])))

    return Statement(
        name="driven-peaks",
        title="With νₛ = 10⁵ the driven pulley has peaks too",
        quote="In the case of the large creep-rate factor, the peaks in the friction force distribution can be seen "
        "also in the driven pulley.",
        page=253,
        criterion=f"{_MEASURE}, at both ends of the driven pulley with νₛ = 10⁵, and not at both with 10⁴.",
        findings=[finding(settings) for settings in SETTINGS],
        published=PUBLISHED,
        remark="The cause is the same as on the driver. It opposes the friction of the driven pulley, and where the "
        "force changes its sign it outweighs it.",
    )
