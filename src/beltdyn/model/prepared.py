"""A drive prepared for analyses: all that it leaves open, found once."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.contact.friction import FrictionParameters
from beltdyn.elements import QUINTIC, ElementKind
from beltdyn.errors import ModelError
from beltdyn.machines import Goods, MovingTensioner, Support, Tensioner
from beltdyn.machines.carrying.support import OnSpan
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import Carrier, carriers_of, moved
from beltdyn.model.carrying import Stretch, stretch_of, swinging_lengths
from beltdyn.model.completion import take_up
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import Choice, critical_damping
from beltdyn.model.drive import Drive
from beltdyn.model.end import Carriage, End, PathEnd, range_of
from beltdyn.model.installation import Installation, hanging_extremes, span_frequencies
from beltdyn.model.layout import loaded
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.model.resolution import CARRIED_ELEMENTS, SPAN_ELEMENTS, Laid, graded_mesh, layer_length, layer_lengths
from beltdyn.model.simulation import Frame, Simulation
from beltdyn.model.static_estimate import StaticEstimate, TensionerBalance, all_balances, balance_tensioners

_STAYING_POINTS = 8, 12
"""Gauss points of an element that stays, for elastic forces and for contact."""
_AXIS_POINTS = 5, 8
"""The same of an axis, a quarter quicker; the way of a carriage changes by a micrometer."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A drive with all that it leaves open: what solvers, arrays of kernels and results are made of.

    Examples
    --------
    >>> prepared = bd.model.prepare(drive)
    >>> prepared.belt_length, prepared.elements
    (1.2727, 20)
    >>> print(f"{prepared.installation.tension:.1f} N")
    26.6 N
    """

    drive: Drive
    """The drive as given: names, settings, and the text that results keep."""
    frame: Frame
    """Mesh of runs over time, with the reason."""
    belt: Belt
    """The belt with its length, and with the number and kind of elements of that mesh."""
    pulleys: tuple[Pulley, ...]
    """The pulleys where fixed tensioners hold them, with spring-loaded tensioners at zero; speeds and torques are
    counter-clockwise positive."""
    contact: Contact
    """Contact with stiffness, damping and the parameters of friction."""
    tensioners: tuple[Tensioner, ...]
    """The tensioners with their take-up."""
    path: Path
    """The path around these pulleys."""
    carriers: tuple[Carrier, ...]
    """The spring-loaded tensioners with their pulleys."""
    choices: tuple[Choice, ...]
    """Numerical parameters that the drive leaves open, with the reasons of their values."""
    radii: FloatArray
    """Effective radii, m, shape (n,)."""
    rolling_radii: FloatArray
    """Rolling radii of the bent belt without tension, m, shape (n,)."""
    frictions: FloatArray
    """Friction coefficients, with the wedge factor on pulleys on the inside, shape (n,)."""

    def __reduce__(self) -> tuple[Callable[[Drive], "Prepared"], tuple[Drive]]:
        """Travel between processes as the drive, which is prepared there."""
        return prepare, (self.drive,)

    @property
    def simulation(self) -> Simulation:
        """Settings of runs over time."""
        return self.drive.simulation

    @property
    def gravity(self) -> tuple[float, float]:
        """Acceleration of gravity, m/s^2."""
        return self.drive.gravity

    @property
    def ends(self) -> tuple[End, ...]:
        """Ends of an open belt."""
        return self.drive.ends

    @property
    def carriage(self) -> Carriage | None:
        """The carriage of a linear axis, which holds both ends."""
        return self.drive.carriage

    @cached_property
    def carriage_range(self) -> tuple[float, float]:
        """Ways between which the carriage moves, m, by its stroke, a prescribed driver, or the pulleys."""
        assert self.carriage is not None
        return range_of(self.carriage, self.path, self.pulleys, self.simulation.end)

    @property
    def path_ends(self) -> tuple[PathEnd, ...]:
        """Ends of an open belt as its path sees them."""
        return self.drive.path_ends

    @property
    def spans(self) -> tuple[tuple[str, str], ...]:
        """Names of the pulleys or ends at both ends of each span."""
        return self.drive.spans

    @property
    def supports(self) -> tuple[Support, ...]:
        """Idlers and guides along spans."""
        return self.drive.supports

    @property
    def goods(self) -> tuple[Goods, ...]:
        """Goods that spans carry."""
        return self.drive.goods

    @property
    def carries(self) -> bool:
        """Whether spans have supports or goods."""
        return self.drive.carries

    def stretch(self, one: OnSpan) -> Stretch:
        """Where a support or goods lie at rest."""
        return stretch_of(one, self.spans, self.installation.path)

    @property
    def moving_tensioners(self) -> tuple[MovingTensioner, ...]:
        """The spring-loaded tensioners."""
        return tuple(one.tensioner for one in self.carriers)

    @property
    def reference(self) -> int:
        """Number of the reference pulley of slip: the driver, or the first pulley without a driver."""
        return self.drive.reference

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Instants of kinks and jumps in prescribed functions of time, s, ascending."""
        return self.drive.breakpoints

    @property
    def installed_tension(self) -> float | None:
        """Tension at rest that the drive or its nominal position ask for, N; None where the length gives it.

        A tensioner of a belt that carries meets its nominal position by the estimated length: weight along slopes
        changes the tension, and not the length.
        """
        if self.carries and self.drive.layout.nominal is not None:
            return None
        return self.drive.layout.given.belt.installed_tension

    @property
    def belt_length(self) -> float:
        """Unstretched length of the belt, m."""
        return self.belt.given_length

    @property
    def elements(self) -> int:
        """Number of elements."""
        return self.belt.given_elements

    @property
    def element_kind(self) -> ElementKind:
        """Kind of the elements."""
        return self.belt.element_kind

    @property
    def contact_stiffness(self) -> float:
        """Contact stiffness, N/m^2."""
        return self.contact.given("stiffness")

    @property
    def contact_damping(self) -> float:
        """Contact damping, N s/m^2."""
        return self.contact.given("damping")

    @property
    def critical_damping(self) -> float:
        """Critical contact damping of the belt pressed on a pulley, N s/m^2."""
        return critical_damping(self.contact_stiffness, self.belt.mass_per_length)

    @property
    def friction_parameters(self) -> FrictionParameters:
        """Parameters of the friction law."""
        return self.contact.friction_parameters

    @property
    def loaded_belt(self) -> Belt:
        """The belt, with its tension at rest if a pulled end sets it."""
        return loaded(self.belt, self.path_ends)

    @cached_property
    def _balance(self) -> tuple[StaticEstimate, FloatArray]:
        """Estimate of the belt and the tensioners at rest; see `balance_tensioners`."""
        return balance_tensioners(self.path, self.loaded_belt, self.contact, self.carriers)

    @property
    def tension_at_rest(self) -> float:
        """Estimate of the tension at rest, without weight and bending, N."""
        return self._balance[0].tension

    @cached_property
    def installation(self) -> Installation:
        """Estimate of the belt at rest, without weight and bending; see `install`."""
        estimate, positions = self._balance
        path = estimate.path
        turned = path.span_directions[path.leaving] - path.span_directions[path.reaching]
        tensions = np.full(path.spans, estimate.tension)
        return self.installed(tensions, estimate.penetrations.copy(), estimate.tension * turned, positions.copy())

    def installed(
        self,
        span_tensions: FloatArray,
        penetrations: FloatArray,
        hub_loads: FloatArray,
        positions: FloatArray,
        end_tensions: FloatArray | None = None,
        extreme_tensions: FloatArray | None = None,
    ) -> Installation:
        """Describe the belt at rest in some state: arrays as those of an `Installation`; by default without weight."""
        if end_tensions is None:
            end_tensions = np.repeat(span_tensions[:, None], 2, axis=1)
        belt, path = self.belt, moved(self.path, self.carriers, positions)
        laid, hanging = path.length / self.belt_length, swinging_lengths(self.supports, self.spans, path)
        if extreme_tensions is None:
            weight = belt.mass_per_length * np.array(self.gravity)
            extreme_tensions = hanging_extremes(end_tensions, path, weight, hanging)
        return Installation(
            strain=laid - 1,
            laid_tension=float(belt.stretch_parameters.tension(laid)),
            tension=float(span_tensions.mean()),
            span_tensions=span_tensions,
            end_tensions=end_tensions,
            extreme_tensions=extreme_tensions,
            penetrations=penetrations,
            tensioner_positions=positions,
            path=path,
            hub_loads=hub_loads,
            span_frequencies=span_frequencies(belt, path, span_tensions, self.gravity, hanging),
        )

    @cached_property
    def layer(self) -> float:
        """Length over which the belt at rest takes on the curvature of a pulley, m."""
        tension = self.installation.tension
        if not tension > 0.0:
            raise ModelError(
                "the belt has no tension at rest: its tensioners let it hang slack. Increase the preload, or shorten "
                "the belt."
            )
        return layer_length(*layer_lengths(self, tension))

    @cached_property
    def gripping(self) -> BoolArray:
        """Whether friction is to carry the load of each pulley: not by teeth, and no guide, shape (n,)."""
        return ~(self.toothed | self.drive.guides)

    @cached_property
    def toothed(self) -> BoolArray:
        """Which pulleys hold the belt by its teeth, shape (pulleys,)."""
        return np.array([pulley.teeth is not None for pulley in self.pulleys])

    @cached_property
    def laid(self) -> Laid:
        """The belt on its path, with the tensioners as they are at rest."""
        return self.laid_on(self.installation.path)

    def laid_on(self, path: Path) -> Laid:
        """The belt on a path like its own, from the middle of its longest span at rest."""
        return Laid.on(path, self.belt_length, self.installation.path.longest_span)

    @cached_property
    def on_staying_mesh(self) -> tuple[Belt, Contact]:
        """Belt and contact on a staying mesh, of any elements; hysteresis of bending is apart, point by point."""
        elastic, contact = _STAYING_POINTS if self.carriage is None else _AXIS_POINTS
        belt = self.belt.replace(
            discretization=QUINTIC.name,
            elements=None,
            integration="full",
            quadrature_points=elastic,
            bending_loss_factor=0.0,
        )
        return belt, self.contact.replace(sampling="distributed", integration="zone", quadrature_points=contact)

    def equal_lengths(self, elements: int) -> FloatArray:
        """Lengths of equal elements, m."""
        return np.full(elements, self.belt_length / elements)

    def graded_lengths(self, fineness: float) -> FloatArray:
        """Lengths of elements graded towards the ends of arcs of the belt at rest, m; see `graded_mesh`."""
        return graded_mesh(self.belt_length, self.laid.arcs(), self.layer, fineness, self.elements_per_span)

    @property
    def elements_per_span(self) -> int:
        """Least elements per span at a fineness of 1."""
        return CARRIED_ELEMENTS if self.carries else SPAN_ELEMENTS

    def over(self, simulation: Simulation) -> "Prepared":
        """The same drive with other instants of output: nothing else follows from these."""
        return replace(self, drive=self.drive.model_copy(update={"simulation": simulation}))

    def replace(self, **changes: Any) -> "Prepared":
        """Prepare the drive with other arguments."""
        return prepare(self.drive.replace(**changes))

    def tightened(self, distance: float) -> "Prepared":
        """Prepare the drive with a length in place of an installed tension, or a take-up if the length is given.

        Parameters
        ----------
        distance : float
            By how much to shorten the belt that is estimated, or to lengthen its path, m; negative to loosen it.

        Raises
        ------
        ModelError
            If no such belt can run around the pulleys.
        """
        belt, tensioners, given = self.belt, self.drive.tensioners, self.drive.belt
        if given.length is None:
            belt = belt.replace(length=self.belt_length - distance)
        else:
            tensioners = self.taken_up(distance)
        belt = belt.replace(discretization=given.discretization)
        return self.replace(belt=belt, contact=self.contact, tensioner=tensioners)

    def with_length(self, length: float) -> "Prepared":
        """Prepare the drive with an unstretched length of its belt, m, in place of what gave it."""
        belt = self.belt.replace(length=length, discretization=self.drive.belt.discretization)
        return self.replace(belt=belt, contact=self.contact)

    def taken_up(self, distance: float) -> tuple[Tensioner, ...]:
        """The tensioners, with the take-up of the fixed one increased so that the path is longer by a distance, m."""
        return take_up(self.drive.completed, distance)


