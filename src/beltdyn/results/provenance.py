"""Provenance of a result: the drive, the mesh, versions and time."""

import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.elements import ANCF, QUINTIC
from beltdyn.model import Drive
from beltdyn.model.frame import Frame, unused_settings
from beltdyn.results.schema import FORMAT

_PACKAGES = ("beltdyn", "numba", "numpy", "scipy")
MESH = ("mesh_frame", "mesh_frame_reason", "mesh_element", "mesh_elements", "mesh_unused")
"""Attributes of results that tell of the mesh."""
STAYING = Frame("staying", "as all analyses about rest or steady running")
"""The mesh of these, whatever the drive asks for in runs."""


def provenance(drive_text: str, title: str, kind: str = RUN) -> dict[str, str]:
    """Global attributes known before the computation.

    Parameters
    ----------
    drive_text : str
        The drive file's text.
    title : str
        What the dataset is, in a few words.
    kind : str
        Name of the analysis; "run" where results grow over time.

    Returns
    -------
    dict
        ``title``, ``kind``, ``drive``, ``format`` (version of the result file), ``beltdyn_version``, ``numba_version``,
        ``numpy_version``, ``scipy_version``, ``python_version`` and ``created`` (ISO 8601, UTC).
    """
    return {
        "title": title,
        "kind": kind,
        "drive": drive_text,
        "format": ".".join(map(str, FORMAT)),
        **_versions(),
        "python_version": platform.python_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
    }


@cache
def _versions() -> dict[str, str]:
    """Of the packages that results depend on; finding them takes milliseconds."""
    return {f"{package}_version": version(package) for package in _PACKAGES}


def mesh_used(drive: Drive, frame: Frame, elements: int | None = None) -> dict[str, Any]:
    """Attributes of the mesh of an analysis, and the settings of the drive that it does not use.

    Parameters
    ----------
    drive : Drive
        The drive.
    frame : Frame
        The mesh, and why.
    elements : int, optional
        Number of its elements, where there is one mesh.
    """
    element = QUINTIC.name if frame.stays else drive.belt.discretization or ANCF.name
    unused = unused_settings(drive.belt, drive.contact) if frame.stays else []
    known = {} if elements is None else {"mesh_elements": elements}
    values = (*frame, element, ", ".join(unused))
    names = (name for name in MESH if name != "mesh_elements")
    return dict(zip(names, values, strict=True)) | known


def mesh_facts(attributes: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The mesh of a result for a sheet; empty if unknown.

    Parameters
    ----------
    attributes : mapping
        Of a dataset or its file.
    """
    if "mesh_frame" not in attributes:
        return []
    count = f"{np.asarray(attributes['mesh_elements']).item()} " if "mesh_elements" in attributes else ""
    words = Frame(attributes["mesh_frame"], str(attributes["mesh_frame_reason"])).words
    facts = [("mesh", f"{count}{attributes['mesh_element']} elements, {words}")]
    unused = str(attributes["mesh_unused"])
    return [*facts, *([("not used", f"{unused} (only for a travelling mesh)")] if unused else [])]
