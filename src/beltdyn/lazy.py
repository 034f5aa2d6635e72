"""Names of a package that are imported at their first use, listed in a stub file.

So type checkers and the program read one list.  A line ``from .loads import *`` stands for the names that the
package `loads` imports in its ``__init__.py`` as ``from ... import Name as Name``.
"""

import ast
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any


class LazyNames(Mapping[str, Any]):
    """The names of a stub file, imported on demand relative to `package`."""

    def __init__(self, package: str, stub: Path) -> None:
        self._places = dict(_imported(ast.parse(stub.read_text(encoding="utf-8")), package))

    def __getitem__(self, name: str) -> Any:
        module, attribute = self._places[name]
        found = import_module(module)
        return found if not attribute else getattr(found, attribute)

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)


@cache
def public_names() -> LazyNames:
    """Those of the package."""
    return LazyNames("beltdyn", Path(__file__).with_name("__init__.pyi"))


def _imported(tree: ast.Module, package: str) -> Iterator[tuple[str, tuple[str, str]]]:
    """Names that a file imports, with the module and the attribute that each of them is."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom):
            continue
        module = f"{package}.{node.module}" if node.level and node.module else node.module or package
        for alias in node.names:
            if alias.name == "*":
                yield from ((name, (module, name)) for name in _exported(module))
            elif node.module is None:  # from . import module
                yield alias.name, (f"{module}.{alias.name}", "")
            elif not node.module.startswith("typing"):
                yield alias.asname or alias.name, (module, alias.name)


def _exported(module: str) -> list[str]:
    """Names that the ``__init__.py`` of a package of ours passes on, without importing it."""
    folder = Path(__file__).parent.joinpath(*module.split(".")[1:])
    tree = ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))
    imports = (node for node in tree.body if isinstance(node, ast.ImportFrom))
    return [alias.name for node in imports for alias in node.names if alias.asname == alias.name]
