"""Tables of the keys of drive files and studies, made from the fields that read them: for pages and the terminal."""

import json
import re
import typing
from collections.abc import Mapping
from functools import cache
from math import inf, pi, tau
from typing import Any, Literal, NamedTuple

from annotated_types import Ge, Gt, Le, Lt
from pydantic.fields import FieldInfo

from beltdyn.contact.surface import KINDS as SURFACES
from beltdyn.errors import ModelError
from beltdyn.machines import Goods, Support
from beltdyn.machines.carrying.support import SUPPORTS, MassFlow
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads.load import LOADS, Load
from beltdyn.machines.profiles.harmonic import CrankSpeed
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.machines.tensioners.rotary import ArmAsSupplied
from beltdyn.machines.tensioners.tensioner import TENSIONERS
from beltdyn.model import (
    Belt,
    Carriage,
    Contact,
    Cover,
    Drive,
    FixedEnd,
    Harmonic,
    Limits,
    Nip,
    PulledEnd,
    Pulley,
    Roll,
    SheetHead,
    Simulation,
    Steady,
    Unwinder,
    WeightEnd,
    Winder,
)
from beltdyn.model.belt_form import Nominal, Sold, Stiffnesses
from beltdyn.model.catalogue import Entry
from beltdyn.model.parameter_study import (
    DutyPoint,
    FreeNumber,
    Goal,
    Measurement,
    Obstacle,
    Order,
    ParameterStudy,
    Points,
    Requirement,
    VariedNumber,
)
from beltdyn.model.pulley import Diameter, surface_part
from beltdyn.model.rating import CordFatigue, RibFatigue, StretchCurve
from beltdyn.model.toothing import Toothing
from beltdyn.parts.kind_fields import NameOf
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import described_unit, printed_unit

AUTOMATIC = {
    Belt: ("length", "elements", "discretization"),
    Contact: ("stiffness", "damping", "creep_ratio", "standstill_creep"),
    Simulation: ("frame",),
}
"""Keys whose value the program chooses where the file leaves them open."""


_GROUPS = tuple(name for name, field in Drive.model_fields.items() if "the group" in (field.description or ""))
"""Fields of a drive that are groups of its file."""


_SUPPLIED = {*Entry.model_fields, "density", "youngs_modulus", "poissons_ratio"}
"""Keys of a belt that a profile of the catalogue supplies, by its stiffnesses and mass where it has no such value."""


class Key(NamedTuple):
    """A key of a group."""

    name: str
    meaning: str
    """Description, choices and limits; the unit of bare numbers last."""
    unit: str
    """SI unit of bare numbers, as printed; empty without one."""
    default: str
    """The value of an open key, or "chosen", "required", "from the profile"; empty without one."""


class Group(NamedTuple):
    """A group of keys."""

    heading: str
    """As a file writes it, such as ``[[pulley.load]] kind = "constant"``."""
    keys: tuple[Key, ...]


@cache
def key_groups() -> dict[str, Group]:
    """All groups, by names such as "belt" and "load.constant".

    Returns
    -------
    dict[str, Group]
        In the order of the drive file, then of study files; kinds in the order of their registry.
    """
    drive = {
        "drive": Group("before the first group", _keys(Drive, without=_GROUPS)),
        "belt": Group("[belt]", _keys(Belt, Nominal)),
        "sold": Group("[belt] as sold", _keys(Stiffnesses, Sold, without=("width", "thickness"))),
        "toothing": Group("[belt.toothing]", _keys(Toothing)),
        "stretch_curve": Group("[belt.stretch_curve]", _keys(StretchCurve)),
        "cord_fatigue": Group("[belt.cord_fatigue]", _keys(CordFatigue)),
        "rib_fatigue": Group("[belt.rib_fatigue]", _keys(RibFatigue)),
        "pulley": Group("[[pulley]]", _keys(Pulley, Diameter)),
        **_family("surface", "[pulley.surface]", {name: surface_part(kind) for name, kind in SURFACES.items()}),
        "cover": Group("[pulley.cover]", _keys(Cover)),
        "harmonic": Group("[[pulley.harmonics]]", _keys(Harmonic)),
        "crank": Group("[pulley.harmonics] as a table of a measured speed", _keys(CrankSpeed)),
        **_family("load", "[[pulley.load]]", LOADS, Load),
        **_family("hub", "[[pulley.hub]]", LINKS),
        **_family("profile", "a number over time:", PROFILES),
        **_family("tensioner", "[[tensioner]]", TENSIONERS),
        "arm": Group("[[tensioner]] as supplied", _keys(ArmAsSupplied)),
        "contact": Group("[contact]", _keys(Contact)),
        **_family("support", "[[support]]", SUPPORTS, Support),
        "goods": Group("[[goods]]", _keys(Goods, MassFlow)),
        "nip": Group("[[nip]]", _keys(Nip)),
        **_family("end", "[[end]]", {"fixed": FixedEnd, "pulled": PulledEnd, "weight": WeightEnd}),
        "carriage": Group("[carriage]", _keys(Carriage)),
        "unwinder": Group("[unwinder]", _keys(Unwinder)),
        "winder": Group("[winder]", _keys(Winder)),
        "roll": Group("[unwinder.roll], [winder.roll]", _keys(Roll)),
        "duty": Group("[[duty]]", _keys(DutyPoint)),
        "simulation": Group("[simulation]", _keys(Simulation)),
        "steady": Group("[steady]", _keys(Steady)),
        "limits": Group("[limits]", _keys(Limits)),
        "sheet": Group("[sheet]", _keys(SheetHead)),
    }
    study = {
        "study": Group("study file", _keys(ParameterStudy)),
        "study_number": Group("study file: [[number]]", _keys(VariedNumber)),
        "points": Group("optimization: [points]", _keys(Points)),
        "free_number": Group("optimization or calibration: [[number]]", _keys(FreeNumber)),
        "goal": Group("optimization: [goal]", _keys(Goal)),
        "requirement": Group("optimization: [[requirement]]", _keys(Requirement)),
        "order": Group("optimization: [[order]]", _keys(Order)),
        "obstacle": Group("optimization: [[obstacle]]", _keys(Obstacle)),
        "measurement": Group("calibration: [[measurement]]", _keys(Measurement)),
    }
    return drive | study


