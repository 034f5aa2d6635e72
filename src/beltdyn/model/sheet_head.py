"""The head of a sheet: for whom and for which place a drive is computed."""

from pydantic import Field

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Title


class SheetHead(Part):
    """What identifies a drive on sheets and reports; it does not affect results.

    Examples
    --------
    >>> bd.model.SheetHead(customer="Mill AG", position="K-101").entries
    (('Customer', 'Mill AG'), ('Position', 'K-101'))
    """

    customer: Title | None = Field(None, description="the customer, for sheets and reports")
    position: Title | None = Field(None, description="the position of the drive in the plant, for sheets and reports")
    order: Title | None = Field(None, description="the number of the order, for sheets and reports")

    @property
    def entries(self) -> tuple[tuple[str, str], ...]:
        """Label and text of each key that is set."""
        values = ((name, getattr(self, name)) for name in ("customer", "position", "order"))
        return tuple((name.capitalize(), text) for name, text in values if text is not None)
