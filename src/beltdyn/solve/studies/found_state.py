"""A drive in steady running, or at rest, and its results by name, modes among them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.solve.rest.installation import looked_at
from beltdyn.solve.rest.staying import Standing, stand_like
from beltdyn.solve.steady import Beside, require_found, steady_beside, tangent_of
from beltdyn.solve.steady_running.newton import SteadyWork
from beltdyn.solve.steady_running.point_values import labels_of
from beltdyn.solve.studies.named_results import MODES, OF_MODES, name_of, values_of, variable_and_label
from beltdyn.solve.studies.state_modes import FollowedModes, FoundModes, Mode, StateModes
from beltdyn.solve.vibration.small_motions import SmallMotions, about_standing, about_steady

_MOST_MODES = 200
_SPAN = 0.4
"""Share of a span in the kinetic energy of a mode with which it swings most; of two spans alike each has half."""


class FoundState(ABC):
    """A drive in a state that stays.

    Parameters
    ----------
    near
        The state from whose neighbourhood it is, where it was found as a `neighbour`: its modes are followed from
        there.
    """

    def __init__(self, near: "FoundState | None") -> None:
        self._near = near

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
            Such as "hub_load[driven]", "frequency[a-b]" of a span, or "mode_frequency[2]".
        """
        variable, label = variable_and_label(name)
        if variable not in OF_MODES:
            return float(self.values.get(name, np.nan))
        mode = self._mode_of(variable, label)
        if mode is None:
            return np.nan
        return mode.frequency if variable.endswith("frequency") else mode.damping_ratio

    def shared_modes(self, names: Sequence[str]) -> list[str]:
        """Names of results of modes that share their eigenvalue with others, so that their derivatives are means.

        Parameters
        ----------
        names
            Of results.
        """
        found = list[str]()
        for name in names:
            variable, label = variable_and_label(name)
            mode = self._mode_of(variable, label) if variable in OF_MODES else None
            if mode is not None and mode.alike > 1:
                found.append(name)
        return found

    def modes_up_to(self, frequency: float) -> tuple[FloatArray, list[str]]:
        """Frequencies (Hz) and kinds of its modes, at least up to a frequency if there are so many."""
        count = MODES
        while True:
            found = self._first(count)
            if max(mode.frequency for mode in found) > frequency or len(found) < count or count >= _MOST_MODES:
                return np.array([mode.frequency for mode in found]), [mode.kind for mode in found]
            count *= 2

    def _mode_of(self, variable: str, label: str) -> Mode | None:
        """The mode of which a variable of `OF_MODES` is; that of a neighbour is chosen where it is followed from."""
        near = self._near if isinstance(self._modes, FollowedModes) else None
        chosen = (near or self)._chosen_mode(variable, label)
        return None if chosen is None else self._modes.like(chosen)

    def _chosen_mode(self, variable: str, label: str) -> Mode | None:
        if OF_MODES[variable].dims == ("span",):
            return self._mode_of_span(label)
        number = int(label)
        return next((mode for mode in self._first(MODES) if mode.number == number), None)

    def _mode_of_span(self, span: str) -> Mode | None:
        """The lowest mode in which a span swings most."""
        place, count = labels_of(self.drive)["span"].index(span), MODES
        while True:
            found = self._first(count)
            swings = [mode for mode in found if mode.span_share[place] >= _SPAN]
            if swings:
                return min(swings, key=lambda mode: mode.frequency)
            if len(found) < count or count >= _MOST_MODES:
                return None
            count *= 2

    def _first(self, count: int) -> list[Mode]:
        return self._modes.first(count)

    @cached_property
    def _modes(self) -> StateModes:
        base = None if self._near is None else self._near._modes
        return FollowedModes(base, self.motions) if isinstance(base, FoundModes) else FoundModes(self.motions)


class Running(FoundState):
    """A drive in steady running.

    Parameters
    ----------
    run
        From `steady_state`.
    near
        As for `FoundState`.
    bands
        Whether its neighbours are to have the bands in which dry friction holds tensioners, as for `steady_from`.
    """

    def __init__(self, run: Run, near: FoundState | None = None, *, bands: bool = False) -> None:
        super().__init__(near)
        self.run, self._bands = run, bands

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
        return self.of(self.beside(drive), self)

    def beside(self, drive: Drive) -> Beside:
        """What `neighbour` finds, by the tangent of this state."""
        return require_found(steady_beside(drive, self.run, tangent=self._tangent))

    @cached_property
    def _tangent(self) -> SteadyWork:
        return tangent_of(self.run)

    def of(self, found: Beside, near: FoundState | None) -> "Running":
        """Another state that was found on the same mesh; parameters as for this one."""
        return Running(found.run(bands=self._bands), near, bands=self._bands)


class Resting(FoundState):
    """A drive at rest, with a belt that slid into its place.

    Parameters
    ----------
    rest
        From `bring_to_stand`.
    near
        As for `FoundState`.
    """

    def __init__(self, rest: Standing, near: FoundState | None = None) -> None:
        super().__init__(near)
        self.rest = rest

    @property
    def drive(self) -> Drive:
        """The drive."""
        return self.rest.drive

    @cached_property
    def values(self) -> Mapping[str, float]:
        """Its belt's length, tensions, hub loads, wrap angles and tensioners by name."""
        rest, labels = self.rest, labels_of(self.rest.drive)
        there = looked_at(rest.drive, rest.system, rest.state).installation
        found = {
            "span_tension": ("span", there.span_tensions),
            "hub_load": ("pulley", np.linalg.norm(there.hub_loads, axis=1)),
            "wrap_angle": ("pulley", there.path.wrap_angles),
            "tensioner_position": ("tensioner", there.tensioner_positions),
        }
        named = {
            name_of(name, label): float(value)
            for name, (of, values) in found.items()
            for label, value in zip(labels[of], values, strict=True)
        }
        whole = {
            "belt_length": self.drive.belt_length,
            "tension": rest.tension,
            "largest_tension": float(there.span_tensions.max()),
        }
        return named | whole

    @cached_property
    def motions(self) -> SmallMotions:
        """Small motions about it, with a belt that sticks to its pulleys."""
        return about_standing(self.rest)

    def neighbour(self, drive: Drive) -> FoundState:
        """The rest of a drive that differs a little, on the same mesh."""
        return Resting(stand_like(drive, self.rest), self)
