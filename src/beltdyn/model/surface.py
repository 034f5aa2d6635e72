"""Surfaces of pulleys other than smooth circles, a part for each kind."""

from typing import TYPE_CHECKING, Annotated, Any, Literal, Union

from pydantic import Field, create_model

from beltdyn.contact.parameter import Parameter
from beltdyn.contact.surface import KINDS, SurfaceKind
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import quantity


class Surface(Part):
    """A surface other than a smooth circle, which turns with its pulley."""

    if TYPE_CHECKING:  # the field that tells the kinds apart
        kind: str

        def __init__(self, **keys: Any) -> None: ...

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of its kind, by name."""
        return {parameter.name: getattr(self, parameter.name) for parameter in KINDS[self.kind].parameters}

    @property
    def reach(self) -> float:
        """Largest deviation beyond the effective radius, m."""
        return KINDS[self.kind].reach(self.parameters)


def _field(parameter: Parameter) -> Any:
    """Field of a parameter."""
    meaning = f"{parameter.meaning}, in {parameter.unit}" if parameter.unit else parameter.meaning
    default: dict[str, Any] = {} if parameter.default is None else {"default": parameter.default}
    return Annotated[float, quantity(parameter.unit)], Field(gt=parameter.above, description=meaning, **default)


def _part(kind: SurfaceKind) -> type[Surface]:
    """Part of a kind of surface."""
    fields = {parameter.name: _field(parameter) for parameter in kind.parameters}
    title = "".join(word.capitalize() for word in kind.name.split("_"))
    named: Any = (Literal[kind.name], Field(kind.name, description="the kind of surface"))
    part: type[Surface] = create_model(f"{title}Surface", __base__=Surface, kind=named, **fields)
    return part


SURFACES = {kind.name: _part(kind) for kind in KINDS.values()}
"""Parts of surfaces by the names of their kinds."""

if TYPE_CHECKING:
    AnySurface = Surface
else:
    AnySurface = Annotated[Union[tuple(SURFACES.values())], Field(discriminator="kind")]  # noqa: UP007
