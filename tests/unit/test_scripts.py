"""Scripts that no test runs, of the documentation and of benchmarks: all that they import is there."""

import ast
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted([*(ROOT / "benchmarks").glob("*.py"), *(ROOT / "docs" / "scripts").glob("*.py")])
OWN = {"beltdyn", "tests", "tools", "validation"}
OPTIONAL = {"exudyn"}
"""Programs of others, which need not be installed."""


def imports(text: str) -> Iterator[tuple[str, str]]:
    """Names that a script imports from the project, with their modules."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] in OWN:
            yield from ((node.module, alias.name) for alias in node.names)


def is_there(module: str, name: str) -> bool:
    try:
        holder = import_module(module)
    except ModuleNotFoundError as error:
        return error.name in OPTIONAL
    return hasattr(holder, name) or (hasattr(holder, "__path__") and find_spec(f"{module}.{name}") is not None)


def test_scripts_import_what_there_is() -> None:
    assert len(SCRIPTS) > 30
    missing = {
        f"{script.relative_to(ROOT)}: {module}.{name}"
        for script in SCRIPTS
        for module, name in imports(script.read_text(encoding="utf-8"))
        if not is_there(module, name)
    }
    assert missing == set()


@pytest.mark.parametrize(
    ("module", "name", "there"), [("beltdyn.model", "prepare", True), ("beltdyn.model", "x", False)]
)
def test_a_name_that_is_gone_is_noticed(module: str, name: str, there: bool) -> None:
    assert list(imports(f"from {module} import {name}\n")) == [(module, name)]
    assert is_there(module, name) is there
