"""Constants of a module have one value each, and a docstring below says quantity, unit and reason."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

import beltdyn

SOURCES = Path(beltdyn.__file__).parent
PACKAGES = sorted(folder.name for folder in SOURCES.iterdir() if (folder / "__init__.py").is_file())


def is_numeric(value: ast.expr | None) -> bool:
    """Whether an expression is a number, or a tuple of numbers; pi and converted angles too."""
    match value:
        case ast.Constant(value=bool()):
            return False
        case ast.Constant(value=int() | float()):
            return True
        case ast.UnaryOp(operand=operand):
            return is_numeric(operand)
        case ast.BinOp(left=left, right=right):
            return is_numeric(left) and is_numeric(right)
        case ast.Tuple(elts=elements):
            return bool(elements) and all(map(is_numeric, elements))
        case ast.Attribute(attr="pi"):
            return True
        case ast.Call(func=ast.Attribute(attr="radians" | "deg2rad"), args=[angle]):
            return is_numeric(angle)
    return False


def constants(text: str) -> Iterator[tuple[str, bool]]:
    """The numeric constants of a module, and whether there is a docstring below each."""
    body = ast.parse(text).body
    for statement, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(statement, ast.Assign | ast.AnnAssign) and is_numeric(statement.value):
            match after:
                case ast.Expr(value=ast.Constant(value=str(words))):
                    yield ast.unparse(statement), bool(words.strip())
                case _:
                    yield ast.unparse(statement), False


@pytest.mark.parametrize("package", PACKAGES)
def test_constants_have_docstrings(package: str) -> None:
    files = sorted((SOURCES / package).rglob("*.py"))
    every = [
        (f"{file.relative_to(SOURCES)}: {constant}", documented)
        for file in files
        for constant, documented in constants(file.read_text(encoding="utf-8"))
    ]
    assert every
    assert [constant for constant, documented in every if not documented] == []


@pytest.mark.parametrize(
    "constant",
    [
        "_COUNT = 3",
        "_LIMIT: Final = -1e-6",
        "_LIMIT: float = 2.0",
        "_ANGLE = np.radians(60.0)",
        "_DEGREES = 180.0 / np.pi",
        "_SIZE = (8.0, 7.5)",
        "_LOW, _HIGH = 0.1, 0.9",
        "_FIRST = _SECOND = 4",
        "_LEVELS = ((0, 1), (2, 3.0))",
    ],
)
def test_a_constant_without_docstring_is_noticed(constant: str) -> None:
    documented = f'{constant}\n"""Number of elements."""\n'
    assert [found for _, found in constants(documented)] == [True]
    assert [found for _, found in constants(f"{constant}\n{documented}")] == [False, True]
    assert [found for _, found in constants(f"{constant}\n# Number of elements.\n")] == [False]
    assert [found for _, found in constants(f'{constant}\n""" """\n')] == [False]


@pytest.mark.parametrize(
    "other", ["_TITLE = 'a'", "_USED = True", "_NAMES = ('a', 'b')", "_NONE = ()", "_DEPTH = depth(3)"]
)
def test_other_constants_are_left_alone(other: str) -> None:
    assert list(constants(other)) == []


def redefined(text: str) -> list[str]:
    """Names that a module assigns more than once: functions above use the last value too."""
    body = ast.parse(text).body
    targets = [target for statement in body if isinstance(statement, ast.Assign) for target in statement.targets]
    targets += [statement.target for statement in body if isinstance(statement, ast.AnnAssign) and statement.value]
    nodes = [node for target in targets for node in ast.walk(target) if isinstance(node, ast.Name)]
    names = [node.id for node in nodes if isinstance(node.ctx, ast.Store) and node.id.isupper()]
    return [name for name, count in Counter(names).items() if count > 1]


def test_no_constant_is_defined_twice() -> None:
    every = {
        str(file.relative_to(SOURCES)): redefined(file.read_text(encoding="utf-8")) for file in SOURCES.rglob("*.py")
    }
    assert len(every) > 100
    assert {file: names for file, names in every.items() if names} == {}


@pytest.mark.parametrize(
    "again", ["_ROOM = 0.3", "_ROOM, _WIDTH = 0.3, 0.6", "_ROOM: Final = 0.3", "_WIDTH = _ROOM = 1"]
)
def test_a_constant_that_is_defined_twice_is_noticed(again: str) -> None:
    assert redefined(f"_ROOM = 0.8\n{again}\n") == ["_ROOM"]
    assert redefined(again) == []
