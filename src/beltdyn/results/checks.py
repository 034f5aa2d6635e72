"""What makes a result doubtful, said with numbers and a remedy."""

import math
from collections.abc import Iterator

import numpy as np

from beltdyn.model import Drive
from beltdyn.results.recorded import Recorded, names
from beltdyn.results.resolution import FORCE_LIMIT, Resolution

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account that passes without a warning."""


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


def _unresolved(resolution: Resolution, drive: Drive) -> Iterator[str]:
    """Say what the mesh does not resolve, and which one would."""
    unresolved = [pulley.name for number, pulley in enumerate(drive.pulleys) if not resolution.resolves(number)]
    worst = max((error for error in resolution.force_errors if math.isfinite(error)), default=math.nan)
    said = []
    if unresolved:
        ripple = f" (they ripple by {worst:.0%} of their mean)" if worst > FORCE_LIMIT else ""
        said.append(f"the contact forces along {' and '.join(unresolved)}{ripple}")
    if not resolution.resolves_tension:
        said.append(f"the tension (up to {resolution.tension_error:.0%} too high)")
    if said:
        yield (
            f"the mesh does not resolve {', and '.join(said)}. Speeds converge earlier. "
            f"Set belt.elements = {resolution.elements} or more, in place of {drive.belt.elements}."
        )
