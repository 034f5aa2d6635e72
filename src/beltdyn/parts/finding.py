"""What makes a drive or its results doubtful, in three sentences: what is wrong, what it spoils, what to do."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """What makes a drive or its results doubtful, each part in whole sentences.

    Attributes
    ----------
    fault : str
        What is wrong, with its value and the rule that it breaks.
    spoils : str
        Which numbers it spoils, and by how much.
    remedy : str
        What to do.
    kind : str
        Name of the check that found it, if one did.
    weight : float
        The larger, the worse among findings of its kind: of many operating points the worst speaks for all.

    Raises
    ------
    ValueError
        If a part is no sentence.

    Examples
    --------
    >>> found = bd.Finding("The belt is long.", "The slack span sags.", "Shorten it.")
    >>> print(found)
    The belt is long. The slack span sags. Shorten it.
    """

    fault: str
    spoils: str
    remedy: str
    kind: str = ""
    weight: float = 0.0

    def __post_init__(self) -> None:
        for part in (self.fault, self.spoils, self.remedy):
            if not part.endswith("."):
                raise ValueError(f"{part!r} is a part of a finding and must be a sentence. End it with a full stop.")

    def __str__(self) -> str:
        return f"{self.fault} {self.spoils} {self.remedy}"


def listing(words: Sequence[str]) -> str:
    """Write words one after the other: "a", "a and b", "a, b and c"."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
