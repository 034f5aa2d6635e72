"""The drive: belt, pulleys, contact and settings of the simulation."""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from importlib import import_module
from typing import Any, ClassVar, Self

import numpy as np
import tomli_w
from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.contact.friction import FrictionParameters
from beltdyn.elements import ELEMENTS, ElementKind
from beltdyn.errors import ModelError
from beltdyn.machines import Goods, MovingTensioner, Tensioner
from beltdyn.machines.carrying import AnySupport
from beltdyn.machines.tensioners import AnyTensioner
from beltdyn.model.as_supplied import Rotation, as_supplied
from beltdyn.model.belt import Belt
from beltdyn.model.belt_loads import BeltLoads
from beltdyn.model.carrying import check_carrying, check_lift
from beltdyn.model.completion import Completed, complete
from beltdyn.model.contact import Contact
from beltdyn.model.end import AnyEnd, Carriage, End, PathEnd, check_carriage, ends_on_path
from beltdyn.model.layout import Given, Layout, check_speeds, check_teeth, lay_out
from beltdyn.model.nip import Nip, on_slides, rim_ratios
from beltdyn.model.parameter_study import DutyPoint, check_duty
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, friction_on, refuse_functions
from beltdyn.model.rating import RatedBelt
from beltdyn.model.resolution import AXIS_FINENESS, FINENESS
from beltdyn.model.routing import radii, span_names
from beltdyn.model.sheet_head import SheetHead
from beltdyn.model.simulation import Frame, Limits, Simulation, Steady, choose_frame, element_of
from beltdyn.model.toothing import DISCRETE, RatedTeeth
from beltdyn.model.web import Unwinder, Winder, check_rollers
from beltdyn.parts.change import carry_tolerances, changed_arguments, tolerances_of, with_tolerances
from beltdyn.parts.kind_fields import Chosen, chosen_kinds, refuse_kinds_of_scripts
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Acceleration, Title, Words
from beltdyn.parts.text_file import parse_toml

_MOST_NAMED = 8
"""Pulleys that a drive names where it says what it is."""


