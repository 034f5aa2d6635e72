"""The way of compilation: quick for known versions of Numba, otherwise by its public decorator."""

import os
from functools import cache
from importlib.metadata import version

PLAIN_VARIABLE = "BELTDYN_PLAIN_COMPILATION"
"""Environment variable that, if set and not empty, asks for Numba's public decorator."""

_OLDEST, _NEWEST = (0, 60), (0, 68)
"""Versions of Numba whose internals `beltdyn.kernel.quick` was tested with."""


@cache
def compiles_quickly() -> bool:
    """Whether kernels are compiled by way of Numba's internals; they are never compiled again where they are kept.

    Returns
    -------
    bool
        False for a version of Numba that is not known, or if ``$BELTDYN_PLAIN_COMPILATION`` asks for it: the first
        start then takes several times longer, and all else is the same.
    """
    if os.environ.get(PLAIN_VARIABLE):
        return False
    major, minor = version("numba").split(".")[:2]
    return _OLDEST <= (int(major), int(minor)) <= _NEWEST
