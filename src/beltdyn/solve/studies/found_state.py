"""A drive in steady running, or at rest, and its results by name, modes among them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.solve.modes import modes_about
from beltdyn.solve.rest.installation import looked_at
from beltdyn.solve.rest.staying import Standing, stand_like
from beltdyn.solve.steady import steady_on_mesh
from beltdyn.solve.steady_running.operating_points import labels_of
from beltdyn.solve.studies.named_results import OF_MODES, values_of
from beltdyn.solve.vibration.small_motions import SmallMotions, about_standing, about_steady

if TYPE_CHECKING:
    import xarray as xr

_MODES = 12
"""How many modes are looked for at first."""
_MOST_MODES = 200
_SPAN = 0.4
"""Share of a span in the kinetic energy of a mode with which it swings most; of two spans alike each has half."""


class FoundState(ABC):
    """A drive in a state that stays."""

    @property
    @abstractmethod
    def drive(self) -> Drive:
        """The drive."""

    @property
    @abstractmethod
    def values(self) -> Mapping[str, float]:
        """Its scalar results by name, but for those of modes."""

    @property
    @abstractmethod
    def motions(self) -> SmallMotions:
        """Small motions about it."""

    @abstractmethod
    def neighbour(self, drive: Drive) -> "FoundState":
        """The state of a drive that differs a little, on the same mesh.

        Parameters
        ----------
        drive
            The other drive.

        Raises
        ------
        ConvergenceError
            If it is not found from this one.
        """

    def value(self, name: str) -> float:
        """A result by its name; NaN where there is no such value.

        Parameters
        ----------
        name
            Such as "hub_load[driven]", or "frequency[a-b]" of a span.
        """
        variable, _, label = name.removesuffix("]").partition("[")
        if variable in OF_MODES:
            return self._of_span(label)[list(OF_MODES).index(variable)]
        return float(self.values.get(name, np.nan))

    def modes_up_to(self, frequency: float) -> tuple[FloatArray, list[str]]:
        """Frequencies (Hz) and kinds of its modes, at least up to a frequency if there are so many."""
        count = _MODES
        while True:
            found = self._modes(count)
            frequencies, kinds = found["frequency"].values, [str(kind) for kind in found["kind"].values]
            if frequencies.max() > frequency or frequencies.size < count or count >= _MOST_MODES:
                return frequencies, kinds
            count *= 2

    def _of_span(self, span: str) -> tuple[float, float]:
        """Frequency and damping ratio of the lowest mode in which a span swings most."""
        count = _MODES
        while True:
            found = self._modes(count)
            swings = np.flatnonzero(found["span_share"].sel(span=span).values >= _SPAN)
            if swings.size:
                mode = found.isel(mode=swings[int(np.argmin(found["frequency"].values[swings]))])
                return float(mode["frequency"]), float(mode["damping_ratio"])
            if found.sizes["mode"] < count or count >= _MOST_MODES:
                return np.nan, np.nan
            count *= 2

    def _modes(self, count: int) -> "xr.Dataset":
        if count not in self._known:
            self._known[count] = modes_about(self.motions, count).dataset
        return self._known[count]

    @cached_property
    def _known(self) -> "dict[int, xr.Dataset]":
        return {}


class Running(FoundState):
    """A drive in steady running.

    Parameters
    ----------
    run
        From `steady_state`.
    """

    def __init__(self, run: Run) -> None:
        self.run = run

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.run.drive

    @cached_property
    def values(self) -> Mapping[str, float]:
        """Its scalar results by name, but for those of modes."""
        return values_of(self.run)

    @cached_property
    def motions(self) -> SmallMotions:
        """Small motions about it."""
        return about_steady(self.run)

    def neighbour(self, drive: Drive) -> FoundState:
        """The steady running of a drive that differs a little, on the same mesh."""
        return Running(steady_on_mesh(drive, self.run))


class Resting(FoundState):
    """A drive at rest, with a belt that slid into its place.

    Parameters
    ----------
    rest
        From `bring_to_stand`.
    """

    def __init__(self, rest: Standing) -> None:
        self.rest = rest

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.rest.drive

    @cached_property
    def values(self) -> Mapping[str, float]:
        """Its tensions, hub loads and tensioners by name."""
        rest, labels = self.rest, labels_of(self.rest.drive)
        there = looked_at(rest.drive, rest.system, rest.state).installation
        found = {
            "span_tension": ("span", there.span_tensions),
            "hub_load": ("pulley", np.linalg.norm(there.hub_loads, axis=1)),
            "wrap_angle": ("pulley", there.path.wrap_angles),
            "tensioner_position": ("tensioner", there.tensioner_positions),
        }
        named = {
            f"{name}[{label}]": float(value)
            for name, (of, values) in found.items()
            for label, value in zip(labels[of], values, strict=True)
        }
        return named | {"largest_tension": float(there.span_tensions.max())}

    @cached_property
    def motions(self) -> SmallMotions:
        """Small motions about it, with a belt that sticks to its pulleys."""
        return about_standing(self.rest)

    def neighbour(self, drive: Drive) -> FoundState:
        """The rest of a drive that differs a little, on the same mesh."""
        return Resting(stand_like(drive, self.rest))
