"""The mesh of runs over time: staying in place, or travelling with the belt."""

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

from beltdyn.elements import ANCF, QUINTIC
from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.simulation import Simulation

FrameName = Literal["staying", "travelling"]
"""The kind of mesh: staying or travelling."""


class Frame(NamedTuple):
    """The mesh of a run over time."""

    name: FrameName
    reason: str
    """The reason; empty for the default."""

    @property
    def stays(self) -> bool:
        """Whether the belt flows through the mesh."""
        return self.name == "staying"

    @property
    def words(self) -> str:
        """The name and the reason."""
        return f"{self.name}, {self.reason}" if self.reason else self.name


def choose_frame(simulation: Simulation, belt: Belt, contact: Contact, is_open: bool) -> Frame:
    """Choose the mesh of a run: staying, unless the drive needs features of the travelling mesh.

    Parameters
    ----------
    simulation, belt, contact
        Parts of the drive.
    is_open
        Whether the belt has ends.
    """
    if simulation.frame is not None:
        return Frame(simulation.frame, "as given")
    misfits = [("simulation", *one[:2]) for one in simulation.misfits_staying]
    reasons = [
        *["the belt is open"] * is_open,
        *(_written(*one) for one in (*misfits, *element_settings(belt, contact))),
    ]
    return Frame("travelling", f"since {reasons[0]}") if reasons else Frame("staying", "")


def element_settings(belt: Belt, contact: Contact) -> Iterator[tuple[str, str, Any]]:
    """Settings of elements and quadrature without effect on a staying mesh: group, key and value."""
    if belt.discretization not in (None, QUINTIC.name):
        yield "belt", "discretization", belt.discretization
    for group, part, keys in (
        ("belt", belt, ("integration", "quadrature_points")),
        ("contact", contact, ("sampling", "integration", "quadrature_points")),
    ):
        for key in keys:
            value = getattr(part, key)
            if value != type(part).model_fields[key].default:
                yield group, key, value


def unused_settings(belt: Belt, contact: Contact) -> list[str]:
    """Settings of elements that a staying mesh does not use, such as 'belt.discretization = "truss"'."""
    return [_written(*one) for one in element_settings(belt, contact)]


def element_of(belt: Belt, frame: Frame) -> str:
    """Name of the elements of a belt on a mesh."""
    return QUINTIC.name if frame.stays else belt.discretization or ANCF.name


def _written(group: str, key: str, value: Any) -> str:
    """A key and its value, as in a drive file."""
    return f'{group}.{key} = "{value}"' if isinstance(value, str) else f"{group}.{key} = {value}"
