"""Types of arrays, for annotations."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
"""Numbers in double precision."""

IntArray = NDArray[np.integer[Any]]
"""Whole numbers: counts, indices, kinds."""

BoolArray = NDArray[np.bool_]
"""Yes or no, one by one."""

ComplexArray = NDArray[np.complex128]
"""Complex numbers in double precision."""
