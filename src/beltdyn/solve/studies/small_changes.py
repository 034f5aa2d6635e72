"""Drives with one number changed a little, which keep the installed tension that was asked for."""

import numpy as np

from beltdyn.model import Drive
from beltdyn.model.completion import take_up
from beltdyn.solve.rest.staying import Standing, stand_like

CHANGE = 1e-5
"""Of a number, and of the length of the belt, relative."""


class SmallChanges:
    """Makes neighbours of a drive; where a tension at rest is asked for, the belt's length, or the take-up, follows.

    Parameters
    ----------
    given
        The drive, with constant speeds and torques.
    rest
        It at rest, with the length, or the take-up, that its installed tension asks for.
    """

    def __init__(self, given: Drive, rest: Standing) -> None:
        self._given, self._rest = given, rest
        self._tightening = np.inf
        if given.belt.installed_tension is not None:
            change = CHANGE * rest.drive.belt_length
            shorter, longer = (self._tension(self._shortened(rest.drive, sense * change)) for sense in (1.0, -1.0))
            self._tightening = (shorter - longer) / (2.0 * change)

    def drive(self, path: str, value: float) -> Drive:
        """The drive with another value of a number.

        Parameters
        ----------
        path
            Of the number.
        value
            Near to that which the drive has.

        Raises
        ------
        ModelError
            If there is no such drive.
        ConvergenceError
            If no static equilibrium is found.
        """
        wanted, drive = self._rest.tension, self._rest.drive
        if path == "belt.installed_tension":
            wanted *= value / float(self._given.belt.installed_tension or value)
        else:
            drive = drive.with_({path: value})
        if np.isfinite(self._tightening):
            drive = self._shortened(drive, (wanted - self._tension(drive)) / self._tightening)
        return drive

    def _shortened(self, drive: Drive, distance: float) -> Drive:
        """A drive with a shorter belt or, where its length is given, with more take-up, m; see `Drive.tightened`."""
        if self._given.belt.length is None:
            return drive.with_({"belt.length": drive.belt_length - distance})
        return drive.replace(tensioner=take_up(drive.completed, distance))

    def _tension(self, drive: Drive) -> float:
        """At rest, on the same mesh."""
        return stand_like(drive, self._rest).tension
