"""What a drive file is told of the number that a law of contact or the surface of a pulley takes."""

from typing import NamedTuple


class Parameter(NamedTuple):
    """A number of a law or of a surface, as a key of a drive file.

    It is required where what it belongs to is chosen, unless it has a default or a drive finds it, and refused
    elsewhere.
    """

    name: str
    """The key, and the name of the field in the record of the law."""
    unit: str
    """SI unit as a user writes it, "kg/(m*s)"; empty for a ratio."""
    meaning: str
    """What it is, in words that go before its unit."""
    above: float | None = 0.0
    """What it must be larger than; None where it may be any number."""
    default: float | None = None
    """What it is where it is not given."""
    found: bool = False
    """Whether a drive finds it where it is not given."""
