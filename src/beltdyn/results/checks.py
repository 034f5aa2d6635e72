"""What makes a result doubtful, said with numbers and a remedy."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.model import Drive
from beltdyn.results.means import first_of_window, pulley_means
from beltdyn.results.mechanics import capstan_margin, rim_speeds
from beltdyn.results.recorded import Recorded, attribute, names
from beltdyn.results.resolution import FORCE_LIMIT, Resolution

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account that passes without a warning."""

MARGIN_LIMIT = 1.5
"""Smallest capstan margin that passes without a warning."""

GROWTH_LIMIT = math.log(100.0)
"""Largest growth of vibrations where the belt slides, as the logarithm of a factor, that passes without a warning."""

SLIDING_LIMIT = 1e-3
"""Largest velocity of sliding of a whole arc, over the speed of the belt, that passes without a warning."""

_LARGEST = 700.0
"""Logarithm of about the largest number there is."""


def find_warnings(dataset: Recorded, drive: Drive, resolution: Resolution | None) -> list[str]:
    """Look for what makes a result doubtful.

    Parameters
    ----------
    dataset : Recorded
        The results.
    drive : Drive
        The drive.
    resolution : Resolution or None
        How well its mesh resolves tension and contact; None if there is no output.

    Returns
    -------
    list of str
        One sentence or two for each finding.
    """
    if resolution is None:
        return ["nothing was recorded: the run ended before its first output."]
    return [
        *_unfinished(dataset, drive),
        *_open_energy_account(dataset, drive),
        *_slack_spans(dataset),
        *_lost_contact(dataset, drive),
        *_gross_slip(dataset, drive),
        *_near_gross_slip_before(dataset, drive),
        *_flutter(dataset, drive),
        *_stopped_tensioners(dataset, drive),
        *_unresolved(resolution, drive),
    ]


def _unfinished(dataset: Recorded, drive: Drive) -> Iterator[str]:
    status = dataset.attrs["status"]
    if status != "completed":
        end = float(dataset["time"][-1])
        ended = {"interrupted": "was interrupted", "failed": "failed"}.get(status, "goes on, or was killed")
        yield f"the run {ended}: results end at t = {end:.6g} s of {drive.simulation.duration:.6g} s."


def _open_energy_account(dataset: Recorded, drive: Drive) -> Iterator[str]:
    closure = float(dataset["energy_closure"][-1])
    if abs(closure) > CLOSURE_LIMIT:
        yield (
            f"the energy account is open by {closure:.2%} of the energy put in, more than {CLOSURE_LIMIT:.0%}. "
            f"Reduce simulation.rtol = {drive.simulation.rtol:g}."
        )


def _slack_spans(dataset: Recorded) -> Iterator[str]:
    tensions = np.asarray(dataset["span_tension"])
    for name, tension in zip(names(dataset, "span"), tensions.T, strict=True):
        lowest = float(tension.min())
        if lowest <= 0.0:
            time = float(dataset["time"][int(tension.argmin())])
            yield (
                f"the span {name} is slack: its tension falls to {lowest:.4g} N at t = {time:.4g} s. "
                "Shorten the belt, or reduce the load."
            )


def _lost_contact(dataset: Recorded, drive: Drive) -> Iterator[str]:
    """Pulleys that the belt leaves, of those it is laid on."""
    free = np.asarray(dataset["wrap_angle"]) <= 0.0
    for pulley, laid, left in zip(drive.pulleys, drive.path.wrap_angles, free.T, strict=True):
        if laid > 0.0 and left.any():
            time = float(dataset["time"][int(left.argmax())])
            yield f"the belt leaves the pulley {pulley.name} at t = {time:.4g} s. Raise the tension."


def _gross_slip(dataset: Recorded, drive: Drive) -> Iterator[str]:
    """Pulleys that slide through at the end of the run, or are near to it."""
    remedy = "Raise the tension or the wrap angle, or reduce the load."
    pulleys = pulley_means(dataset, drive)
    rims = np.abs(rim_speeds(np.array([pulley.speed for pulley in pulleys]), drive))
    for pulley in pulleys:
        sliding = abs(pulley.sliding_speed)
        if sliding > SLIDING_LIMIT * rims[0]:
            part = sliding / rims[0] if rims[0] > 0.0 else np.inf
            share = f", {part:.{0 if part > 0.1 else 1}%} of the rim's speed of {pulleys[0].name}"
            share = share if np.isfinite(part) else ""
            yield f"{pulley.name} slides through: the whole arc slides, at {sliding:.3g} m/s{share}. {remedy}"
        elif 0.0 < pulley.margin < MARGIN_LIMIT and rims[0] > 0.0:
            slips = f" slips {pulley.slip:.1%}," if pulley.slip != 0.0 else ":"
            yield f"{pulley.name}{slips} gross slip at {pulley.margin:.1f} times this load. {remedy}"


