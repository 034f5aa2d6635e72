"""Every name in backticks, in docstrings and on pages, is the name of something that there is."""

import ast
import builtins
import importlib
import keyword
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from beltdyn.model import Drive
from beltdyn.results.schema import FILTERED

ROOT = Path(__file__).parents[2]
CODE = ("src", "tests", "validation", "tools", "benchmarks", "docs/scripts")
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md"))]
ELSEWHERE = frozenset({"scipy.signal.get_window", "fmi3Error", "fmi2Discard", "PATH", "python3.dll", "literalinclude"})
"""Names of libraries, standards and systems."""
FORMS = frozenset({"MODULE", "bd.NAME", "test_MODULE", "test_MODULE_SUBJECT", "Nmm", "kNm"})
"""Placeholders, and spellings of units."""
TABLES = frozenset({"pulleys.pulley_speed_driver", "state.csv"})
"""Names of tables by the dimensions of a result."""
PARTS = frozenset(path.stem for path in (ROOT / "src" / "beltdyn").iterdir()) - set(Drive.model_fields)
"""Modules and packages; where a group of a drive file has the name of one, names with dots are keys."""


@cache
def sources() -> dict[Path, ast.Module]:
    files = sorted({file for folder in CODE for file in (ROOT / folder).rglob("*.py")} - {Path(__file__)})
    return {file: ast.parse(file.read_text(encoding="utf-8")) for file in files}


def words_of(node: ast.AST) -> Iterator[str]:
    """Names that a node defines or uses."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name) | ast.Name(id=name):
            yield name
        case ast.Attribute(attr=name) | ast.keyword(arg=str(name)):
            yield name
        case ast.alias(name=name, asname=other):
            yield from (*name.split("."), other or "")
        case ast.Constant(value=str(text)) if re.fullmatch(r"[\w.\-]+", text):
            yield from (text, *re.split(r"[.\-]", text))


@cache
def known() -> frozenset[str]:
    """Names of the sources, keys and kinds among them, of files and folders, and of Python."""
    words = {word for tree in sources().values() for node in ast.walk(tree) for word in words_of(node)}
    files = [*sources(), *PAGES, *(ROOT / "docs").glob("*/*"), *ROOT.iterdir()]
    paths = {word for file in files for word in (file.name, file.stem, file.suffix[1:], file.parent.name)}
    return frozenset({*words, *paths, *dir(builtins), *keyword.kwlist, *(f"filtered_{name}" for name in FILTERED)})


def names_in(text: str) -> set[str]:
    """Names in backticks, with dots; code in blocks is run by other tests."""
    ticked = re.findall(r"(?<!`)`([^`\n]+)`(?!`)", re.sub(r"```.*?```", "", text, flags=re.DOTALL))
    return {match[1] for one in ticked if (match := re.fullmatch(r"([A-Za-z_][\w.]*)(\(\))?", one))}


def resolves(name: str) -> bool:
    """Whether a dotted name from a part of the package on leads to a module, or to what is in it."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            place = importlib.import_module(".".join(parts[:count]))
        except ImportError:
            continue
        return _has(place, parts[count:])
    return False


def _has(place: object, path: list[str]) -> bool:
    if not path:
        return True
    fields = {key for one in getattr(place, "__mro__", ()) for key in getattr(one, "__annotations__", ())}
    return path[0] in fields or (hasattr(place, path[0]) and _has(getattr(place, path[0]), path[1:]))


def stale(text: str) -> set[str]:
    """Names in backticks that lead nowhere."""
    lost = set[str]()
    for name in names_in(text) - ELSEWHERE - FORMS - TABLES:
        first, _, rest = name.partition(".")
        if rest and first in (PARTS | {"beltdyn", "bd"}):
            path = f"beltdyn.{rest}" if first in ("beltdyn", "bd") else f"beltdyn.{name}"
            lost |= set() if resolves(path) or name in known() else {name}
        elif not set(filter(None, name.split("."))) <= known():
            lost.add(name)
    return lost


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_names_of_a_page(page: Path) -> None:
    assert not stale(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("folder", CODE)
def test_names_in_docstrings(folder: str) -> None:
    lost = {
        file.relative_to(ROOT).as_posix(): names
        for file, tree in sources().items()
        if file.is_relative_to(ROOT / folder)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and (names := stale(node.value))
    }
    assert not lost


def test_names_that_lead_nowhere_are_noticed() -> None:
    """Of a module that is gone, of a function that moved, and of a key that nobody reads."""
    text = "See `theory.sliding_flutter`, `bd.simulate`, `elements.hysteretic`, `alpha_predictor` and `belt.elements`."
    assert stale(text) == {"theory.sliding_flutter", "elements.hysteretic", "alpha_predictor"}
