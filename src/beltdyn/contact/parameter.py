"""A parameter of a contact law or pulley surface."""

from typing import NamedTuple


class Parameter(NamedTuple):
    """A parameter of a contact law or pulley surface, as a key of a drive file.

    It is required where what it belongs to is chosen, unless it has a default or a drive finds it, and refused
    elsewhere.
    """

    name: str
    """The key, and the name of the field in the record of the law."""
    unit: str
    """SI unit as a user writes it, "kg/(m*s)"; empty for a ratio."""
    meaning: str
    """Its description, before the unit."""
    above: float | None = 0.0
    """Its lower bound; None for any number."""
    default: float | None = None
    """Its default."""
    found: bool = False
    """Whether a drive chooses its default."""
