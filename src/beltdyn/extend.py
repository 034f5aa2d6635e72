"""What a script or a module needs to add kinds of its own: laws, surfaces, elements, machines, integrators, analyses.

A kind that `register` has added is known to drive files, to all analyses of this process, and to the worker processes
of studies and batches if its module can be imported there.

The names are listed in ``extend.pyi`` and imported where they are used, so that files of the package use them too.
"""

from pathlib import Path as _Path
from typing import Any

from beltdyn.lazy import LazyNames as _LazyNames

_listed = _LazyNames("beltdyn", _Path(__file__).with_suffix(".pyi"))
__all__ = list(_listed)


def __getattr__(name: str) -> Any:
    if name not in _listed:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _listed[name]
