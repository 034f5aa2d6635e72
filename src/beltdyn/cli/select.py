"""`beltdyn select`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_table
from beltdyn.cli.new import refuse_existing, write_text

if TYPE_CHECKING:
    from beltdyn.designs.selection import Proposal

_HEADINGS = (
    "profile",
    "belts, ribs\nor teeth",
    "driver\nmm",
    "driven\nmm",
    "length\nmm",
    "center\nmm",
    "driven\nrpm",
    "belt\nm/s",
    "rated\nkW",
    "used",
    "tension\nN",
    "hub load\nN",
    "span\nHz",
    "width\nmm",
)


def select(
    *,
    power: str,
    speed: str,
    driven_speed: str,
    service_factor: float = 1.0,
    distance: str | None = None,
    largest_driver: str | None = None,
    largest_driven: str | None = None,
    profiles: str | None = None,
    ratio_tolerance: float = 0.03,
    most_belts: int = 12,
    toothed: Annotated[bool, Parameter(negative="")] = False,
    count: int = 5,
    file: Path | None = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Select V-belt, V-ribbed or toothed drives for a power, best first, each as a drive file.

    Parameters
    ----------
    power
        The power to transmit, such as "7.5 kW".
    speed
        The speed of the driver, such as "1450 rpm".
    driven_speed
        The speed of the driven pulley.
    service_factor
        Design power over power.
    distance
        The range of the center distance, such as "400..600 mm"; by default 0.7 to 2 times the sum of the diameters.
    largest_driver
        The largest diameter of the driver, such as "200 mm".
    largest_driven
        The largest diameter of the driven pulley.
    profiles
        Names of profiles with commas between; by default all V- and V-ribbed belts with a rating.
    ratio_tolerance
        The largest deviation of the speed ratio, relative.
    most_belts
        The most V-belts side by side; V-ribbed belts may have four times as many ribs.
    toothed
        Choose among toothed belts, if no profiles are named.
    count
        The number of proposals, at most two of a profile.
    file
        Your own catalogue, a TOML file that extends the one of the package.
    output
        The folder for the drive files, by default the working directory; existing files are not replaced.
    """
    from beltdyn.designs.selection import select as selected

    found = selected(
        power=power,
        speed=speed,
        driven_speed=driven_speed,
        service_factor=service_factor,
        distance=distance,
        largest_driver=largest_driver,
        largest_driven=largest_driven,
        profiles=profiles,
        ratio_tolerance=ratio_tolerance,
        most_belts=most_belts,
        toothed=toothed,
        count=count,
        catalogue=None if file is None else file.resolve(),
    )
    files = [
        (output or Path()) / f"select-{number}-{one.profile.replace(' ', '-')}.toml"
        for number, one in enumerate(found, 1)
    ]
    for target in files:
        refuse_existing(target)
    for target, one in zip(files, found, strict=True):
        write_text(target, one.text)
    show_table("Drives, the narrowest first", _HEADINGS, [_row(one) for one in found])
    show()
    show("\n".join(f"Written: {target}" for target in files))
    show(f"Next: beltdyn check {files[0]}; beltdyn rating {files[0]}")


def _row(one: "Proposal") -> tuple[str, ...]:
    """A proposal in the table."""
    from beltdyn.parts.quantity import RPM

    return (
        one.profile,
        f"{one.belts}" if one.teeth is None else f"z {' '.join(map(str, one.teeth))}",
        *(f"{1e3 * value:.5g}" for value in (one.driver_diameter, one.driven_diameter, one.nominal_length)),
        f"{1e3 * one.distance:.4g}",
        f"{RPM * one.driven_speed:.4g}",
        f"{one.belt_speed:.3g}",
        f"{1e-3 * one.rated_power:.3g}",
        f"{one.utilization:.0%}",
        *(f"{value:.4g}" for value in (one.tension, one.hub_load)),
        f"{one.frequency:.3g}",
        f"{1e3 * one.face_width:.4g}",
    )
