"""`beltdyn catalogue`."""

from collections.abc import Iterable, Iterator
from itertools import groupby
from math import degrees, pi, sin, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show, show_facts, show_paragraphs, show_table
from beltdyn.cli.new import refuse_existing, write_text

if TYPE_CHECKING:
    from beltdyn.designs.selection import Proposal
    from beltdyn.model import Entry


_PRINTED = {
    "permanent_elongation": "{:.2g} of the length",
    "thermal_expansion": "{:.3g} 1/K",
    "least_safety": "{:.3g} in steady running",
    "least_motion_safety": "{:.3g} in starts and stops",
}
_LENGTHS = {"datum": "datum length", "effective": "effective length", "outside": "inside length"}


def catalogue(
    profile: str | None = None,
    /,
    *,
    file: Path | None = None,
    figure: Annotated[Path | None, Parameter(alias="-f")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """List the belts of the catalogue, or show one profile with all its values and their sources.

    Parameters
    ----------
    profile
        The name of a profile, such as SPB; by default all are listed.
    file
        Your own catalogue, a TOML file that extends the one of the package.
    figure
        Plot tension over strain of the profile to this file, such as stretch.png. Only figures that beltdyn wrote are
        replaced.
    force
        Also replace files that beltdyn did not write.
    """
    from beltdyn.errors import ModelError
    from beltdyn.model.catalogue import find_entry, read_catalogue

    try:
        entries = read_catalogue(file)
        entry = None if profile is None else find_entry(entries, profile)
    except LookupError as error:
        raise ModelError(f"{error.args[0]}.") from None
    except ValueError as error:
        raise ModelError(f"{str(error).rstrip('.')}.") from None
    if profile is None or entry is None:
        if figure is not None:
            raise ModelError(f"--figure {figure} needs a profile. Name one: beltdyn catalogue PK --figure {figure}.")
        _list(entries)
        return
    _show(profile, entry)
    if figure is not None:
        from beltdyn.show import plot

        drawn = plot.save_stretch(entry, figure, f"{profile}, {_size(entry)}", overwrite=force)
        show(f"\nTension over strain: {drawn}")


def _list(entries: "dict[str, Entry]") -> None:
    """List profiles, grouped by their kind."""
    headings = (
        "profile",
        "values of",
        "thickness mm",
        "EA kN",
        "EI N·m²",
        "g/m",
        "friction",
        "groove",
        "min. pulley mm",
    )
    kinds = {entry.kind: position for position, entry in reversed(list(enumerate(entries.values())))}
    ordered = sorted(entries.items(), key=lambda item: kinds[item[1].kind])
    show_table("Catalogue", headings, _rows(ordered))
    show(
        "\nThe values are generic, typical of a profile. `beltdyn catalogue SPB` shows one profile with its sources. "
        'Other classes of conveyor belts and covers are read as well, such as "EP 400/3 5+2".'
    )


def _rows(entries: "Iterable[tuple[str, Entry]]") -> Iterator[tuple[str, ...]]:
    from beltdyn.parts.messages import plain

    for kind, group in groupby(entries, key=lambda item: item[1].kind):
        yield (kind,)
        for name, entry in group:
            yield (
                f"  {name}",
                _size(entry),
                f"{1e3 * entry.thickness:.3g}",
                plain(entry.axial_stiffness / 1e3, 3),
                f"{entry.bending_stiffness:.2g}",
                plain(1e3 * entry.mass_per_length, 3),
                "" if entry.friction is None else f"{entry.friction:.2g}",
                "flat" if entry.wedge_angle is None else f"{degrees(entry.wedge_angle):.3g}°",
                "" if entry.smallest_diameter is None else plain(1e3 * entry.smallest_diameter, 3),
            )


def _size(entry: "Entry") -> str:
    """The belt size of the values."""
    if entry.sold_by == "ribs":
        return f"1 {entry.piece}"
    return f"{1e3 * entry.width:.4g} mm {entry.sold_by}"


def _show(profile: str, entry: "Entry") -> None:
    """Show a profile: its values, what follows from them, how a drive file names it, and the sources."""
    show(f"{profile}: {entry.title}.{' Generic values.' if entry.generic else ''}\n")
    show(f"Values of {_size(entry)}")
    show_facts((f"  {name}", fact) for name, fact in _values(entry))
    show("\nDerived values")
    show_facts((f"  {name}", fact) for name, fact in _consequences(entry))
    width = f'width = "{max(50.0, 1e3 * entry.width):g} mm"'
    size = {"ribs": "ribs = 1", "width": width, "diameter": 'diameter = "8 mm"'}[entry.sold_by]
    teeth = "" if entry.toothing is None else "  teeth = 100\n"
    show(f'\nIn a drive file\n  [belt]\n  profile = "{profile}"\n  {size}\n{teeth}\nSources')
    show_paragraphs(entry.source.strip().splitlines())
    data_of = (
        *(("Teeth", entry.toothing), ("Rating of teeth", entry.tooth_rating)),
        *(("Cord fatigue", entry.cord_fatigue), ("Rib fatigue", entry.rib_fatigue)),
    )
    for name, data in data_of:
        if data is not None and data.source is not None:
            show_paragraphs([f"{name}: {data.source.strip()}"])


def _values(entry: "Entry") -> Iterator[tuple[str, str]]:
    """The values of a profile in the catalogue."""
    from beltdyn.model.belt_form import DAMPING_TIMES, LOSSES
    from beltdyn.parts.messages import plain

    yield "width", f"{1e3 * entry.width:.4g} mm{', the pitch or datum width' * entry.is_v_belt}"
    yield "thickness", f"{1e3 * entry.thickness:.4g} mm"
    yield "pitch_offset", f"{1e3 * entry.pitch_offset:.3g} mm from the inside surface to the tension line"
    yield "back_offset", f"{1e3 * entry.back_offset:.3g} mm from the back to the tension line"
    if entry.wedge_angle is not None:
        yield "wedge_angle", f"{degrees(entry.wedge_angle):.3g}°"
    begins = ", the initial slope of the measured curve" * (entry.stretch_curve is not None)
    yield "axial_stiffness", f"{plain(entry.axial_stiffness / 1e3, 4)} kN{begins}"
    yield "bending_stiffness", f"{entry.bending_stiffness:.3g} N·m²"
    yield "mass_per_length", f"{plain(1e3 * entry.mass_per_length, 3)} g/m"
    if entry.friction is not None:
        yield "friction", f"{entry.friction:.3g}, without the wedge factor of the groove"
    if entry.contact_stiffness is not None:
        yield "contact_stiffness", f"{entry.contact_stiffness / 1e6:.3g} MN/m²"
    if entry.measuring_force is not None:
        yield "measuring_force", f"{entry.measuring_force:.4g} N, half in each strand"
    if entry.largest_tension is not None:
        yield "largest_tension", f"{entry.largest_tension:.4g} N"
    if entry.strength is not None:
        yield "strength", f"{1e-3 * entry.strength:.4g} N/mm of width"
    for name in ("permanent_elongation", "thermal_expansion", "least_safety", "least_motion_safety"):
        if (value := getattr(entry, name)) is not None:
            yield name, _PRINTED[name].format(value)
    if (teeth := entry.toothing) is not None:
        yield "toothing.pitch", f"{1e3 * teeth.pitch:.5g} mm"
        yield "toothing.tooth_stiffness", f"{teeth.tooth_stiffness / 1e3:.3g} N/mm a tooth"
        yield "toothing.flank_angle", f"{degrees(teeth.flank_angle):.3g}°"
        if teeth.tooth_height is not None:
            yield "toothing.tooth_height", f"{1e3 * teeth.tooth_height:.3g} mm"
        if teeth.largest_tooth_load is not None:
            yield "toothing.largest_tooth_load", f"{teeth.largest_tooth_load:.3g} N"
    if (rating := entry.tooth_rating) is not None:
        widths = ", ".join(f"{1e3 * one:.4g}" for one in rating.widths)
        yield "tooth_rating", f"{rating.counted_teeth:g} teeth in mesh count; standard widths {widths or 'any'} mm"
    if entry.tooth_counts:
        yield "tooth_counts", f"{len(entry.tooth_counts)} from {entry.tooth_counts[0]} to {entry.tooth_counts[-1]}"
    if entry.largest_fleeting_angle is not None:
        yield "largest_fleeting_angle", f"{degrees(entry.largest_fleeting_angle):.3g}°"
    if line := entry.cord_fatigue:
        points = zip(line.forces, line.cycles, strict=True)
        yield "cord_fatigue", ", ".join(f"{force:.4g} N at {cycles:.3g} cycles" for force, cycles in points)
    if law := entry.rib_fatigue:
        exponents = f"diameter^-{law.diameter_exponent:g}, tension^{law.tension_exponent:g}"
        yield "rib_fatigue", f"{exponents}, twice for {law.halving_difference:g} K, {law.back_factor:g} at the back"
    for name in LOSSES:
        if getattr(entry, name) > 0:
            yield name, f"{getattr(entry, name):.3g}{' s' if name in DAMPING_TIMES else ''}"


def _consequences(entry: "Entry") -> Iterator[tuple[str, str]]:
    """Values derived from those of a profile."""
    from beltdyn.parts.messages import plain

    offset, length = 1e3 * entry.pitch_offset, _LENGTHS[entry.pulley_diameter]
    line = f"{offset:.3g} mm outside" if offset else "at that diameter"
    more = f"{2 * pi * offset:.3g} mm longer (2π × {offset:.3g} mm)" if offset else "of that length"
    yield "pulleys", f"diameter = {entry.pulley_diameter} diameter; the tension line is {line}"
    if entry.toothing is None:
        yield "belts", f"nominal_length = {length}; the tension line is {more}"
    else:
        yield "belts", f"teeth of {1e3 * entry.toothing.pitch:.5g} mm each, under measuring_force"
    if entry.measuring_force:
        yield "measured", f"{entry.measured_stretch - 1.0:.3%} longer than unstretched, under measuring_force"
    if entry.smallest_diameter is not None:
        of_drive = ", of a fully used belt on its drive pulley" if entry.strength else ""
        yield "smallest pulley", f"{1e3 * entry.smallest_diameter:.3g} mm of {entry.pulley_diameter} diameter{of_drive}"
    if entry.friction is not None and entry.wedge_angle is not None:
        yield "friction in grooves", f"{entry.friction / sin(entry.wedge_angle / 2):.3g}"
    if entry.stretch_curve is None:
        yield "stretch", f"{plain(entry.axial_stiffness / 100, 4)} N at 1 %"
    else:
        points = zip(entry.stretch_curve.strains, entry.stretch_curve.tensions, strict=True)
        yield "stretch", ", ".join(f"{tension:.4g} N at {100 * strain:.3g} %" for strain, tension in points if strain)
    yield "longitudinal wave speed", f"{sqrt(entry.axial_stiffness / entry.mass_per_length):.0f} m/s"


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
    for text in dict.fromkeys(one.doubt for one in found if one.doubt):
        show(f"Note: {text}")
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
