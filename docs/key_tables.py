"""Tables of the keys of drive files and studies, made from the fields that read them: `{{ keys.belt }}` on a page."""

import json
import re
import typing
from collections.abc import Iterable, Mapping
from functools import cache
from math import inf, pi, tau
from pathlib import Path
from typing import Any, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic.fields import FieldInfo

from beltdyn.analyses import ANALYSES
from beltdyn.contact.surface import KINDS as SURFACES
from beltdyn.machines import Goods, Support
from beltdyn.machines.carrying.support import SUPPORTS
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
    FixedEnd,
    Harmonic,
    Limits,
    Nip,
    PulledEnd,
    Pulley,
    Roll,
    Simulation,
    Steady,
    Unwinder,
    WeightEnd,
    Winder,
)
from beltdyn.model.belt_form import Nominal, Sold, Stiffnesses
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
from beltdyn.parts.kind_fields import NameOf
from beltdyn.parts.part import Part
from beltdyn.show.plot import FIGURES
from beltdyn.show.plot.figures import on_request

CHOSEN = {
    Belt: ("length", "elements", "discretization"),
    Contact: ("stiffness", "damping", "creep_ratio", "standstill_creep"),
    Simulation: ("frame",),
}
"""Keys that a drive chooses where its file leaves them open."""

_CODE = re.compile(r'\{ [^}]*\}|"[\w.()\[\] -]+"|\b[a-z]+(?:_[a-z]+)+\b')
"""Values in quotation marks, and keys of more than one word."""


def table(part: type[Part], *others: type[Part], without: Iterable[str] = ("kind",)) -> str:
    """The keys of a part as a table in Markdown, with those that others take in their place."""
    rows = {
        field.alias or name: f"| `{field.alias or name}` | {_meaning(field)} | {_default(part, one, name, field)} |"
        for one in (part, *others)
        for name, field in one.model_fields.items()
        if name not in without
    }
    return "\n".join(["| key | meaning | default |", "|---|---|---|", *rows.values()])


def family(kinds: Mapping[str, type[Part]], shared: type[Part] | None = None) -> dict[str, str]:
    """Tables of all kinds; what they share has a table of its own, `shared`."""
    common = tuple(shared.model_fields) if shared else ()
    tables = {name: table(part, without=("kind", *common)) for name, part in kinds.items()}
    return {**tables, "shared": table(shared)} if shared else tables


def untold(name: str) -> dict[str, type[Part]]:
    """Kinds of one of the families that have keys, but no section on a page."""
    return {
        kind: part
        for kind, part in FAMILIES[name].items()
        if f"{{{{ keys.{name}.{kind} }}}}" not in _told() and set(part.model_fields) != {"kind"}
    }


@cache
def _told() -> str:
    """All pages."""
    return "".join(page.read_text(encoding="utf-8") for page in Path(__file__).parent.rglob("*.md"))


def others(kinds: Mapping[str, type[Part]]) -> str:
    """Kinds one below the other, each with its meaning and its keys."""
    return "\n\n".join(
        f'**`kind = "{name}"`**: {(part.__doc__ or "").partition(chr(10))[0]}\n\n{table(part)}'
        for name, part in kinds.items()
    )


def spelled(description: str) -> str:
    """A description with units as they are printed, and with keys and values of the file as code."""
    text = re.sub(r"\^([23])", lambda found: "²³"[int(found[1]) - 2], description.replace("*", " "))
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(one if one.startswith("`") else _CODE.sub(r"`\g<0>`", one) for one in parts)


def _meaning(field: FieldInfo) -> str:
    """Description, choices and limits."""
    told = spelled(field.description or "")
    words = [f"{told[0].upper()}{told[1:]}"]
    choices = next((one.choices for one in field.metadata if isinstance(one, NameOf)), _choices(field.annotation))
    if not all(one in told for one in choices):
        words.append(f"one of {', '.join(f'`{one}`' for one in choices)}")
    limits = [limit for one in field.metadata if (limit := _limit(one)) and limit not in told]
    return "; ".join([*words, " and ".join(limits)] if limits else words)


def _choices(annotation: Any) -> tuple[str, ...]:
    """The words from which one is chosen."""
    if typing.get_origin(annotation) is Literal:
        return typing.get_args(annotation)
    for one in getattr(annotation, "__metadata__", ()):
        if isinstance(one, NameOf):
            return one.choices
    return next((found for one in typing.get_args(annotation) if (found := _choices(one))), ())


