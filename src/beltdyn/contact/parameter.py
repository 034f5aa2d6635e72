"""What a drive file is told of the number that a law of contact takes."""

from typing import NamedTuple


class Parameter(NamedTuple):
    """A number of a law, as a key of the group ``[contact]`` of a drive file.

    It is required where its law is chosen, and refused elsewhere.
    """

    name: str
    """The key, and the name of the field in the record of the law."""
    unit: str
    """SI unit as a user writes it, "kg/(m*s)"; empty for a ratio."""
    meaning: str
    """What it is, in words that go before its unit."""
    above: float = 0.0
    """What it must be larger than."""
