"""Conveyor belts by the class in their name, such as "EP 400/3" or "ST 1000": values of a belt 1 m wide."""

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from beltdyn.theory.conveyor import standard_diameter

CLASSES = (
    *("EP 200/2", "EP 250/2", "EP 315/3", "EP 400/3", "EP 500/3", "EP 500/4", "EP 630/4", "EP 800/4", "EP 1000/5"),
    *("EP 1250/5", "EP 1600/5", "NN 200/2", "NN 315/3", "NN 400/3", "NN 500/4", "NN 630/4", "NN 800/4"),
    *("ST 500", "ST 630", "ST 800", "ST 1000", "ST 1250", "ST 1600", "ST 2000", "ST 2500", "ST 3150", "ST 3500"),
    *("ST 4000", "ST 4500", "ST 5000", "ST 5400"),
)
"""Classes that the catalogue lists; any other strength and number of plies of a textile belt is read as well."""

_NAME = re.compile(
    r"(?P<kind>EP|EE|NN|ST)[ -]?(?P<strength>\d{3,4})(?:/(?P<plies>[1-9]))?"
    r"(?: (?P<top>\d+(?:\.\d+)?)[+/](?P<bottom>\d+(?:\.\d+)?))?",
    re.IGNORECASE,
)
_CORDS = MappingProxyType(
    {
        strength: (cord, cover)
        for strengths, cord, cover in (
            *(((500, 630, 800), 3.7, 5.0), ((1000,), 3.9, 5.0), ((1250, 1400), 4.7, 5.0)),
            *(((1600, 1800, 2000), 5.4, 6.0), ((2250,), 6.2, 6.0), ((2500,), 6.8, 7.0)),
            *(((2800,), 7.2, 7.0), ((3150,), 8.1, 7.0), ((3500,), 8.6, 7.0), ((4000,), 8.9, 8.0)),
            *(((4500,), 9.7, 8.0), ((5000,), 10.9, 10.0), ((5400,), 11.3, 10.0)),
        )
        for strength in strengths
    }
)
"""Class of a steel-cord belt, N/mm -> diameter of its cords and usual thickness of either cover, mm."""
_NEIGHBORS = 3
"""Classes that a message names."""
_PLY_STRENGTHS = (50.0, 700.0)
"""Range of the strength of a ply, N/mm."""
_TEXTILE_COVERS = (4.0, 2.0)
"""Usual thickness of the covers of a textile belt, mm."""
_COVER_DENSITY, _TEXTILE_DENSITY, _STEEL_DENSITY = 1150.0, 1500.0, 7850.0
"""kg/m^3."""
_CORD_STRESS = 2000.0
"""Strength of the belt over the section of steel in its cords, N/mm^2."""
_RUBBER_MODULUS = 30e6
"""Of bending, Pa, as of the other belts of the catalogue."""
_SAFETY_IN_MOTIONS = 1.5
"""Steady safety factor over that in starts and stops."""


class _Carcass(NamedTuple):
    """The tension member of a kind of belt."""

    title: str
    ply_thickness: tuple[float, float]
    """Of a ply with its rubber, mm, and its rise with the strength of the ply, mm per N/mm."""
    stiffness: float
    """Axial stiffness over strength."""
    permanent_elongation: float
    thermal_expansion: float | None
    """1/K."""
    least_safety: float
    diameter_factor: float
    """Smallest diameter of a drive pulley over the thickness of the carcass."""


_POLYESTER = _Carcass("polyester and polyamide", (0.6, 0.0032), 10.0, 0.010, None, 10.0, 108.0)
_CARCASSES = MappingProxyType(
    {
        "EP": _POLYESTER,
        "EE": _POLYESTER._replace(title="polyester"),
        "NN": _Carcass("polyamide", (0.7, 0.0021), 6.0, 0.018, None, 10.0, 90.0),
        "ST": _Carcass("steel cord", (0.0, 0.0), 72.0, 0.0018, 11.7e-6, 6.7, 145.0),
    }
)

_STEEL_SOURCE = """\
Strength: the class, N/mm of width. Cord diameter and covers: DIN 22131, as a maker tabulates them (NRC Steelco).
Axial stiffness: 72 times the strength, DIN 22101.
Mass: estimate, covers of 1150 kg/m^3 and steel of 2000 N/mm^2."""
_TEXTILE_SOURCE = """\
Strength: the class, N/mm of width. Thickness: estimate, a line through the fabrics of a maker (Monster Belting) with \
rubber between plies, which gives the 11.4 mm of a data sheet of EP 630/4 5+2.
Axial stiffness: estimate, 10 (polyester) or 6 (polyamide) times the strength, from the elongations of 1.5 to 3 % at a \
tenth of the strength that DIN 22102 allows, less the permanent part.
Mass: estimate, covers of 1150 and carcass of 1500 kg/m^3, which gives the 14.7 kg/m^2 of that data sheet."""
_COMMON_SOURCE = """\
Bending stiffness: estimate, rubber of 30 MPa over the whole thickness.
Friction: 0.3, rubber lagging, wet; estimate from the 0.25 to 0.35 that are in use. Contact: not stated. Losses: not \
stated.
Permanent elongation: estimate, the middle of typical ranges (conveyorbeltguide.com): polyester 0.5 to 1.5 %, \
polyamide 1 to 2.5 %, steel 0.1 to 0.25 %.
Thermal expansion: that of steel, as L. Nordell states it for steel-cord belts (bulk-online.com); none is published \
for textile belts.
Least safety: strength over largest tension in steady running as makers use it, 6.7 of steel cord and 9 to 10 of \
textile belts (Forech; bulk-solids-handling.com); in starts and stops, estimate, 1.5 times less. DIN 22101 has \
instead the fatigue strength of the joint, which its maker states, with factors for service and life.
Smallest pulley: DIN 22101, for the drive pulley of a belt used to 60 % and more: 108 (polyester), 90 (polyamide) or \
145 (steel) times the thickness of the tension member, rounded up to a standard diameter."""


