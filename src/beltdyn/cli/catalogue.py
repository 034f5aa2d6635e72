"""`beltdyn catalogue`."""

from pathlib import Path
from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_table

if TYPE_CHECKING:
    from beltdyn.model import Entry


def catalogue(*, file: Path | None = None) -> None:
    """List the belts of the catalogue, and where their values come from.

    Parameters
    ----------
    file
        A catalogue of your own, TOML, over that of the package.
    """
    from beltdyn.errors import ModelError
    from beltdyn.model import read_catalogue

    try:
        entries = read_catalogue(file)
    except ValueError as error:
        raise ModelError(f"{str(error).rstrip('.')}.") from None
    headings = ("profile", "width mm", "thickness mm", "EA N", "EI N·m²", "kg/m", "groove")
    show_table("Catalogue", headings, [_row(name, entry) for name, entry in entries.items()])
    for name, entry in entries.items():
        generic = " Generic values." if entry.generic else ""
        show(f"\n{name}: {entry.title}.{generic}\n  {entry.source}")


def _row(name: str, entry: "Entry") -> tuple[str, ...]:
    from math import degrees

    of = " each" if entry.sold_by == "ribs" else ""
    return (
        name,
        f"{1e3 * entry.width:.3g}{of}",
        f"{1e3 * entry.thickness:.3g}",
        f"{entry.axial_stiffness:.6g}",
        f"{entry.bending_stiffness:.3g}",
        f"{entry.mass_per_length:.3g}",
        "flat" if entry.wedge_angle is None else f"{degrees(entry.wedge_angle):.3g}°",
    )
