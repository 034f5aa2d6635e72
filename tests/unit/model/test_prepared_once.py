"""A drive is prepared where an analysis begins; what works on a prepared drive asks it, and not the drive."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import beltdyn

SOURCES = Path(beltdyn.__file__).parent
PREPARING = {"prepare", "install", "lay_out", "complete", "layer_lengths", "balance_tensioners"}
"""Functions that find what a drive leaves open."""
OPEN = {"completed", "layout", "path", "centers", "belt_length", "elements"}
OPEN |= {"contact_stiffness", "contact_damping", "friction_parameters"}
"""What a drive leaves open, as it gives it to its users."""
BELOW = ("system", "solvers", "observation", "state", "results", "transient", "vibration")
"""Packages that work on what is prepared."""
OWN_LAYERS = {"_tension_over_length", "estimate_resolution", "mesh_resolution", "resolution"}
"""They look at the belt at another length or tension than at rest."""


def functions(package: str) -> Iterator[tuple[str, ast.FunctionDef]]:
    for path in sorted((SOURCES / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                yield f"{path.relative_to(SOURCES).as_posix()}: {node.name}", node


def called(node: ast.AST) -> set[str]:
    return {one.func.id for one in ast.walk(node) if isinstance(one, ast.Call) and isinstance(one.func, ast.Name)}


def takes_prepared(node: ast.FunctionDef) -> bool:
    given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return any(one.annotation is not None and "Prepared" in ast.unparse(one.annotation) for one in given)


@pytest.mark.parametrize("package", BELOW)
def test_what_is_prepared_is_not_prepared_again(package: str) -> None:
    again = {
        name: called(node) & PREPARING
        for name, node in functions(package)
        if takes_prepared(node) and node.name not in OWN_LAYERS
    }
    assert {name: found for name, found in again.items() if found} == {}


@pytest.mark.parametrize("package", ["system", "solvers", "observation"])
def test_equations_and_solvers_know_no_drive(package: str) -> None:
    """They get what is prepared."""
    for path in sorted((SOURCES / package).rglob("*.py")):
        imported = {
            alias.name
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.ImportFrom)
            for alias in node.names
        }
        assert imported.isdisjoint({"Drive", *PREPARING}), path


@pytest.mark.parametrize("package", BELOW)
def test_a_drive_is_not_asked_for_what_it_leaves_open(package: str) -> None:
    asked = [
        f"{name}: {ast.unparse(one)}"
        for name, node in functions(package)
        for one in ast.walk(node)
        if isinstance(one, ast.Attribute)
        and one.attr in OPEN
        and (getattr(one.value, "attr", "") == "drive" or getattr(one.value, "id", "") == "drive")
    ]
    assert asked == []
