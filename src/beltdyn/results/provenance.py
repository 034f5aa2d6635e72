"""Provenance of a result: the drive, the mesh, versions and time."""

import math
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.arrays import FloatArray
from beltdyn.kinds import Registry
from beltdyn.model import ERROR_LIMITS, Drive, Prepared, Running, elements_needed, layer_lengths, mesh_errors
from beltdyn.model.simulation import Frame, element_of, unused_settings
from beltdyn.results.schema import FORMAT, Recorded

# Mesh error of a run: `beltdyn.model.resolution` with the tension and speed of the run

_FINAL_PART = 0.2
"""Last part of a run from which tension and speed for its mesh error are taken, so that the start-up counts little."""
_MOVING = frozenset({"slip", "losses"})
"""What a belt at rest has none of."""


@dataclass(frozen=True, slots=True)
class Resolution:
    """Estimated mesh error over the last fifth of a run.

    Examples
    --------
    >>> sorted(run.resolution.errors)
    ['losses', 'mean pressure', 'peak pressure', 'slip', 'tension']
    """

    errors: Mapping[str, float]
    """Relative error of each quantity, without sign: "tension", "mean pressure" and "peak pressure" of contact,
    "slip", "losses". NaN if unknown, without tension; at rest there is no slip and no loss."""
    needed: Mapping[str, int]
    """Number of elements for which twice each estimate is within its limit, `beltdyn.model.ERROR_LIMITS`; it depends
    on the drive and its tension, not on the mesh of the run. Empty without tension."""
    layers: tuple[float, float]
    """Lengths of the boundary layers of the belt at the ends of an arc, sqrt(E I alpha2 / T) and sqrt(T / k_p), m."""

    def resolves(self, quantity: str) -> bool:
        """Whether the error of a quantity is within its limit, or unknown."""
        return not self.errors[quantity] > ERROR_LIMITS[quantity]


def estimate_resolution(recorded: Recorded, prepared: Prepared) -> Resolution:
    """Estimate the mesh error of a run.

    The errors are estimated from the tension, which a coarse mesh raises; therefore the tension at rest of the drive is
    used, or that of the run if it is lower.
    """
    found = found_errors(recorded)
    if found:
        return Resolution(found, {}, layer_lengths(prepared, float(np.mean(_last(recorded, "span_tension", "time")))))
    speeds = _last(recorded, "belt_speed", "time")
    square = float(np.mean(speeds[np.isfinite(speeds)] ** 2)) if np.any(np.isfinite(speeds)) else 0.0
    return mesh_resolution(prepared, float(np.mean(_last(recorded, "belt_tension", "field_time"))), square)


def mesh_error_attribute(quantity: str) -> str:
    """Name of the attribute of results that tells the error of a quantity which an analysis has found."""
    return f"mesh_error_{quantity.replace(' ', '_')}"


def found_errors(recorded: Recorded) -> dict[str, float]:
    """Errors that an analysis has found by a finer mesh; empty without them."""
    marked = {name: mesh_error_attribute(name) for name in ERROR_LIMITS}
    known = {name: np.asarray(recorded.attrs[mark]).item() for name, mark in marked.items() if mark in recorded.attrs}
    return dict.fromkeys(ERROR_LIMITS, math.nan) | known if known else {}


def mesh_resolution(prepared: Prepared, tension: float, square: float) -> Resolution:
    """Estimate the mesh error at a tension and speed of the belt."""
    tension = min(tension, prepared.installation.tension)
    running = Running(tension, prepared.belt.mass_per_length * square)
    if not running.tension > running.lifted:
        return Resolution(dict.fromkeys(ERROR_LIMITS, math.nan), {}, (math.nan, math.nan))
    still = _MOVING if square == 0.0 else frozenset[str]()
    errors = {
        name: math.nan if name in still else error
        for name, error in mesh_errors(prepared, running, prepared.elements).items()
    }
    return Resolution(errors, elements_needed(prepared, running), layer_lengths(prepared, tension))


def _last(recorded: Recorded, name: str, clock: str) -> FloatArray:
    """Values of a variable over the last fifth of the run."""
    time = np.asarray(recorded[clock])
    first = int(np.searchsorted(time, time[-1] - _FINAL_PART * (time[-1] - time[0])))
    return np.asarray(recorded[name][first:])


_PACKAGES = ("beltdyn", "numba", "numpy", "scipy")
MESH = ("mesh_frame", "mesh_frame_reason", "mesh_element", "mesh_elements", "mesh_unused")
"""Attributes of the mesh in results."""
STAYING = Frame("staying", "as in all analyses at rest or in steady running")
"""The mesh of these, whatever the drive asks for in runs."""


def provenance(drive_text: str, title: str, kind: str = RUN) -> dict[str, str]:
    """Global attributes known before the computation."""
    return {
        "title": title,
        "kind": kind,
        "drive": drive_text,
        "format": ".".join(map(str, FORMAT)),
        **_versions(),
        "python_version": platform.python_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
    }


_OWN_KINDS = "own_kinds"
"""Attribute of the kinds of a drive from outside the package: family, name and module, a line each."""


def own_kinds(drive: Drive) -> dict[str, str]:
    """Attribute of the kinds of a drive from outside the package; none without any."""
    lines = [f"{kind.kinds.family}\t{kind.name}\t{kind.origin}" for kind in drive.own_kinds]
    return {_OWN_KINDS: "\n".join(dict.fromkeys(lines))} if lines else {}


def unknown_kinds(attributes: Mapping[str, Any]) -> list[str]:
    """Kinds of a result that are not registered here, in words, with the modules that register them."""
    families = {registry.family: registry for registry in Registry.families}
    lines = [line.split("\t") for line in str(attributes.get(_OWN_KINDS, "")).splitlines()]
    return [
        f'{family} "{name}" of {"a script" if origin == "__main__" else f"the module {origin}"}'
        for family, name, origin in lines
        if name not in families.get(family, {})
    ]


@cache
def _versions() -> dict[str, str]:
    """Of the packages that results depend on; finding them takes milliseconds."""
    return {f"{package}_version": version(package) for package in _PACKAGES}


def mesh_used(drive: Drive, frame: Frame, elements: int | None = None) -> dict[str, Any]:
    """Attributes of the mesh of an analysis, and the settings of the drive that it does not use."""
    element = element_of(drive.belt, frame)
    unused = unused_settings(drive.belt, drive.contact) if frame.stays else []
    known = {} if elements is None else {"mesh_elements": elements}
    values = (*frame, element, ", ".join(unused))
    names = (name for name in MESH if name != "mesh_elements")
    return dict(zip(names, values, strict=True)) | known


def mesh_facts(attributes: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The mesh of a result for a sheet; empty if unknown."""
    if "mesh_frame" not in attributes:
        return []
    count = f"{np.asarray(attributes['mesh_elements']).item()} " if "mesh_elements" in attributes else ""
    words = Frame(attributes["mesh_frame"], str(attributes["mesh_frame_reason"])).words
    facts = [("mesh", f"{count}{attributes['mesh_element']} elements, {words}")]
    unused = str(attributes["mesh_unused"])
    return [*facts, *([("not used", f"{unused} (only for a travelling mesh)")] if unused else [])]
