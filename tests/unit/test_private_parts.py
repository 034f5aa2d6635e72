"""No private parts of other libraries, but of Numba in `kernel`, where the plain way stands beside them."""

import ast
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src" / "beltdyn"
DOCUMENTED = {"_replace", "_asdict", "_fields", "_make", "_exit", "_getframe", "_thread"}
"""Public methods of named tuples, `os._exit`, `sys._getframe` and `_thread`: each is in the documentation of Python."""
BARE_SCRIPTS = "designs/processes.py"
"""Processes of a batch see an empty script in place of a caller's, which each of them would run otherwise."""


def is_private(name: str) -> bool:
    return name.startswith("_") and not (name.startswith("__") and name.endswith("__"))


def defined(tree: ast.AST) -> Iterator[str]:
    """Names of functions, classes, attributes and variables that a module makes itself."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Attribute(attr=name, ctx=ast.Store()) | ast.Name(id=name, ctx=ast.Store()):
                yield name


def used(tree: ast.AST) -> Iterator[str]:
    """Private attributes, and private modules and names that are imported."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr=name):
                yield name
            case ast.Call(func=ast.Name(id="getattr" | "setattr"), args=[_, ast.Constant(value=str(name)), *_]):
                yield name
            case ast.ImportFrom(module=module, names=names):
                yield from (module or "").split(".")
                yield from (one.name for one in names)
            case ast.Import(names=names):
                yield from (part for one in names for part in one.name.split("."))


def test_no_private_parts_of_other_libraries() -> None:
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in SOURCE.rglob("*.py")}
    ours = {name for tree in trees.values() for name in defined(tree)} | DOCUMENTED
    foreign = {
        f"{path.relative_to(SOURCE).as_posix()}: {name}"
        for path, tree in trees.items()
        if path.parent.name != "kernel"
        for name in used(tree)
        if is_private(name) and name not in ours
    }
    assert foreign == set()


def test_the_script_of_a_caller_is_left_alone() -> None:
    for path in SOURCE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert 'modules["__main__"]' not in text or path == SOURCE / BARE_SCRIPTS
