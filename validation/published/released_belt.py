"""The static example of the paper (Figs. 4 and 5): the belt released from its two pulleys."""

from beltdyn.model import Drive
from validation.published.cases import two_pulley


def released_belt(elements: int = 10) -> Drive:
    """The drive whose belt is released: that of Table 1, with a belt of 1.276 m, on which no tension is left.

    Parameters
    ----------
    elements
        Number of belt elements; the paper uses 10.
    """
    drive = two_pulley(elements)
    return drive.replace(belt=drive.belt.replace(length=1.276))
