"""The model description of a unit: what the packages that make units leave out of it."""

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

from beltdyn import __version__
from beltdyn.cosimulation.interface import TOLERANCE, Input, Interface, Output

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

    Parameters
    ----------
    root : Element
        ``fmiModelDescription``, changed in place.
    interface : Interface
        What it describes.
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
