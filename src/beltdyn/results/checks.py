"""What makes a result doubtful, said with numbers and a remedy."""

import math
from collections.abc import Iterator

import xarray as xr

from beltdyn.model import Drive
from beltdyn.model.resolution import arc_angle, arc_error, elements_needed

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
        *_coarse_elements(dataset, drive),
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


def _coarse_elements(dataset: xr.Dataset, drive: Drive) -> Iterator[str]:
    """Compare how far an element misses the circle with the penetration f_n / k_p; nodes alone do not miss it."""
    if drive.contact.sampling == "nodal":
        return
    last = dataset.isel(time=-1)
    for number, pulley in enumerate(drive.pulleys):
        force = last["normal_force"].where(last["contact_pulley"] == number)
        if not float(force.max()) > 0.0:
            continue
        penetration = float(force.mean()) / drive.contact.stiffness
        needed = elements_needed(drive.belt, pulley.radius, penetration)
        if needed > drive.belt.elements:
            angle, miss = arc_angle(drive.belt, pulley.radius), arc_error(drive.belt, pulley.radius)
            yield (
                f"contact forces on {pulley.name} are not resolved: "
                f"an element spans {math.degrees(angle):.0f} degrees and "
                f"misses the circle by {miss:.1e} m, against a penetration of {penetration:.1e} m. "
                f"Speeds converge earlier; for contact forces and tensions set belt.elements to {needed} or more."
            )