def _limit(constraint: object) -> str:
    """A limit in words; nothing of what goes without saying."""
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


def _default(part: type[Part], one: type[Part], name: str, field: FieldInfo) -> str:
    """The value that holds where the key is open."""
    if name in CHOSEN.get(one, ()):
        return "chosen"
    if field.is_required():
        return "required" if one is part else ""
    value = field.get_default()
    if value in (None, ()) or field.default_factory:
        return ""
    if value == tau:
        return "one turn"
    return f"`{json.dumps(value) if isinstance(value, bool | tuple) else value}`"


def names(kinds: Mapping[str, Any]) -> str:
    """The classes of a family as a table in Markdown, with their keys."""
    rows = []
    for name, part in kinds.items():
        told = (part.__doc__ or "").partition("\n")[0]
        keys = ", ".join(f"`{key}`" for key in list(part.keys()) if key != "kind")
        rows.append(f"| `bd.{part.__name__}` | `{name}` | {told} | {keys} |")
    return "\n".join(["| class | `kind` | | keys |", "|---|---|---|---|", *rows])


def analyses() -> str:
    """The analyses as a table in Markdown."""
    rows = [f"| `bd.{name}` | `beltdyn {one.command}` | {one.purpose} |" for name, one in ANALYSES.items()]
    return "\n".join(["| function | command | |", "|---|---|---|", *rows])


def figures() -> str:
    """The figures as a table in Markdown."""
    rows = [
        f"| `bd.plot.{name}` | {', '.join(one.of)} | {'on request' if one.by_default is on_request else ''} "
        f"| {(one.draw.__doc__ or '').partition(chr(10))[0]} |"
        for name, one in FIGURES.items()
    ]
    return "\n".join(["| figure | of results of | | |", "|---|---|---|---|", *rows])


KINDS = {"load": names(LOADS), "hub": names(LINKS), "tensioner": names(TENSIONERS), "profile": names(PROFILES)}
KINDS |= {"support": names(SUPPORTS)}
KINDS |= {"analysis": analyses(), "figure": figures()}
"""The classes of the machines: `{{ kinds.load }}`."""

FAMILIES: dict[str, Mapping[str, type[Part]]] = {
    "surface": {name: surface_part(kind) for name, kind in SURFACES.items()},
    "load": LOADS,
    "hub": LINKS,
    "support": SUPPORTS,
    "tensioner": TENSIONERS,
}
"""Kinds with sections of their own; `{{ keys.load.others }}` has those that were added without one."""

KEYS: dict[str, Any] = {
    "belt": table(Belt, Nominal),
    "sold": table(Stiffnesses, Sold, without=("width", "thickness")),
    "stretch_curve": table(StretchCurve),
    "cord_fatigue": table(CordFatigue),
    "rib_fatigue": table(RibFatigue),
    "pulley": table(Pulley, Diameter),
    "surface": family(FAMILIES["surface"]),
    "contact": table(Contact),
    "duty": table(DutyPoint),
    "simulation": table(Simulation),
    "steady": table(Steady),
    "limits": table(Limits),
    "end": family({"fixed": FixedEnd, "pulled": PulledEnd, "weight": WeightEnd}),
    "carriage": table(Carriage),
    "roll": table(Roll),
    "unwinder": table(Unwinder),
    "winder": table(Winder),
    "harmonic": table(Harmonic),
    "crank": table(CrankSpeed),
    "load": family(LOADS, Load),
    "arm": table(ArmAsSupplied),
    "hub": family(LINKS),
    "support": family(SUPPORTS, Support),
    "goods": table(Goods),
    "nip": table(Nip),
    "cover": table(Cover),
    "tensioner": family(TENSIONERS),
    "profile": family(PROFILES),
    "study": table(ParameterStudy),
    "study_number": table(VariedNumber),
    "free_number": table(FreeNumber),
    "points": table(Points),
    "goal": table(Goal),
    "requirement": table(Requirement),
    "order": table(Order),
    "obstacle": table(Obstacle),
    "measurement": table(Measurement),
}
"""All tables, by the names that the pages give them."""

for _name in FAMILIES:
    KEYS[_name]["others"] = others(untold(_name))
