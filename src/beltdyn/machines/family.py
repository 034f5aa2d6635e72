"""The kinds of a family of machines, such as loads, collected from the module that imports them."""

from collections.abc import Mapping
from types import ModuleType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import numpy as np
from pydantic import Field

from beltdyn.parts.part import Part


def kinds_in(module: ModuleType) -> dict[str, Any]:
    """Collect the kinds that a module imports."""
    found = [one for one in vars(module).values() if isinstance(one, type) and issubclass(one, Part)]
    return {_kind(one): one for one in found}


def _kind(part: type[Part]) -> str:
    """Text by which a user chooses a kind of part."""
    annotation = part.model_fields["kind"].annotation
    assert get_origin(annotation) is Literal
    return str(get_args(annotation)[0])


def any_of(kinds: Mapping[str, Any]) -> Any:
    """Type of a field for any of some kinds."""
    return Annotated[Union[tuple(kinds.values())], Field(discriminator="kind")]  # noqa: UP007


def constants_of(kinds: Mapping[str, Any]) -> dict[str, np.dtype[np.void]]:
    """Fields of a row for the constants of any of some kinds."""
    return {name: kind.constants for name, kind in kinds.items()}
