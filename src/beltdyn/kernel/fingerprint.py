"""Fingerprints of functions outside the package, which its source hash does not cover.

Kernels of the package that call the law of a user are kept on disk under the fingerprint of that law.
"""

import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from beltdyn.kernel.cache import PACKAGE

_SIZE = 12
"""Hexadecimal digits of a fingerprint."""


def is_own(function: Any) -> bool:
    """Whether the code of a function lies outside the package."""
    return not Path(function.__code__.co_filename).is_relative_to(PACKAGE)


def fingerprint(functions: Iterable[Any]) -> str:
    """Fingerprint of functions with all that they refer to: code, constants, other functions, modules."""
    digest, seen = hashlib.sha256(), set[int]()
    for function in functions:
        _add(digest, function, seen)
    return digest.hexdigest()[:_SIZE]


def _add(digest: Any, value: Any, seen: set[int]) -> None:
    """Add a value to a digest; functions and classes of the package by name, for its sources are hashed as a whole."""
    function = getattr(value, "py_func", value)
    if isinstance(function, FunctionType):
        if id(function) not in seen:
            seen.add(id(function))
            _add_function(digest, function, seen)
    elif isinstance(value, ModuleType):
        digest.update(f"module {value.__name__} {_content(getattr(value, '__file__', None))}".encode())
    elif isinstance(value, type):
        digest.update(f"class {value.__qualname__} {getattr(value, '_fields', '')}".encode())
    elif isinstance(value, tuple | list):
        digest.update(f"{type(value).__name__} {len(value)}".encode())
        for one in value:
            _add(digest, one, seen)
    elif hasattr(value, "kernel_for"):  # the types of arguments say which kernel it calls
        digest.update(value.__name__.encode())
    elif hasattr(value, "tobytes"):
        digest.update(repr((value.dtype, value.shape)).encode() + value.tobytes())
    else:
        digest.update(repr(value).encode())


def _add_function(digest: Any, function: FunctionType, seen: set[int]) -> None:
    digest.update(function.__qualname__.encode())
    if not is_own(function):
        return
    _add_code(digest, function.__code__)
    for cell in function.__closure__ or ():
        _add(digest, cell.cell_contents, seen)
    _add(digest, function.__defaults__ or (), seen)
    for name in sorted(names_in(function.__code__)):
        if name in function.__globals__:
            digest.update(name.encode())
            _add(digest, function.__globals__[name], seen)


def _add_code(digest: Any, code: CodeType) -> None:
    digest.update(code.co_code + repr((code.co_names, code.co_varnames)).encode())
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            _add_code(digest, constant)
        else:
            digest.update(repr(constant).encode())


def names_in(code: CodeType) -> set[str]:
    """Names that code looks up, that of inner functions included."""
    inner = (constant for constant in code.co_consts if isinstance(constant, CodeType))
    return set(code.co_names).union(*map(names_in, inner))


@cache
def _content(file: str | None) -> str:
    """Hash of the source of a module; empty without one."""
    try:
        return hashlib.sha256(Path(file or "").read_bytes()).hexdigest()
    except OSError:
        return ""


# Classes of the parameters of users' laws: types of Numba know them by their names alone

_MARKS: dict[type, str] = {}
_NAMED: dict[str, type] = {}


def declare(record: type, mark: str) -> None:
    """Keep kernels that take records of a class under a mark."""
    _MARKS[record], _NAMED[mark] = mark, record


def own_classes() -> bool:
    """Whether there are such classes."""
    return bool(_MARKS)


def mark_of(value: Any) -> str | None:
    """The mark of a class; None of all others."""
    return _MARKS.get(value) if isinstance(value, type) else None


def marked(mark: str) -> type:
    """The class of a mark."""
    return _NAMED[mark]


def marks_in(types: Iterable[Any]) -> set[str]:
    """Marks of the classes in types of Numba."""
    found = set[str]()
    for one in types:
        mark = _MARKS.get(getattr(one, "instance_class", None))  # type: ignore[arg-type]
        found |= {mark} if mark else set()
        inner = getattr(one, "types", None) or ([one.dtype] if hasattr(one, "instance_class") else [])
        found |= marks_in(inner)
    return found
