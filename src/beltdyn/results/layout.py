"""Layout of recorded data: names and reference coordinates of all dimensions except time."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.results.friction_work import ARC_PARTS, arc_shares
from beltdyn.results.schema import AXIS_NAMES, COORDINATES, RECORDED, Variable


@dataclass(frozen=True, eq=False)
class Layout:
    """Names and reference coordinates of recorded data.

    Attributes
    ----------
    pulleys : tuple of str
        Names of the pulleys.
    spans : tuple of str
        Names of the spans, "driver-driven" for the one from driver to driven.
    node_coordinate : ndarray, shape (nodes,)
        Belt coordinate of the nodes in the unstretched belt, m.
    element_coordinate : ndarray, shape (elements,)
        Belt coordinate of the elements' middles in the unstretched belt, m.
    belt_coordinate : ndarray, shape (contact_points,)
        Belt coordinate of the contact points in the unstretched belt, m.
    coordinate_names : tuple of str
        Names of the coordinates of a node.
    tensioners : tuple of str
        Names of the pulleys carried by tensioners, in the order of their coordinates.
    bodies : tuple of str
        Names of all bodies other than the belt, in the order of the coordinates.
    """

    pulleys: tuple[str, ...]
    spans: tuple[str, ...]
    node_coordinate: FloatArray
    element_coordinate: FloatArray
    belt_coordinate: FloatArray
    coordinate_names: tuple[str, ...]
    tensioners: tuple[str, ...] = ()
    bodies: tuple[str, ...] = ()

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.node_coordinate)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.element_coordinate)

    @property
    def contact_points(self) -> int:
        """Number of points at which contact is recorded."""
        return len(self.belt_coordinate)

    @property
    def coordinates(self) -> dict[str, NDArray[Any]]:
        """Every coordinate of the dataset but times, by name; those along a dimension of size zero are left out."""
        values: Mapping[str, Any] = {
            "pulley": self.pulleys,
            "span": self.spans,
            "tensioner": self.tensioners,
            "body": self.bodies,
            "axis": AXIS_NAMES,
            "coordinate": self.coordinate_names,
            "node_coordinate": self.node_coordinate,
            "element_coordinate": self.element_coordinate,
            "belt_coordinate": self.belt_coordinate,
            "arc_share": arc_shares(),
        }
        return {name: np.asarray(value, COORDINATES[name].dtype) for name, value in values.items() if len(value)}

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Size of every dimension but times; those of size zero are left out."""
        sizes = {
            "pulley": len(self.pulleys),
            "span": len(self.spans),
            "tensioner": len(self.tensioners),
            "body": len(self.bodies),
            "axis": len(AXIS_NAMES),
            "coordinate": len(self.coordinate_names),
            "node": self.nodes,
            "element": self.elements,
            "contact_point": self.contact_points,
            "arc_part": ARC_PARTS,
        }
        return {name: size for name, size in sizes.items() if size}

    @cached_property
    def recorded(self) -> dict[str, Variable]:
        """The variables of `RECORDED` without those that have a dimension of size zero."""
        sizes = self.sizes
        return {name: variable for name, variable in RECORDED.items() if all(dim in sizes for dim in variable.dims[1:])}

    def shape(self, variable: Variable, outputs: int) -> tuple[int, ...]:
        """Shape of a variable.

        Parameters
        ----------
        variable : Variable
            A variable over time.
        outputs : int
            Number of instants.

        Returns
        -------
        tuple of int
            ``(outputs, ...)``.
        """
        sizes = self.sizes
        return (outputs, *(sizes[dim] for dim in variable.dims[1:]))
