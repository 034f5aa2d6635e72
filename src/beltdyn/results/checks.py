"""What makes a result doubtful, said with numbers and a remedy."""

import math
from collections.abc import Iterator

import xarray as xr

from beltdyn.model import Drive
from beltdyn.results.resolution import FORCE_LIMIT, estimate_resolution

CLOSURE_LIMIT = 0.01
"""Largest closure error of the energy account that passes without a warning."""


def find_warnings(dataset: xr.Dataset, drive: Drive) -> list[str]:
    """Look for what makes a result doubtful.

    Parameters
    ----------
    dataset : xarray.Dataset
        The results.
    drive : Drive
        The drive.

    Returns
    -------
    list of str
        One sentence or two for each finding.
    """
    if dataset.sizes["time"] == 0:
        return ["nothing was recorded: the run ended before its first output."]
    return [
        *_unfinished(dataset, drive),
        *_open_energy_account(dataset, drive),
        *_slack_spans(dataset),
        *_unresolved(dataset, drive),
    ]


def _unfinished(dataset: xr.Dataset, drive: Drive) -> Iterator[str]:
    status = dataset.attrs["status"]
    if status != "completed":
        end = float(dataset["time"][-1])
        ended = {"interrupted": "was interrupted", "failed": "failed"}.get(status, "goes on, or was killed")
        yield f"the run {ended}: results end at t = {end:.6g} s of {drive.simulation.duration:.6g} s."


def _open_energy_account(dataset: xr.Dataset, drive: Drive) -> Iterator[str]:
    closure = float(dataset["energy_closure"][-1])
    if abs(closure) > CLOSURE_LIMIT:
        yield (
            f"the energy account is open by {closure:.2%} of the energy put in, more than {CLOSURE_LIMIT:.0%}. "
            f"Reduce simulation.rtol = {drive.simulation.rtol:g}."
        )


def _slack_spans(dataset: xr.Dataset) -> Iterator[str]:
    for name in dataset["span"].values:
        tension = dataset["span_tension"].sel(span=name)
        lowest = float(tension.min())
        if lowest <= 0.0:
            time = float(tension["time"][int(tension.values.argmin())])
            yield (
                f"the span {name} is slack: its tension falls to {lowest:.4g} N at t = {time:.4g} s. "
                "Shorten the belt, or reduce the load."
            )


def _unresolved(dataset: xr.Dataset, drive: Drive) -> Iterator[str]:
    """Say what the mesh does not resolve, and which one would."""
    resolution = estimate_resolution(dataset, drive)
    names = [pulley.name for number, pulley in enumerate(drive.pulleys) if not resolution.resolves(number)]
    worst = max((error for error in resolution.force_errors if math.isfinite(error)), default=math.nan)
    said = []
    if names:
        ripple = f" (they ripple by {worst:.0%} of their mean)" if worst > FORCE_LIMIT else ""
        said.append(f"the contact forces along {' and '.join(names)}{ripple}")
    if not resolution.resolves_tension:
        said.append(f"the tension (about {resolution.tension_error:.0%} too high)")
    if said:
        yield (
            f"the mesh does not resolve {', and '.join(said)}. Speeds converge earlier. "
            f"Set belt.elements = {resolution.elements} or more, in place of {drive.belt.elements}."
        )