def _near_gross_slip_before(dataset: Recorded, drive: Drive) -> Iterator[str]:
    """Pulleys that reached gross slip earlier than at the end of the run, for more than a single output."""
    tension, speed, wrap, torque = (
        np.asarray(dataset[name]) for name in ("span_tension", "belt_speed", "wrap_angle", "pulley_torque")
    )
    first = first_of_window(np.asarray(dataset["time"]))
    times, margins = np.asarray(dataset["time"])[:first], capstan_margin(tension, speed, wrap, drive)[:first]
    reached = (margins < 1.0) & (drive.frictions > 0.0)
    for pulley, when, load in zip(drive.pulleys, reached.T, np.abs(torque[:first]).T, strict=True):
        if np.count_nonzero(when) > 1:
            yield (
                f"{pulley.name} reached gross slip between t = {times[when][0]:.4g} s and {times[when][-1]:.4g} s, "
                f"first at {load[when][0]:.4g} N m: its load was more than friction transmits, for "
                f"{np.gradient(times)[when].sum():.2g} s in all. Raise the tension or the wrap angle, or load it more "
                "gently."
            )


def _flutter(dataset: Recorded, drive: Drive) -> Iterator[str]:
    """Vibrations that could grow far while the belt slid."""
    growth, start, end, frequency = (
        attribute(dataset, f"flutter_{name}", 0.0) for name in ("growth", "start", "end", "frequency")
    )
    if growth > GROWTH_LIMIT:
        critical = 2.0 * math.sqrt(drive.contact.stiffness * drive.belt.mass_per_length)
        yield (
            f"the belt may flutter where it slides: between t = {start:.4g} s and {end:.4g} s vibrations of "
            f"{frequency:.0f} Hz can grow by up to a factor of {math.exp(min(growth, _LARGEST)):.1g}. Long time steps "
            "damp them, short ones follow them, and speeds may differ: compare a run with a smaller simulation.rtol. "
            f"Raise contact.damping = {drive.contact.damping:g} N s/m^2 (critical: {critical:.2g})."
        )


def _stopped_tensioners(dataset: Recorded, drive: Drive) -> Iterator[str]:
    """Tensioners that lie on a stop at the end of the run, and since when."""
    moving = [tensioner for tensioner in drive.tensioners if tensioner.kind != "fixed"]
    for number, tensioner in enumerate(moving):
        if tensioner.stops is None:
            continue
        position, (lower, upper) = np.asarray(dataset["tensioner_position"])[:, number], tensioner.stops
        for name, on in (("lower", position <= lower), ("upper", position >= upper)):
            if on[-1]:
                first = float(dataset["time"][len(on) - int(np.argmin(on[::-1])) if not on.all() else 0])
                since = f" since t = {first:.4g} s" if len(on) > 1 else ""
                yield (
                    f"the tensioner of {tensioner.pulley} is on its {name} stop{since}. "
                    "It no longer keeps the tension: change the length of the belt, or the stops."
                )


def _unresolved(resolution: Resolution, drive: Drive) -> Iterator[str]:
    """Say what the mesh does not resolve, and which one would."""
    unresolved = [pulley.name for number, pulley in enumerate(drive.pulleys) if not resolution.resolves(number)]
    worst = max((error for error in resolution.force_errors if math.isfinite(error)), default=math.nan)
    said = []
    if unresolved:
        ripple = f" (they ripple by {worst:.0%} of their mean)" if worst > FORCE_LIMIT else ""
        said.append(f"the contact forces along {_enumerate(unresolved)}{ripple}")
    if not resolution.resolves_tension:
        said.append(f"the tension (up to {resolution.tension_error:.0%} too high)")
    if said:
        yield (
            f"the mesh does not resolve {', and '.join(said)}. Speeds converge earlier. "
            f"Set belt.elements = {resolution.elements} or more, in place of {drive.belt.elements}."
        )


def _enumerate(words: list[str]) -> str:
    """Write "a", "a and b", or "a, b and c"."""
    return " and ".join([*([", ".join(words[:-1])] if words[1:] else []), words[-1]])
