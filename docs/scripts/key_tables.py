"""Write tables of keys, kinds, results and belts into pages, between `<!-- keys.belt -->` and `<!-- end -->`."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from beltdyn.analyses import ANALYSES
from beltdyn.machines.carrying.support import SUPPORTS
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads.load import LOADS
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.machines.tensioners.tensioner import TENSIONERS
from beltdyn.model import Entry, read_catalogue
from beltdyn.parts.messages import plain
from beltdyn.results import COORDINATES, VARIABLES, Variable
from beltdyn.show.key_tables import Group, key_groups
from beltdyn.show.plot import FIGURES
from beltdyn.show.plot.figures import on_request

PAGES = Path(__file__).parents[1]
FAMILIES = ("surface", "load", "hub", "support", "tensioner")
"""Families of kinds with sections of their own; `load.others` has those without one."""

_CODE = re.compile(r'\{ [^}]*\}|"[\w.()\[\] -]+"|\b[a-z]+(?:_[a-z]+)+\b')
"""Values in quotation marks, and keys of more than one word."""
_BLOCK = re.compile(r"<!-- ([\w.]+) -->\n.*?<!-- end -->", re.DOTALL)


def spelled(text: str) -> str:
    """A text with keys and values of the file as code."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else _CODE.sub(r"`\g<0>`", part) for part in parts)


def table(headings: str, rows: Iterator[tuple[str, ...]]) -> str:
    """A table in Markdown."""
    columns = headings.split("|")
    lines = [f"| {' | '.join(row)} |" for row in (columns, *rows)]
    return "\n".join([lines[0].replace("  ", " "), "|---" * len(columns) + "|", *lines[1:]])


def keys(group: Group) -> str:
    """The keys of a group."""
    return table("key|meaning|default", ((f"`{key.name}`", spelled(key.meaning), key.default) for key in group.keys))


def others(family: str) -> str:
    """Kinds of a family that have no section on a page, each with its meaning and its keys."""
    kinds = {"load": LOADS, "hub": LINKS, "support": SUPPORTS, "tensioner": TENSIONERS}.get(family, {})
    return "\n\n".join(
        f'**`kind = "{kind}"`**: {_purpose(kinds.get(kind))}\n\n{keys(key_groups()[f"{family}.{kind}"])}'
        for kind in without_section(family)
    )


def without_section(family: str) -> list[str]:
    """Kinds of a family that have keys, but no section on a page."""
    pages = "".join(page.read_text(encoding="utf-8") for page in PAGES.rglob("*.md"))
    names = [name for name, group in key_groups().items() if name.startswith(f"{family}.") and group.keys]
    return [name.partition(".")[2] for name in names if f"<!-- keys.{name} -->" not in pages]


def kinds(registry: Mapping[str, Any]) -> str:
    """The classes of a family, with their keys."""
    return table(
        "class|`kind`||keys",
        (
            (
                f"`bd.model.{part.__name__}`",
                f"`{name}`",
                _purpose(part),
                ", ".join(f"`{key}`" for key in list(part.keys()) if key != "kind"),
            )
            for name, part in registry.items()
        ),
    )


def analyses() -> str:
    """The analyses."""
    return table(
        "function|command|",
        ((f"`bd.{name}`", f"`beltdyn {each.command}`", each.purpose) for name, each in ANALYSES.items()),
    )


def figures() -> str:
    """The figures."""
    return table(
        "figure|of results of||",
        (
            (
                f"`bd.plot.{name}`",
                ", ".join(figure.of),
                "on request" if figure.by_default is on_request else "",
                _purpose(figure.draw),
            )
            for name, figure in FIGURES.items()
        ),
    )


def variables(schema: Mapping[str, Variable]) -> str:
    """The variables of a result."""
    return table(
        "name|meaning|unit|dimensions",
        (
            (f"`{name}`", each.long_name, each.units if each.dtype != "str" else "text", ", ".join(each.dims))
            for name, each in schema.items()
        ),
    )


def profiles(catalogue: Mapping[str, Entry]) -> str:
    """The profiles of the catalogue, below their kinds."""

    def rows() -> Iterator[tuple[str, ...]]:
        kind = ""
        for name, entry in catalogue.items():
            if entry.kind != kind:
                kind = entry.kind
                yield f"**{kind}**", *[""] * 7
            yield (
                f"`{name}`",
                plain(1e3 * entry.width, 3),
                f"{1e3 * entry.thickness:.3g}",
                plain(entry.axial_stiffness / 1e3, 3),
                f"{entry.bending_stiffness:.2g}",
                plain(1e3 * entry.mass_per_length, 3),
                f"{1e3 * entry.pitch_offset:.3g}, {1e3 * entry.back_offset:.3g}",
                plain(1e3 * entry.smallest_diameter, 3) if entry.smallest_diameter else "",
            )

    headings = "profile|width, mm|thickness, mm|$EA$, kN|$EI$, N m²|mass, g/m|"
    return table(f"{headings}`pitch_offset`, `back_offset`, mm|smallest pulley, mm", rows())


def _purpose(documented: Any) -> str:
    """The first line of a docstring."""
    return str(documented.__doc__ or "").partition("\n")[0]


def tables() -> dict[str, str]:
    """All tables, by the names that the pages give them."""
    registries = {"load": LOADS, "hub": LINKS, "tensioner": TENSIONERS, "profile": PROFILES, "support": SUPPORTS}
    return {
        **{f"keys.{name}": keys(group) for name, group in key_groups().items()},
        **{f"keys.{family}.others": others(family) for family in FAMILIES},
        **{f"kinds.{name}": kinds(registry) for name, registry in registries.items()},
        "kinds.analysis": analyses(),
        "kinds.figure": figures(),
        "catalogue": profiles(read_catalogue()),
        "variables": variables(VARIABLES),
        "coordinates": variables(COORDINATES),
    }


def with_tables(page: str, current: Mapping[str, str]) -> str:
    """A page with the tables as they are now."""
    return _BLOCK.sub(lambda block: f"<!-- {block[1]} -->\n{current[block[1]]}\n<!-- end -->", page)


if __name__ == "__main__":
    current = tables()
    for path in PAGES.rglob("*.md"):
        page = path.read_text(encoding="utf-8")
        if (written := with_tables(page, current)) != page:
            path.write_text(written, encoding="utf-8")
            print(f"Written: {path.relative_to(PAGES)}")  # noqa: T201