def prepare(drive: Drive) -> Prepared:
    """Find all that a drive leaves open, once: analyses work on what this gives.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    Prepared
        The belt with its length and elements, contact with its numbers, the path, and an estimate of the belt at rest.

    Examples
    --------
    >>> open_drive = drive.replace(contact=bd.Contact(friction=0.3))
    >>> [choice.key for choice in bd.model.prepare(open_drive).choices][:2]
    ['contact.stiffness', 'contact.damping']
    """
    completed = drive.completed
    return Prepared(
        drive=drive,
        frame=drive.frame,
        belt=completed.belt,
        pulleys=drive.with_counter_clockwise_positive(completed.pulleys),
        contact=completed.contact,
        tensioners=completed.tensioners,
        path=completed.path,
        carriers=tuple(carriers_of(completed.tensioners, [one.name for one in drive.pulleys], completed.path)),
        choices=completed.choices,
        radii=drive.radii,
        rolling_radii=drive.rolling_radii,
        frictions=drive.frictions,
    )


def install(drive: Drive) -> Installation:
    """Estimate tension, penetration and tensioner positions for the belt at rest.

    `beltdyn.model.static_estimate` has the equations, which leave out bending stiffness and weight;
    `beltdyn.state.installation.bring_to_rest` finds static equilibrium.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    Installation

    Examples
    --------
    >>> round(bd.model.install(drive).tension, 1)  # N
    26.6
    """
    return prepare(drive).installation


def tensioner_balances(drive: Drive, installation: Installation) -> tuple[tuple[TensionerBalance, ...], ...]:
    """Find all equilibrium positions of each spring-loaded tensioner, with the others held.

    Parameters
    ----------
    drive : Drive
    installation : Installation
        The belt at rest.

    Returns
    -------
    tuple of tuples of TensionerBalance
        For each tensioner, in ascending order of the positions; without bending stiffness and weight.

    Examples
    --------
    >>> bd.model.tensioner_balances(drive, bd.model.install(drive))  # it has no tensioners
    ()
    """
    one = prepare(drive)
    return all_balances(one.path, one.loaded_belt, one.contact, one.carriers, installation.tensioner_positions)
