"""The static example of the paper (Figs. 4 and 5): the belt released from its two pulleys."""

from typing import Literal

import numpy as np

from beltdyn.model import Belt
from beltdyn.state.static import Equilibrium, find_equilibrium
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.state import State, laid
from validation.published.cases import two_pulley


def released_belt(elements: int = 10) -> Belt:
    """The belt of the static example: that of Table 1, with a length of 1.276 m.

    Parameters
    ----------
    elements
        Number of belt elements; the paper uses 10.
    """
    return two_pulley(elements).belt.replace(length=1.276)


def on_pulleys(system: System) -> State:
    """The belt laid on the paths of its two pulleys (Fig. 4), at rest.

    Parameters
    ----------
    system
        The closed belt.
    """
    return laid(system, two_pulley().path)


def release(belt: Belt, start: State, method: Literal["globalized", "newton"] = "globalized") -> Equilibrium:
    """Equilibrium of a belt without pulleys, its leftmost node fixed in x and y, its rightmost in y (Fig. 4).

    Parameters
    ----------
    belt
        The belt.
    start
        Where it is at first.
    method
        "newton" for the plain iteration of the paper.

    Returns
    -------
    Equilibrium
        The state, with all iterates.

    Raises
    ------
    ConvergenceError
        If the iteration does not end.
    """
    x = start.nodes(closed(belt))[:, 0]
    left, right = int(np.argmin(x)), int(np.argmax(x))
    system = belt_system(belt, closure="shared_node", fixed=[(left, 0), (left, 1), (right, 1)])
    return find_equilibrium(system, start, method=method)


def closed(belt: Belt) -> System:
    """The closed belt without pulleys and without supports.

    Parameters
    ----------
    belt
        The belt.
    """
    return belt_system(belt, closure="shared_node")
