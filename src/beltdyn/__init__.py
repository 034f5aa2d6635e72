"""Dynamics of belt drives with large-deformation belt elements, contact and creep.

The public names are listed in ``__init__.pyi`` and in ``analyses.py``, and imported when they are first used, so that
the command line answers at once.
"""

from typing import Any

import lazy_loader

from beltdyn.analyses import ANALYSES as _ANALYSES

__version__ = "0.1.0"

_load, _names, _listed = lazy_loader.attach_stub(__name__, __file__)
__all__ = sorted({*_listed, *_ANALYSES})


def __getattr__(name: str) -> Any:
    return _ANALYSES[name].function if name in _ANALYSES else _load(name)


def __dir__() -> list[str]:
    return sorted({*_names(), *_ANALYSES})
