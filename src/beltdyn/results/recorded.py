"""What was recorded, by name: an xarray dataset, or a result file without the time that xarray takes to load."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr


class Recorded(Protocol):
    """Variables by name, each an array with one row for each output, and global attributes."""

    @property
    def attrs(self) -> Mapping[Any, Any]:
        """Global attributes."""

    def __contains__(self, name: object, /) -> bool:
        """Whether a variable was recorded."""

    def __getitem__(self, name: str, /) -> Any:
        """A variable, which is read where it is indexed."""


class InMemory:
    """Variables of a dataset as plain arrays, which are quicker to look at than labelled ones.

    Parameters
    ----------
    dataset : xarray.Dataset
    """

    def __init__(self, dataset: "xr.Dataset") -> None:
        self._variables = dataset.variables
        self.attrs: Mapping[Any, Any] = dataset.attrs

    def __contains__(self, name: object, /) -> bool:
        """Whether a variable was recorded."""
        return name in self._variables

    def __getitem__(self, name: str, /) -> NDArray[Any]:
        """The values of a variable."""
        return np.asarray(self._variables[name].values)


def names(recorded: Recorded, dimension: str) -> list[str]:
    """Names along a dimension.

    Parameters
    ----------
    recorded : Recorded
        What was recorded.
    dimension : str
        "pulley", "span" or "tensioner".

    Returns
    -------
    list of str
        In order.
    """
    return [name.decode() if isinstance(name, bytes) else str(name) for name in np.asarray(recorded[dimension])]


def runs_steadily(recorded: Recorded) -> bool:
    """Whether it is steady running, in which nothing changes over time, in place of a run.

    Parameters
    ----------
    recorded : Recorded
        What was recorded.
    """
    return "belt_parameter" in recorded.attrs


def attribute(recorded: Recorded, name: str, unknown: float) -> float:
    """Give an attribute that is a number.

    Parameters
    ----------
    recorded : Recorded
        What was recorded.
    name : str
        Name of the attribute.
    unknown : float
        What to give where it is missing.
    """
    return float(np.squeeze(recorded.attrs.get(name, unknown)))  # a file holds arrays of one number
