"""The changes of a source file: what is changed, into what, and what is left alone."""

import ast
import copy
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Div,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
}
BOUNDARY: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
}
OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
LEFT_ALONE = (ast.Raise, ast.Assert, ast.JoinedStr)
"""What is raised, and texts: other tests read them."""
FIELDS_LEFT_ALONE = {"decorator_list", "annotation", "returns", "bases", "type_params"}
MAX_GUARD = 1e-9
"""Largest float that only guards a division or a comparison against rounding: twice as much has the same effect."""


@dataclass
class Mutant:
    """One change of one file.

    Attributes
    ----------
    file : str
        Path of the file below the root of the repository.
    line : int
        Line of the change.
    before, after : str
        The expression or statement, as it was and as it is.
    number : int
        Place among the changes of the file.
    at_import : bool
        Whether the code runs when its module is imported, outside the body of a function, or fits into no function
        that is imported.
    outcome : str
        "killed", "survived", or "untested" where no test executes the line, or imports its file.
    killed_by : str
        Id of the test that failed, or "time" where the tests did not end.
    """

    file: str
    line: int
    before: str
    after: str
    number: int
    at_import: bool
    outcome: str = ""
    killed_by: str = ""

    def __str__(self) -> str:
        return f"{self.outcome:8s} {self.file}:{self.line}  {self.before}  ->  {self.after}"


@dataclass
class _Place:
    """Where a node stands: field ``name`` of ``parent``, at ``index`` where that is a list."""

    parent: ast.AST
    name: str
    index: int | None
    node: ast.AST
    at_import: bool

    def put(self, node: ast.AST) -> None:
        if self.index is None:
            setattr(self.parent, self.name, node)
        else:
            getattr(self.parent, self.name)[self.index] = node


def mutants_of(path: Path, root: Path) -> Iterator[tuple[Mutant, ast.Module]]:
    """All changes of a file.

    Parameters
    ----------
    path : Path
        The file.
    root : Path
        Folder to which `Mutant.file` is relative.

    Yields
    ------
    tuple[Mutant, ast.Module]
        A change, and the changed tree, which holds until the next one is asked for.
    """
    tree = ast.parse(path.read_text(encoding="utf-8"))
    file, continuous = path.relative_to(root).as_posix(), has_kernels(path)
    places = _places(tree, at_import=True)
    changes = [(place, change) for place in places for change in _changes(place.node, continuous)]
    for number, (place, change) in enumerate(changes):
        ast.fix_missing_locations(ast.copy_location(change, place.node))
        place.put(change)
        line = getattr(place.node, "lineno", 0)
        yield Mutant(file, line, _text(place.node), _text(change), number, place.at_import), tree
        place.put(place.node)


def has_kernels(path: Path) -> bool:
    """Whether a file makes compiled functions, or chooses among them."""
    return re.search(r"^@kernel\b|\b(by_type|choice)\(", path.read_text(encoding="utf-8"), re.MULTILINE) is not None


def control(path: Path, root: Path, lines: set[int]) -> tuple[Mutant, ast.Module] | None:
    """Let a function raise an error, which a test of any of its lines must notice.

    Parameters
    ----------
    path : Path
        The file.
    root : Path
        Folder to which `Mutant.file` is relative.
    lines : set[int]
        Lines that tests execute.

    Returns
    -------
    tuple[Mutant, ast.Module] or None
        The change, and the changed tree; nothing where no test executes a line of a function.
    """
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and (first := _first_line(node)) in lines:
            error = ast.parse("raise RuntimeError('control')").body[0]
            node.body.insert(0, ast.copy_location(error, node.body[0]))
            ast.fix_missing_locations(tree)
            return Mutant(path.relative_to(root).as_posix(), first, f"def {node.name}", "raise", -1, False), tree
    return None


def _first_line(function: ast.FunctionDef) -> int:
    """First line that a call executes."""
    has_docstring = ast.get_docstring(function) is not None and len(function.body) > 1
    return function.body[has_docstring].lineno


def _places(parent: ast.AST, at_import: bool) -> Iterator[_Place]:
    """Expressions and statements below a node that may be changed."""
    for name, value in ast.iter_fields(parent):
        if name in FIELDS_LEFT_ALONE:
            continue
        inside = name == "body" and isinstance(parent, ast.FunctionDef | ast.Lambda)
        for index, node in enumerate(value) if isinstance(value, list) else [(None, value)]:
            if isinstance(node, ast.AST) and not _left_alone(node):
                yield _Place(parent, name, index, node, at_import and not inside)
                yield from _places(node, at_import and not inside)


def _left_alone(node: ast.AST) -> bool:
    """Whether nothing below a node is changed; ``strict`` of `zip` is an assertion."""
    for_types = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    asserts = isinstance(node, ast.keyword) and node.arg == "strict"
    return for_types or asserts or isinstance(node, LEFT_ALONE)


def _changes(node: ast.AST, continuous: bool) -> Iterator[ast.AST]:
    """Changed copies of a node; in kernels laws are ``continuous``."""
    match node:
        case ast.BinOp(op=op) | ast.AugAssign(op=op) if type(op) in ARITHMETIC:
            yield _with(node, op=ARITHMETIC[type(op)]())
        case ast.Compare(ops=[op]):
            tables = (OPPOSITE,) if _meets_by_chance(node, continuous) else (BOUNDARY, OPPOSITE)
            yield from (_with(node, ops=[table[type(op)]()]) for table in tables if type(op) in table)
        case ast.BoolOp(op=ast.And()):
            yield _with(node, op=ast.Or())
        case ast.BoolOp():
            yield _with(node, op=ast.And())
        case ast.UnaryOp(op=ast.USub() | ast.Not()):
            yield node.operand
        case ast.If() | ast.IfExp() | ast.While() if not isinstance(node.test, ast.Compare):
            yield _with(node, test=ast.copy_location(ast.UnaryOp(ast.Not(), node.test), node.test))
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield ast.Constant(value + 1)
        case ast.Constant(value=float(value)) if not 0.0 < value <= MAX_GUARD:
            yield ast.Constant(2.0 * value or 1.0)
        case ast.Expr(value=ast.Call()):
            yield ast.Pass()
        case ast.Continue():
            yield ast.Break()


def _meets_by_chance(comparison: ast.Compare, continuous: bool) -> bool:
    """Whether both sides are equal by chance alone: a computed number and a decimal.

    Zero counts in kernels, whose laws are continuous; elsewhere it often is a setting that turns something off.
    """
    sides = [comparison.left, *comparison.comparators]
    literals = [side.operand if isinstance(side, ast.UnaryOp) else side for side in sides]
    decimals = [each.value for each in literals if isinstance(each, ast.Constant) and isinstance(each.value, float)]
    return any(value != 0.0 or continuous for value in decimals)


def _with(node: ast.AST, **changes: Any) -> ast.AST:
    changed = copy.copy(node)
    for name, value in changes.items():
        setattr(changed, name, value)
    return changed


def _text(node: ast.AST) -> str:
    return ast.unparse(node).splitlines()[0][:100]