class Drive(Part):
    """A belt drive, validated, with all derived values.

    The constructor's arguments are `belt`, `pulley` (a list of pulleys, counter-clockwise), `contact`, `tensioner`,
    `end`, `support`, `goods` and `duty` (lists), `simulation`, `steady`, `limits` and `sheet`, each a part or a mapping
    of its arguments, `gravity`, `rotation`, and `name` and `description`.

    The parts hold only the given values, from which copies (`replace`) and files are made. Derived values are
    attributes of the drive: `belt_length`, also if the tension is given instead; `path` and `centers`, with pulleys of
    fixed tensioners in place; `elements`, `contact_stiffness`, `contact_damping` and `friction_parameters`, also if the
    file omits these numerical parameters. `prepare` gives all of it at once, with the reasons.

    Examples
    --------
    >>> drive.title, drive.belt_length, [pulley.name for pulley in drive.pulleys]
    ('Belt drive', 1.2727, ['driver', 'driven'])
    >>> drive.replace(name="Fan drive").title
    'Fan drive'
    """

    fills_a_file: ClassVar[bool] = True

    name: Title | None = Field(
        None, description="the name of the drive, for titles and summaries, instead of the file name"
    )
    description: Words | None = Field(None, description="a description of the drive, for readers of the file")
    project: Title | None = Field(None, description="the project or order to which the drive belongs, for reports")
    author: Title | None = Field(None, description="the author of the calculation, for reports")
    belt: Belt = Field(description="the group [belt]")
    pulleys: tuple[Pulley, ...] = Field(
        alias="pulley",
        max_length=1000,
        description="the groups [[pulley]], in belt order, either way round",
    )
    contact: Contact = Field(default_factory=Contact, description="the group [contact]")
    tensioners: tuple[AnyTensioner, ...] = Field((), alias="tensioner", description="the groups [[tensioner]]")
    given_ends: tuple[AnyEnd, ...] = Field(
        (), alias="end", description="the groups [[end]], first and second, of an open belt"
    )
    carriage: Carriage | None = Field(
        None, description="the group [carriage], to which both ends of the belt of a linear axis are clamped"
    )
    supports: tuple[AnySupport, ...] = Field(
        (), alias="support", description="the groups [[support]], idlers and guides along spans"
    )
    nips: tuple[Nip, ...] = Field(
        (), alias="nip", description="the groups [[nip]], pairs of pulleys that press the belt between them"
    )
    goods: tuple[Goods, ...] = Field((), description="the groups [[goods]], goods that spans carry")
    unwinder: Unwinder | None = Field(None, description="the group [unwinder], where the web of a line enters")
    winder: Winder | None = Field(None, description="the group [winder], where the web of a line leaves")
    duty: tuple[DutyPoint, ...] = Field(
        (), description="the groups [[duty]], operating points with their shares of time"
    )
    simulation: Simulation = Field(default_factory=Simulation, description="the group [simulation]")
    steady: Steady = Field(default_factory=Steady, description="the group [steady], the mesh of steady running")
    limits: Limits = Field(
        default_factory=Limits, description="the group [limits], limits of results for reports; none by default"
    )
    sheet: SheetHead = Field(
        default_factory=SheetHead, description="the group [sheet], customer, position and order for sheets and reports"
    )
    rotation: Rotation = Field(
        "counter-clockwise",
        description="the sense of rotation in which speeds and torques of pulleys, loads and motors are positive",
    )
    gravity: tuple[Acceleration, Acceleration] = Field(
        (0.0, 0.0), description="the acceleration of gravity as [x, y], in m/s^2"
    )
    _source: str | None = PrivateAttr(None)

    def __repr__(self) -> str:
        names = [pulley.name for pulley in self.pulleys]
        pulleys = ", ".join(names) if len(names) <= _MOST_NAMED else f"{len(names)} pulleys"
        tension = self.belt.installed_tension if self.belt.length is None else None
        size = f"of {self.belt_length:.5g} m" if tension is None else f"at {tension:.5g} N"
        tensioners = f", {len(self.tensioners)} tensioner{'s' * (len(self.tensioners) > 1)}" if self.tensioners else ""
        return f'Drive "{self.title}": {pulleys}; {"open " * bool(self.ends)}belt {size}{tensioners}'

    __str__ = __repr__

    def __reduce__(self) -> tuple[Callable[..., "Drive"], tuple[str, tuple[str, ...]]]:
        """Travel between processes as a drive file, with the modules that register its own kinds."""
        told = "other processes get a drive as text, without functions", "run it in this process"
        refuse_functions(self.pulleys, *told)
        refuse_kinds_of_scripts(self.own_kinds)
        return drive_of_text, (self.text, tuple(dict.fromkeys(kind.origin for kind in self.own_kinds)))

    @model_validator(mode="before")
    @classmethod
    def _takes_what_suppliers_give(cls, data: Any, info: ValidationInfo) -> Any:
        return as_supplied(data, info)

    @model_validator(mode="after")
    def _has_both_ends_of_a_web(self) -> Self:
        missing = "winder" if self.winder is None else "unwinder"
        if (self.unwinder is None) != (self.winder is None):
            raise ValueError(f"[{missing}] is missing: a web line has an unwinder and a winder. Give both")
        if self.is_web and (self.given_ends or self.carriage is not None):
            raise ValueError("[unwinder] and [winder] exclude [[end]] and [carriage]. Remove one of them")
        return self

    @model_validator(mode="after")
    def _duty_fits_the_pulleys(self) -> Self:
        check_duty(self.duty, [one.name for one in self.pulleys])
        return self

    @model_validator(mode="after")
    def _has_friction(self) -> Self:
        _ = self.frictions
        return self

    @model_validator(mode="after")
    def _leaves_nothing_open(self, info: ValidationInfo) -> Self:
        _ = self.layout if (info.context or {}).get("only_laid_out") else self.completed
        return self

    @model_validator(mode="after")
    def _joint_fits_the_belt(self) -> Self:
        if self.simulation.joint == "multipliers" and not self.element_kind.has_ends:
            raise ValueError(
                'simulation.joint = "multipliers" is incompatible with belt.discretization = '
                f'"{self.element_kind.name}", whose elements have no ends to join. '
                'Choose joint = "shared_node", or discretization = "ancf".'
            )
        return self

    @model_validator(mode="after")
    def _ends_fit_the_belt(self) -> Self:
        kind = f'belt.discretization = "{self.element_kind.name}"'
        if self.ends and self.simulation.joint == "multipliers":
            raise ValueError('simulation.joint = "multipliers" closes the belt, but [[end]] opens it. Remove one')
        if self.ends and not self.element_kind.has_ends:
            raise ValueError(f'[[end]] is incompatible with {kind}, whose elements have no ends. Choose "ancf"')
        if any(end.turning_held for end in self.ends) and self.element_kind.turned < 0:
            raise ValueError(f'end.clamped is incompatible with {kind}, whose nodes have no rotation. Choose "ancf"')
        return self

    @model_validator(mode="after")
    def _fits_its_mesh(self) -> Self:
        tolerance, frame = self.simulation.force_tolerance, self.frame
        if tolerance is not None and not frame.stays:
            raise ValueError(
                f"simulation.force_tolerance = {tolerance:g} is incompatible with a travelling mesh, which is not "
                f"refined; the mesh of this drive travels, {frame.reason}. Remove one of the two"
            )
        if tolerance is not None and self.carriage is not None:
            raise ValueError(
                f"simulation.force_tolerance = {tolerance:g} is incompatible with [carriage]: the mesh of an axis is "
                "not refined. Omit it, and give belt.elements"
            )
        if self.belt.has_single_teeth and frame.stays:
            raise ValueError(
                f'belt.toothing.law = "{DISCRETE}" is incompatible with simulation.frame = "staying": single teeth '
                'travel with their mesh. Omit frame, or set law = "spread"'
            )
        if frame.stays and self.belt.other_elements is not None:
            raise ValueError(
                f'belt.discretization = "{self.belt.other_elements}" is incompatible with simulation.frame = '
                '"staying", whose elements are quintic. Remove one of the two'
            )
        if self.given_ends and frame.stays:
            raise ValueError(
                'simulation.frame = "staying" is incompatible with an open belt: no belt flows past its ends. Set '
                'simulation.frame = "travelling", or omit it'
            )
        return self

    @model_validator(mode="after")
    def _teeth_fit_the_pulleys(self) -> Self:
        check_teeth(self.belt, self.pulleys, None if self.moving_tensioners else self.path)
        check_speeds(self.pulleys, self.path, self.simulation.end)
        return self

    @model_validator(mode="after")
    def _carriage_fits_the_axis(self) -> Self:
        if self.carriage is None:
            return self
        if self.belt.crossed:
            raise ValueError("belt.crossed = true is incompatible with [carriage], whose belt runs straight. Omit it")
        if self.moving_tensioners:
            raise ValueError(
                f'the spring-loaded tensioner of "{self.moving_tensioners[0].pulley}" is incompatible with [carriage]: '
                'it would yield to the load. Set kind = "fixed", whose take_up tensions the belt'
            )
        senses = self.counter_clockwise_pulleys
        check_carriage(self.carriage, self.path, senses, self.path_ends, self.simulation.end)
        return self

    @model_validator(mode="after")
    def _is_a_whole_web_line(self) -> Self:
        if not self.is_web:
            return self
        check_rollers(self.counter_clockwise_pulleys)
        if self.belt.crossed:
            raise ValueError("belt.crossed = true is incompatible with [unwinder] and [winder]. Omit it")
        if self.belt.teeth is not None:
            raise ValueError("belt.teeth is incompatible with [unwinder] and [winder]: a web has no teeth. Remove it")
        if self.belt.has_hysteresis or self.belt.bending_loss_factor:
            raise ValueError(
                "loss factors of the belt are incompatible with [unwinder] and [winder]. Omit them, or give "
                "stretch_damping_time and bending_damping_time"
            )
        return self

    @property
    def is_web(self) -> bool:
        """Whether it is a web line, from an unwinder to a winder."""
        return self.unwinder is not None and self.winder is not None

    @property
    def web_ends(self) -> tuple[Unwinder | Winder, ...]:
        """Unwinder and winder of a web line."""
        return tuple(one for one in (self.unwinder, self.winder) if one is not None)

    @property
    def rolls(self) -> tuple[Unwinder | Winder, ...]:
        """Those that have rolls."""
        return tuple(one for one in self.web_ends if one.roll is not None)

    @property
    def ends(self) -> tuple[End, ...]:
        """The ends of an open belt, as given, clamped to the carriage, or held by unwinder and winder."""
        if self.unwinder is not None and self.winder is not None:
            return self.unwinder.end, self.winder.end
        if self.carriage is None:
            return self.given_ends
        if self.given_ends:
            raise ModelError("[[end]] and [carriage] exclude each other: the carriage holds both ends. Remove one")
        return self.carriage.ends(self.pulleys[0].center) if self.pulleys else ()

    @model_validator(mode="after")
    def _carries_on_spans(self) -> Self:
        if not self.carries:
            return self
        if self.ends:
            opening = "[unwinder] opens the path" if self.is_web else "[[end]] opens the belt"
            raise ValueError(f"{opening}, but only closed belts have [[support]] and [[goods]]. Remove one")
        if not self.frame.stays:
            raise ValueError(
                "[[support]] and [[goods]] need a mesh that stays, through which the belt flows; the mesh of this "
                f"drive travels, {self.frame.reason}. Remove that setting"
            )
        check_carrying(self.supports, self.goods, self.spans, self.path, self.gravity)
        if any(one.curve_radius for one in self.supports):
            found = self.completed
            given = self.layout.given._replace(belt=found.belt, contact=found.contact)
            tension = given.estimate(self.path).tension
            check_lift(self.supports, self.spans, self.path, self.gravity, self.belt.mass_per_length, tension)
        return self

    @model_validator(mode="after")
    def _presses_a_closed_belt(self) -> Self:
        if not self.nips:
            return self
        if self.ends and not self.is_web:
            raise ValueError("[[end]] opens the belt, but only closed belts and webs have [[nip]]. Remove one")
        if self.carries:
            raise ValueError("[[nip]] is incompatible with [[support]] and [[goods]]. Remove one of them")
        if not self.frame.stays:
            raise ValueError(
                "[[nip]] needs a mesh that stays, with short elements in the nip; the mesh of this drive travels, "
                f"{self.frame.reason}. Remove that setting"
            )
        carried = {one.pulley for one in self.tensioners}
        for number, nip in enumerate(self.nips, 1):
            if nip.pulley in carried:
                raise ValueError(
                    f'nip[{number}]: a tensioner carries "{nip.pulley}", but the pulley of a nip has a fixed center. '
                    "Carry the roller, or remove the tensioner"
                )
            if nip.roller in carried and (nip.force is not None or nip.gap is not None):
                raise ValueError(
                    f'nip[{number}]: a tensioner carries "{nip.roller}", whose preload presses it. Omit force and gap'
                )
        return self

    @property
    def is_controlled(self) -> bool:
        """Whether controllers of motors see tensioners."""
        return any(load.sensed is not None for pulley in self.pulleys for load in pulley.load)

    @property
    def carries(self) -> bool:
        """Whether spans have supports or goods."""
        return bool(self.supports or self.goods)

    @property
    def stays_at_rest(self) -> bool:
        """Whether its equilibrium at rest needs a mesh that stays: that of teeth, of nips, and of what spans carry."""
        return self.belt.teeth is not None or self.carries or bool(self.nips)

    @property
    def title(self) -> str:
        """Its name, or "Belt drive"."""
        return self.name or "Belt drive"

    def number_of(self, pulley: object) -> int:
        """Number of a pulley by its name.

        Parameters
        ----------
        pulley : str
            Its name.

        Raises
        ------
        ModelError
            If there is no such pulley.
        """
        names = [one.name for one in self.pulleys]
        if pulley not in names:
            raise ModelError(f"pulley = {pulley!r} is not in this drive. Choose one of {', '.join(names)}.")
        return names.index(str(pulley))

    @cached_property
    def driver(self) -> int | None:
        """Number of the driver: the first pulley with prescribed speed, or else with a motor, or else that is held."""
        kinds: tuple[Callable[[Pulley], bool], ...] = (
            lambda one: one.prescribed and not one.stands_still,
            lambda one: any(load.driven_speed for load in one.load),
            lambda one: one.prescribed,
        )
        for drives in kinds:
            found = [number for number, one in enumerate(self.pulleys) if drives(one)]
            if found:
                return found[0]
        return None

    @property
    def positive_sense(self) -> int:
        """Sense of positive speeds and torques of the drive file: 1 counter-clockwise, -1 clockwise (`rotation`)."""
        return -1 if self.rotation == "clockwise" else 1

    @cached_property
    def counter_clockwise_pulleys(self) -> tuple[Pulley, ...]:
        """The pulleys with speeds and torques counter-clockwise positive, as equations of motion have them."""
        return self.with_counter_clockwise_positive(self.pulleys)

    def with_counter_clockwise_positive(self, pulleys: tuple[Pulley, ...]) -> tuple[Pulley, ...]:
        """Pulleys of the drive, which may have moved, with speeds and torques counter-clockwise positive."""
        return pulleys if self.positive_sense > 0 else tuple(one.reversed() for one in pulleys)

    @property
    def running_sense(self) -> int:
        """Running sense of the belt by its driver: 1 in the listed order of the pulleys, -1 against it."""
        driver = None if self.driver is None else self.pulleys[self.driver]
        if driver is None:
            return 1
        fastest = driver.extreme_speed(self.simulation.begin, self.simulation.end)
        return self.positive_sense * (-driver.turning if fastest < 0.0 else driver.turning)

    @property
    def reference(self) -> int:
        """Number of the reference pulley of slip: the driver, or the first pulley without a driver."""
        return self.driver or 0

    @cached_property
    def guides(self) -> BoolArray:
        """Whether each pulley stands still and the belt slides over it, shape (n,)."""
        driver = self.driver
        return np.array([one.stands_still and number != driver for number, one in enumerate(self.pulleys)])

    @property
    def own_kinds(self) -> list[Chosen]:
        """Kinds of the drive from outside the package."""
        return [kind for kind in chosen_kinds(self) if kind.is_own]

    @property
    def path_ends(self) -> tuple[PathEnd, ...]:
        """The ends of an open belt as its path sees them."""
        return ends_on_path(self.ends, self.gravity)

    def with_slides(self) -> "Drive":
        """The drive with the rollers of nips that forces press on slides: they move over time and in vibrations."""
        if all(nip.force is None for nip in self.nips):
            return self
        nips, slides = on_slides(self.nips, self.pulleys)
        return self.replace(nip=nips, tensioner=(*self.tensioners, *slides))

    @property
    def spans(self) -> tuple[tuple[str, str], ...]:
        """Names of the pulleys or ends at both ends of each span; the last span leads to the first pulley."""
        return tuple(span_names(self.pulleys, self.ends, self.nips))

    @cached_property
    def frame(self) -> Frame:
        """The mesh of runs over time, with the reason."""
        return choose_frame(self.simulation, self.belt, self.contact, bool(self.given_ends))

    @property
    def element_kind(self) -> ElementKind:
        """The element kind of that mesh."""
        return ELEMENTS[element_of(self.belt, self.frame)]

    @property
    def fineness(self) -> float:
        """Fineness of its mesh where no number of elements is given; zero where that is not graded."""
        if not self.frame.stays or self.simulation.mesh == "uniform":
            return 0.0
        return FINENESS if self.carriage is None else AXIS_FINENESS

    @cached_property
    def layout(self) -> Layout:
        """The belt laid around its pulleys, before its state is computed."""
        belt = self.belt.replace(discretization=self.element_kind.name)
        if self.unwinder is not None and belt.length is None and belt.installed_tension is None:
            tension = self.unwinder.tension_at(self.simulation.begin, self.belt.thickness)
            belt = belt.replace(installed_tension=tension)
        given = Given(belt, self.pulleys, self.contact, self.tensioners, self.path_ends, self.fineness, self.nips)
        if belt.length is not None or belt.installed_tension is not None or given.ends or given.has_springs:
            return lay_out(given)
        path = given.path_around(given.pulleys_in_place)
        required = None if self.driver is None else self.belt_loads(self.driver).run_in_tension(path)
        if required is None:
            return lay_out(given)
        return lay_out(given._replace(belt=belt.replace(installed_tension=required)))._replace(for_loads=True)

    def belt_loads(self, driver: int) -> BeltLoads:
        """The loads on the belt with the number of a driver, at the highest speed of that."""
        factor, times = self.limits.service_factor or 1.0, self.simulation
        return BeltLoads(self.pulleys, driver, self.belt, factor, times.begin, times.end)

    @cached_property
    def completed(self) -> Completed:
        """The parts with all open values filled in, as used by analyses."""
        return complete(self.layout)

    @property
    def belt_length(self) -> float:
        """Unstretched length of the belt, m: as given, or for its installed tension.

        The latter is an estimate without bending, weight and mesh; `bring_to_rest` computes the exact length.
        """
        return self.completed.belt.given_length

    @cached_property
    def rated_belt(self) -> RatedBelt | RatedTeeth | None:
        """The belt as its profile is rated; None without a rating."""
        return None if self.ends else self.belt.rated(self.belt_length)

    @property
    def contact_stiffness(self) -> float:
        """Contact stiffness, N/m^2: given, by a given penetration, or chosen."""
        return self.completed.contact.given("stiffness")

    @property
    def contact_damping(self) -> float:
        """Contact damping, N s/m^2: given, or chosen."""
        return self.completed.contact.given("damping")

    @property
    def friction_parameters(self) -> FrictionParameters:
        """Parameters of the friction law, given or chosen."""
        return self.completed.contact.friction_parameters

    @property
    def elements(self) -> int:
        """Number of belt elements, given or chosen."""
        return self.completed.belt.given_elements

    @property
    def path(self) -> Path:
        """The path of the tension line, with spring-loaded tensioners at zero."""
        return self.layout.path

    @cached_property
    def radii(self) -> FloatArray:
        """Effective radii, shape (n,), m: radii of the pulleys plus the offset of the belt on its contact side."""
        return radii(self.pulleys, self.belt)

    @cached_property
    def rolling_radii(self) -> FloatArray:
        """Rolling radii R / (1 + e) of the bent belt without tension, shape (n,), m.

        Bending shortens it by the strain e of `Belt.bent_strain`, so that a rim takes more of it along.
        """
        ratios = rim_ratios(self.path.nips, self.pulleys, self.radii)
        return np.asarray(ratios * self.radii / (1.0 + self.belt.bent_strain(self.radii)))

    @property
    def centers(self) -> FloatArray:
        """Centers of the pulleys, shape (n, 2), m, with the take-up of fixed tensioners, spring-loaded ones at zero."""
        return self.path.centers

    def _repr_html_(self) -> str:
        """Show the drive in a notebook: presentation lies above, and is found by its name."""
        html: str = import_module("beltdyn.show.notebook").drive_html(self)
        return html

    @property
    def moving_tensioners(self) -> tuple[MovingTensioner, ...]:
        """The spring-loaded tensioners."""
        return tuple(one for one in self.tensioners if isinstance(one, MovingTensioner))

    def carried(self, tensioner: Tensioner) -> int:
        """Number of the pulley of a tensioner."""
        return [pulley.name for pulley in self.pulleys].index(tensioner.pulley)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Instants of kinks and jumps in prescribed functions of time, s, ascending."""
        profiles = [profile for pulley in self.pulleys for profile in pulley.profiles]
        profiles += [one.schedule for one in self.goods if one.schedule is not None]
        profiles += [one.torque for one in self.rolls if one.torque is not None]
        return tuple(sorted({float(t) for profile in profiles for t in profile.breakpoints()}))

    @cached_property
    def frictions(self) -> FloatArray:
        """Friction coefficients of the pulleys, with the wedge factor on those on the inside; shape (n,)."""
        return np.array([friction_on(pulley, self.belt, self.contact) for pulley in self.pulleys])

    def with_(self, changes: Mapping[str, Any]) -> "Drive":
        """Make a validated copy with values changed by their paths, all at once.

        Parameters
        ----------
        changes : mapping
            Path -> new value: a number in SI units, text with a unit, or any other value that a drive file accepts
            there; None restores the default. Paths are those of error messages: keys separated by dots, and in brackets
            the name of a pulley, the pulley of a tensioner, or the number of an entry, counted from 1. A value that
            excludes another one, such as the installed tension and the length of the belt, replaces it.

        Returns
        -------
        Drive

        Raises
        ------
        ModelError
            If a path leads nowhere, or the changed drive is not valid.

        Examples
        --------
        >>> changes = {"belt.installed_tension": "40 N", "pulley[driven].inertia": 0.2}
        >>> changed = drive.with_(changes)
        >>> changed.belt.installed_tension, changed.pulleys[1].inertia
        (40.0, 0.2)
        """
        changed = Drive(**changed_arguments(self, changes))
        carry_tolerances(self, changed)
        return changed

    @cached_property
    def text(self) -> str:
        """The TOML text of the drive, original or equivalent."""
        if self._source is not None:
            return self._source
        return tomli_w.dumps(with_tolerances(self, self.data, tolerances_of(self)), multiline_strings=False)

    @property
    def data(self) -> dict[str, Any]:
        """The groups and keys of a drive file, in SI units, with all defaults, without empty groups."""
        data = self.model_dump(mode="json", by_alias=True, exclude_none=True)
        return {key: value for key, value in data.items() if value != {}}


def drive_of_text(text: str, modules: Iterable[str] = ()) -> Drive:
    """The drive of a text by `Drive.text`, after the import of modules that register its kinds."""
    for module in modules:
        import_module(module)
    drive = Drive.model_validate(parse_toml(text))
    drive._source = text
    return drive
