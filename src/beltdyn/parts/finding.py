"""A problem of a drive or its results: what is wrong, what it affects, what to do."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """A problem of a drive or its results, each part in whole sentences.

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
                raise ValueError(f"{part!r} must be a sentence, as part of a finding. End it with a full stop.")

    def __str__(self) -> str:
        return f"{self.fault} {self.spoils} {self.remedy}"


def listing(words: Sequence[str]) -> str:
    """Join words: "a", "a and b", "a, b and c"."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
