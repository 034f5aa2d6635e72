"""Dynamics of belt drives with large-deformation belt elements, contact and creep.

The public names are listed in ``__init__.pyi`` and in ``analyses.py``, and imported when they are first used, so that
the command line answers at once, and to signals before anything else is imported.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

__version__ = "0.1.0"


def __getattr__(name: str) -> "Any":
    from beltdyn.analyses import ANALYSES
    from beltdyn.lazy import public_names

    if name == "__all__":
        return sorted({*public_names(), *ANALYSES})
    if name in ANALYSES:
        return ANALYSES[name].function
    if name not in public_names():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = public_names()[name]
    return found


def __dir__() -> list[str]:
    return list(__getattr__("__all__"))