def class_values(profile: str) -> dict[str, Any] | None:
    """Values of an `Entry` for the class in the name of a conveyor belt; None for other names.

    Covers may follow the class: "EP 400/3 4+2", top and bottom in mm.

    Raises
    ------
    LookupError
        If the name is that of a class without number of plies, or of a strength that is not sold.
    """
    match = _NAME.fullmatch(profile.strip())
    if match is None:
        return None
    kind, strength = match["kind"].upper(), int(match["strength"])
    carcass = _CARCASSES[kind]
    given = None if match["top"] is None else (float(match["top"]), float(match["bottom"]))
    if kind == "ST":
        return _steel(carcass, strength, given, match)
    if match["plies"] is None:
        raise LookupError(f'profile = "{profile}" has no number of plies. Add it, such as "{kind} {strength}/3"')
    plies = int(match["plies"])
    least, largest = _PLY_STRENGTHS
    if not least <= strength / plies <= largest:
        raise LookupError(
            f'profile = "{profile}" has {strength / plies:.4g} N/mm a ply, but plies have {least:g} to {largest:g} '
            "N/mm. Correct strength or number of plies"
        )
    base, rise = carcass.ply_thickness
    thick = plies * base + rise * strength
    top, bottom = given or _TEXTILE_COVERS
    mass = 1e-3 * (_COVER_DENSITY * (top + bottom) + _TEXTILE_DENSITY * thick)
    title = f"{carcass.title}, {strength} N/mm, {plies} {'plies' if plies > 1 else 'ply'}"
    return _values(carcass, strength, (top, thick, bottom), title, mass) | {
        "kind": "Conveyor belts, textile",
        "source": f"{_TEXTILE_SOURCE}\n{_COMMON_SOURCE}",
    }


def _steel(carcass: _Carcass, strength: int, given: tuple[float, float] | None, match: re.Match[str]) -> dict[str, Any]:
    """Values of a steel-cord belt."""
    if match["plies"] is not None or strength not in _CORDS:
        near = sorted(sorted(_CORDS, key=lambda one: abs(one - strength))[:_NEIGHBORS])
        raise LookupError(
            f'profile = "{match[0]}" is no class of steel-cord belts, which have no plies. Choose one of '
            f"{', '.join(f'ST {one}' for one in near)}"
        )
    cord, cover = _CORDS[strength]
    top, bottom = given or (cover, cover)
    steel = strength / _CORD_STRESS
    mass = 1e-3 * (_COVER_DENSITY * (top + cord + bottom - steel) + _STEEL_DENSITY * steel)
    title = f"{carcass.title}, {strength} N/mm, cords of {cord:g} mm"
    return _values(carcass, strength, (top, cord, bottom), title, mass) | {
        "kind": "Conveyor belts, steel cord",
        "source": f"{_STEEL_SOURCE}\n{_COMMON_SOURCE}",
    }


def _values(
    carcass: _Carcass, strength: int, layers: tuple[float, float, float], title: str, mass: float
) -> dict[str, Any]:
    """Values of a belt 1 m wide, with the thickness of top cover, carcass and bottom cover, mm."""
    top, thick, bottom = (1e-3 * one for one in layers)
    whole, force = top + thick + bottom, 1e3 * strength
    return {
        "title": f"Conveyor belt of {title}, covers {layers[0]:g} + {layers[2]:g} mm",
        "sold_by": "width",
        "generic": True,
        "width": 1.0,
        "thickness": whole,
        "axial_stiffness": carcass.stiffness * force,
        "bending_stiffness": _RUBBER_MODULUS * whole**3 / 12.0,
        "mass_per_length": mass,
        "pitch_offset": bottom + 0.5 * thick,
        "back_offset": top + 0.5 * thick,
        "friction": 0.3,
        "strength": force,
        "permanent_elongation": carcass.permanent_elongation,
        "thermal_expansion": carcass.thermal_expansion,
        "least_safety": carcass.least_safety,
        "least_motion_safety": carcass.least_safety / _SAFETY_IN_MOTIONS,
        "smallest_diameter": standard_diameter(carcass.diameter_factor * thick),
    }


def listed_classes() -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Names and values of the classes that the catalogue lists."""
    for name in CLASSES:
        values = class_values(name)
        assert values is not None
        yield name, values
