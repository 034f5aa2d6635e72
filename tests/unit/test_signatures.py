"""Functions take few arguments: what travels together is a record."""

import ast
from collections.abc import Iterator
from pathlib import Path

import beltdyn

SOURCES = Path(beltdyn.__file__).parent
MOST = 7
"""By position; what a call must name, as options of a system or constants of a formula, is told apart there."""


def positional(function: ast.FunctionDef) -> list[str]:
    names = [argument.arg for argument in (*function.args.posonlyargs, *function.args.args)]
    return [name for name in names if name not in {"self", "cls"}]


def functions() -> Iterator[tuple[str, ast.FunctionDef]]:
    for file in sorted(SOURCES.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                yield f"{file.relative_to(SOURCES)}:{node.lineno} {node.name}", node


def test_no_function_takes_many_arguments_by_position() -> None:
    found = {place: positional(function) for place, function in functions()}
    assert len(found) > 1000
    assert {place: names for place, names in found.items() if len(names) > MOST} == {}
