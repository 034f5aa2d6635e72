"""Temporary settings of Numba."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numba


@contextmanager
def setting(name: str, value: Any) -> Iterator[None]:
    """Change a setting of Numba temporarily; other packages keep theirs.

    Parameters
    ----------
    name
        Its name in `numba.config`.
    value
        What it is meanwhile.
    """
    before = getattr(numba.config, name)
    setattr(numba.config, name, value)
    try:
        yield
    finally:
        setattr(numba.config, name, before)