def _family(
    name: str, heading: str, kinds: Mapping[str, type[Part]], shared: type[Part] | None = None
) -> dict[str, Group]:
    """The groups of all kinds, and that of the keys that they share."""
    common = tuple(shared.model_fields) if shared else ()
    groups = {
        f"{name}.{kind}": Group(f'{heading} kind = "{kind}"', _keys(part, without=("kind", *common)))
        for kind, part in kinds.items()
    }
    return groups | ({f"{name}.shared": Group(f"{heading} of every kind", _keys(shared))} if shared else {})


def groups_for(word: str) -> dict[str, Group]:
    """Groups that a word names: a group, a family of kinds, a kind, or a key.

    Parameters
    ----------
    word
        Such as "belt", "load", "load.motor", "pulley.load" or "friction".

    Returns
    -------
    dict[str, Group]
        Groups by name; of a key the groups that have it, each with this key alone.

    Raises
    ------
    ModelError
        If no group and no key has this name; the message lists the groups.
    """
    groups, parts = key_groups(), word.strip("[] ").replace("-", "_").split(".")
    for path in (".".join(parts), ".".join(parts[1:]) or parts[0]):
        named = {name: group for name, group in groups.items() if name == path or name.startswith(f"{path}.")}
        if path == "belt":
            named |= {"sold": groups["sold"]}
        if (family := f"{path.partition('.')[0]}.shared") in groups and named:
            named[family] = groups[family]
        if named:
            return named
    keys = {name: [key for key in group.keys if key.name == parts[-1]] for name, group in groups.items()}
    named = {name: groups[name]._replace(keys=tuple(found)) for name, found in keys.items() if found}
    if not named:
        families = dict.fromkeys(name.partition(".")[0] for name in groups)
        raise ModelError(
            f'there is no group or key "{word}". Choose one of {", ".join(families)}, or the name of a key.'
        )
    return named


def described(description: str) -> str:
    """A description with units as they are printed."""
    return re.sub(r"\^([23])", lambda power: "²³"[int(power[1]) - 2], description.replace("*", " "))


def _keys(part: type[Part], *others: type[Part], without: tuple[str, ...] = ("kind",)) -> tuple[Key, ...]:
    """The keys of a part, with those that others take in their place."""
    return tuple(
        Key(field.alias or name, _meaning(field), _unit(field), _default(part, owner, name, field))
        for owner in (part, *others)
        for name, field in owner.model_fields.items()
        if name not in without
    )


def _unit(field: FieldInfo) -> str:
    return printed_unit(described_unit(field.description or ""))


def _meaning(field: FieldInfo) -> str:
    """Description, choices and limits."""
    description = described(field.description or "")
    clauses = [f"{description[0].upper()}{description[1:]}"]
    choices = next((each.choices for each in field.metadata if isinstance(each, NameOf)), _choices(field.annotation))
    if not all(choice in description for choice in choices):
        clauses.append(f"one of {', '.join(f'`{choice}`' for choice in choices)}")
    limits = [limit for each in field.metadata if (limit := _limit(each)) and limit not in description]
    return "; ".join([*clauses, " and ".join(limits)] if limits else clauses)


def _choices(annotation: Any) -> tuple[str, ...]:
    """The words from which one is chosen."""
    if typing.get_origin(annotation) is Literal:
        return typing.get_args(annotation)
    for each in getattr(annotation, "__metadata__", ()):
        if isinstance(each, NameOf):
            return each.choices
    return next((choices for each in typing.get_args(annotation) if (choices := _choices(each))), ())


def _limit(constraint: object) -> str:
    """A limit in words; none of those that go without saying."""
    match constraint:
        case Gt(gt=limit) if limit:
            return f"above {limit:g}"
        case Ge(ge=limit) if limit:
            return f"at least {limit:g}"
        case Lt(lt=limit) if limit < inf:
            return f"below {limit:g}"
        case Le(le=limit):
            return f"at most {'π' if limit == pi else format(limit, 'g')}"
    return ""


def _default(part: type[Part], owner: type[Part], name: str, field: FieldInfo) -> str:
    """The value that holds where the key is left open."""
    if name in AUTOMATIC.get(owner, ()):
        return "chosen"
    supplied = owner in (Belt, Stiffnesses) and name in _SUPPLIED
    if field.is_required():
        return "from the profile" if supplied else "required" if owner is part else ""
    value = field.get_default()
    if value in (None, ()) or field.default_factory:
        return "from the profile" if supplied else ""
    if value == tau:
        return "one turn"
    return f"`{json.dumps(value) if isinstance(value, bool | tuple) else value}`"
