"""Dynamics of belt drives with large-deformation belt elements, contact and creep.

The public names are listed in ``__init__.pyi`` and in ``analyses.py``, and imported when they are first used, so that
the command line answers at once.
"""

from pathlib import Path as _Path
from typing import Any

from beltdyn.analyses import ANALYSES as _ANALYSES
from beltdyn.lazy import LazyNames as _LazyNames

__version__ = "0.1.0"

_listed = _LazyNames(__name__, _Path(__file__).with_suffix(".pyi"))
__all__ = sorted({*_listed, *_ANALYSES})


def __getattr__(name: str) -> Any:
    if name in _ANALYSES:
        return _ANALYSES[name].function
    if name not in _listed:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = _listed[name]
    return found


def __dir__() -> list[str]:
    return sorted({*__all__, *_ANALYSES})
