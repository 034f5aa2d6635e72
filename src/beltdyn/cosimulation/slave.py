"""What units of both standards have in common: variables, their description, states, steps and messages."""

from collections.abc import Callable, Mapping, Sequence
from ctypes import c_uint64
from functools import partialmethod
from math import nan
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree.ElementTree import Element, SubElement

from beltdyn import __version__
from beltdyn.cosimulation.component import TOLERANCE, Component, ComponentState, Input, Interface, Output
from beltdyn.errors import ModelError, cause_of

# The model description of a unit: what the packages that make units leave out of it

_BASE_UNITS: Mapping[str, Mapping[str, int]] = {
    "s": {"s": 1},
    "m": {"m": 1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N m": {"kg": 1, "m": 2, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
}
"""Exponents of base units in the units of variables."""


def complete_description(root: Element, interface: Interface) -> None:
    """Add names, units, meanings, the experiment and dependencies to a model description of either standard.

    Outputs belong to the end of the last step, whatever has been set since then: they depend on no inputs.
    """
    root.set("modelName", interface.title)
    root.set("description", f"{interface.title}: a belt drive")
    root.set("variableNamingConvention", "flat")
    root.set("generationTool", f"beltdyn {__version__} ({root.get('generationTool')})")
    variables = {one.get("name", ""): one for one in root.iterfind("ModelVariables/*")}
    told: list[Input | Output] = [*interface.inputs, *interface.outputs]
    meanings = {one.name: one.meaning for one in told}
    units = {one.name: one.unit for one in told}
    meanings |= {"time": "Time", TOLERANCE: "Relative tolerance of a time step"}
    units |= {"time": "s"}
    for name, variable in variables.items():
        variable.set("description", meanings[name])
        if name in units:
            real = variable.find("Real")
            (variable if real is None else real).set("unit", units[name])
    _define_units(root, {units[name] for name in variables if name in units})
    _describe_experiment(root, interface)
    _tell_dependencies(root, variables)


def _define_units(root: Element, names: set[str]) -> None:
    """Say what units are in base units."""
    definitions = Element("UnitDefinitions")
    for name in sorted(names):
        exponents = {unit: str(power) for unit, power in _BASE_UNITS[name].items()}
        SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", exponents)
    root.insert([child.tag for child in root].index("CoSimulation") + 1, definitions)


def _describe_experiment(root: Element, interface: Interface) -> None:
    """The run of the drive file."""
    times = {"startTime": interface.begin, "stopTime": interface.end, "stepSize": interface.interval}
    numbers = times | {"tolerance": interface.tolerance}
    experiment = Element("DefaultExperiment", {name: repr(value) for name, value in numbers.items()})
    root.insert([child.tag for child in root].index("ModelVariables"), experiment)


def _tell_dependencies(root: Element, variables: Mapping[str, Element]) -> None:
    """Outputs depend on no inputs; at the beginning on the tolerance."""
    structure = root.find("ModelStructure")
    names = list(variables)
    if structure is None:
        return
    fmi2 = variables[TOLERANCE].find("Real") is not None
    of = str(names.index(TOLERANCE) + 1) if fmi2 else variables[TOLERANCE].get("valueReference", "")
    unknowns = structure.findall("Outputs/Unknown") + structure.findall("Output")
    for one in unknowns:
        one.set("dependencies", "")
    if fmi2 and unknowns:
        initial = SubElement(structure, "InitialUnknowns")
        for one in unknowns:
            SubElement(initial, "Unknown", index=one.get("index", ""))
    for one in structure.findall("InitialUnknowns/Unknown") + structure.findall("InitialUnknown"):
        one.set("dependencies", of)


_WARNING, _ERROR = 1, 3
"""Status of a message, the same numbers in both standards."""


class Standard(NamedTuple):
    """Names of a package that makes units."""

    real: Any
    """Variables that are real numbers."""
    causality: Any
    """Enumeration of the causality of variables."""
    initial: Any
    """Enumeration of how initial values are given."""
    variability: Any
    """Enumeration of the variability of variables."""


class DriveSlave:
    """A drive behind the calls of FMI; a class of either standard comes after it among the bases.

    Errors are messages to the host, and make a step fail: an exception that went through would count as fatal, and the
    packages that make units free twice then what they hold, so that a host crashes. After an error at the beginning
    outputs are nan, and the first step fails. What a host must not set changes nothing, and its next step fails; what
    is not there is nan, zero, false or empty.
    """

    standard: Standard
    vars: Mapping[int, Any]
    register_variable: Callable[..., None]
    log: Callable[..., None]
    resources: str

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.component = Component.read(Path(self.resources))
        self.modelName = self.component.interface.identifier
        self.version = __version__
        self._refused = ""
        self._register()

    def _register(self) -> None:
        """Name the variables to the host, in the order of their references."""
        interface, component, standard = self.component.interface, self.component, self.standard
        if hasattr(standard.causality, "independent"):
            self._add("time", "independent", "continuous", lambda: component.time)
        self._add(
            TOLERANCE,
            "parameter",
            "fixed",
            lambda: component.tolerance,
            lambda value: setattr(component, "tolerance", value),
        )
        for one in interface.inputs:
            self._add(one.name, "input", "continuous", *_access(component, one.name))
        for other in interface.outputs:
            self._add(other.name, "output", "continuous", _access(component, other.name)[0], initial="calculated")

    def _add(
        self,
        name: str,
        causality: str,
        variability: str,
        getter: Callable[[], float],
        setter: Callable[[float], None] | None = None,
        initial: str | None = None,
    ) -> None:
        """Name a variable to the host."""
        standard = self.standard
        one = standard.real(
            name,
            causality=standard.causality[causality],
            variability=standard.variability[variability],
            initial=standard.initial[initial] if initial else None,
            getter=getter,
            setter=setter,
        )
        self.register_variable(one, nested=False)

    def to_xml(self, model_options: Mapping[str, str] | None = None) -> Element:
        """The model description, with units and all that the package that makes units leaves out."""
        root: Element = super().to_xml(dict(model_options or {}))  # type: ignore[misc]
        complete_description(root, self.component.interface)
        return root

    def enter_initialization_mode(self) -> None:
        """Find the state at the beginning."""
        made = self.component.interface.version
        if made != __version__:
            self._tell(f"this unit was made by beltdyn {made} but runs with beltdyn {__version__}.", _WARNING)
        self._attempt(self.component.begin)

    def advance(self, time: float, size: float) -> bool:
        """Simulate a step, and tell whether it has succeeded; if not, the host is told why."""
        if self._refused:
            reason, self._refused = self._refused, ""
            self._tell(f"the step was not made because a variable could not be set before it: {reason}", _ERROR)
            return False
        return self._attempt(self.component.step, time, size)

    def _get(self, references: Sequence[int]) -> list[float]:
        """Values of variables; nan, and a message, of those that are not there."""
        values: list[float] = []
        for reference in references:
            if reference in self.vars and self._attempt(lambda one: values.append(one.getter()), self.vars[reference]):
                continue
            if reference not in self.vars:
                self._tell(self._unknown(reference), _ERROR)
            values.append(nan)
        return values

    def _set(self, references: Sequence[int], values: Sequence[float]) -> None:
        """Set variables, all or none."""
        for reference in references:
            one = self.vars.get(reference)
            if one is None or one.setter is None:
                kind = f"{one.name} is an output" if one else self._unknown(reference)
                self._refuse(f"{kind}. Only inputs can be set: see modelDescription.xml.")
                return
        for reference, value in zip(references, values, strict=True):
            self.vars[reference].setter(value)

    def _refuse(self, reason: str) -> None:
        """Tell that something cannot be set, now and at the next step: the packages have no status for the former."""
        self._refused = reason
        self._tell(reason, _ERROR)

    def _get_nothing(self, nothing: Any, references: Sequence[int]) -> list[Any]:
        """Values of another type than real numbers, which no variable has."""
        for reference in references:
            self._tell(self._wrong_type(reference), _ERROR)
        return [nothing for _ in references]

    def _set_nothing(self, references: Sequence[int], _values: Sequence[Any]) -> None:
        for reference in references:
            self._refuse(self._wrong_type(reference))

    def _wrong_type(self, reference: int) -> str:
        one = self.vars.get(reference)
        return f"{one.name} is a real number (double), not of the requested type." if one else self._unknown(reference)

    @staticmethod
    def _unknown(reference: int) -> str:
        return f"no variable has the value reference {reference % 2**32}"

    get_real = get_float64 = _get
    set_real = set_float64 = _set
    get_integer = get_int32 = get_int64 = partialmethod(_get_nothing, 0)
    get_uint64 = partialmethod(_get_nothing, c_uint64(0))
    get_boolean, get_string = partialmethod(_get_nothing, False), partialmethod(_get_nothing, "")
    set_integer = set_int32 = set_int64 = set_uint64 = set_boolean = set_string = _set_nothing

    def _attempt(self, action: Callable[..., None], *arguments: Any) -> bool:
        """Do something, and tell whether it has succeeded; if not, the host is told why."""
        try:
            action(*arguments)
        except Exception as error:
            self._tell(cause_of(error), _ERROR)
        else:
            return True
        return False

    def _tell(self, message: str, status: int) -> None:
        """Hand a message to the host."""
        self.log(message, status, {_WARNING: "logStatusWarning", _ERROR: "logStatusError"}[status])

    def _get_fmu_state(self) -> ComponentState:
        return self.component.state()

    def _set_fmu_state(self, state: ComponentState | ModelError) -> None:
        """Go to a state; where that fails, the next step does."""
        if not self._attempt(self._restore, state):
            self.component.restore(ComponentState(self.component.tolerance, {}, {}, None, None))

    def _restore(self, state: ComponentState | ModelError) -> None:
        if isinstance(state, ModelError):
            raise state
        self.component.restore(state)

    @staticmethod
    def _fmu_state_to_bytes(state: ComponentState) -> bytes:
        return state.to_bytes()

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> ComponentState | ModelError:
        """The state from bytes; errors are reported when it is set."""
        try:
            return ComponentState.from_bytes(state)
        except ModelError as error:
            return error


def _access(component: Component, name: str) -> tuple[Callable[[], float], Callable[[float], None]]:
    """How a host gets and sets a variable."""
    return lambda: component.get(name), lambda value: component.set(name, value)
