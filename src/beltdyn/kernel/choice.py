"""A kernel that dispatches a row of a table to the function of its kind."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from beltdyn.kernel.decorator import kernel


def choice(name: str, functions: Mapping[str, Callable[..., Any]], others: Sequence[str]) -> Callable[..., Any]:
    """Make a kernel that calls one of several by kind.

    Parameters
    ----------
    name
        Its name.
    functions
        Kernels by the names of their kinds.  All take a row of their kind and the other arguments, and return the
        same types.
    others
        Names of the other arguments.

    Returns
    -------
    Callable
        A kernel ``name(row, *others)``.  The field `kind` of the row is a place among the functions, and for every
        kind the row has a field of that name, the row that the function gets.
    """
    arguments = ", ".join(others)
    lines = [f"def {name}(row, {arguments}):"]
    for number, kind in enumerate(functions):
        condition = f"if row.kind == {number}: " if number < len(functions) - 1 else ""
        lines.append(f"    {condition}return of_{kind}(row.{kind}, {arguments})")
    namespace: dict[str, Any] = {f"of_{kind}": function for kind, function in functions.items()}
    namespace["__name__"] = __name__
    exec(compile("\n".join(lines), __file__, "exec"), namespace)
    return kernel(inline=True)(namespace[name])
