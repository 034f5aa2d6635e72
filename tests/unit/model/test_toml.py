import contextlib
import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st

from beltdyn.errors import ModelError
from beltdyn.model import Drive, LoadTable, Pulley, Table, advise, dumps, install, json_schema, load, loads, prepare
from beltdyn.model.toml import edited
from beltdyn.parts.change import tolerances_of
from beltdyn.parts.quantity import RPM


def test_the_papers_drive(drive: Drive) -> None:
    assert [pulley.name for pulley in drive.pulleys] == ["driver", "driven"]
    assert drive.belt.elements == 20
    assert drive.simulation.start == "laid"
    assert drive.path.length == pytest.approx(1.27627, abs=1e-5)


def test_text_is_kept(drive: Drive, drive_text: str) -> None:
    assert drive.text == drive_text


def test_round_trip(drive: Drive) -> None:
    assert loads(dumps(drive)) == drive


def test_units_in_the_file(drive: Drive, drive_text: str) -> None:
    metric = drive_text.replace("width = 0.01", 'width = "10 mm"').replace("1e-3", '"1 ms"')
    assert loads(metric) == drive


def test_tables_are_read_beside_the_drive_file(drive_file: Path) -> None:
    """The text of such a drive holds the points, so that it needs no other file."""
    (drive_file.parent / "load.csv").write_text("0,0\n1,-2\n")
    text = drive_file.read_text(encoding="utf-8")
    profile = '{ kind = "cosine_ramp", start = 0.05, end = 0.6, value = 0.0 }'
    drive_file.write_text(text.replace(profile, '{ kind = "table", file = "load.csv" }'), encoding="utf-8")
    drive = load(drive_file)
    assert drive.pulleys[1].torque
    assert drive.pulleys[1].torque.at(0.5) == pytest.approx(-1)
    assert loads(drive.text, base=Path("elsewhere")) == drive


def test_schema_knows_every_group() -> None:
    schema = json_schema()
    assert set(schema["properties"]) == {
        "author",
        "carriage",
        "unwinder",
        "winder",
        "project",
        "belt",
        "pulley",
        "contact",
        "tensioner",
        "support",
        "goods",
        "nip",
        "end",
        "duty",
        "simulation",
        "steady",
        "limits",
        "sheet",
        "gravity",
        "rotation",
        "name",
        "description",
    }
    assert {"Belt", "Pulley", "Contact", "Simulation"} <= set(schema["$defs"])
    assert "in m" in json.dumps(schema["$defs"]["Belt"]["properties"]["length"])


def test_descriptions_of_the_schema_are_for_those_who_write_drive_files() -> None:
    """No sections of docstrings; each key has a description of its own instead, but for the kind of a part."""
    schema = json_schema()
    for name, part in ({"Drive": schema} | schema["$defs"]).items():
        assert "---" not in part.get("description", ""), name
        without = [key for key, given in part.get("properties", {}).items() if "description" not in given]
        assert set(without) <= {"kind"}, name


def test_tables_of_loads_and_schedules_are_read_too(drive_file: Path) -> None:
    (drive_file.parent / "curve.csv").write_text("0,0\n10,-2\n")
    (drive_file.parent / "engage.csv").write_text("0,0\n1,1\n")
    text = drive_file.read_text(encoding="utf-8")
    driven = text.index("[contact]")
    curve = (
        """load = [{ kind = "table", file = "curve.csv", schedule = { kind = "table", file = "engage.csv" } }]\n\n"""
    )
    drive_file.write_text(text[:driven] + curve + text[driven:], encoding="utf-8")
    drive = load(drive_file)
    (found,) = drive.pulleys[1].load
    assert isinstance(found, LoadTable)
    assert isinstance(found.schedule, Table)
    assert (found.torques, found.schedule.values) == ((0.0, -2.0), (0.0, 1.0))
    assert loads(drive.text, base=Path("elsewhere")) == drive


KEYS = st.sampled_from(
    [
        *("belt", "pulley", "contact", "simulation", "length", "width", "name", "center", "radius", "speed", "torque"),
        *("tensioner", "load", "hub", "harmonics", "mass"),
        *("profile", "ribs", "catalogue", "axial_stiffness", "wedge_angle", "gravity", "side"),
        *("side", "installed_tension", "allowed_penetration", "pitch_offset", "crossed", "tensioner", "take_up"),
        *("inertia", "kind", "start", "end", "value", "file", "times", "values", "friction", "elements", "duration"),
    ]
)
NUMBERS = st.integers() | st.floats() | st.floats(1e-15, 1e15)
SCALARS = (
    NUMBERS
    | st.booleans()
    | st.dates()
    | st.text()
    | st.sampled_from(["ramp", "table", "constant", "12 mm", "3 rpm", "laid", "driver", "1e999 m"])
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS | st.text(), inner, max_size=5),
    max_leaves=15,
)


def read(text: str) -> None:
    """Make a drive of a text and look at it, which may only fail with an explained error."""
    with contextlib.suppress(ModelError):
        drive = loads(text)
        advise(drive, install(drive))


@given(st.dictionaries(KEYS, VALUES))
def test_arbitrary_toml(data: dict[str, Any]) -> None:
    read(tomli_w.dumps(data))


@pytest.mark.slow
@given(st.data())
@settings(max_examples=300)
def test_the_papers_drive_with_an_arbitrary_value(drive: Drive, data: st.DataObject) -> None:
    content = drive.data
    group = data.draw(st.sampled_from(sorted(content)))
    target = data.draw(st.sampled_from(content["pulley"])) if group == "pulley" else content[group]
    target = target if isinstance(target, dict) else content
    target[data.draw(st.sampled_from(sorted(target)) | KEYS)] = data.draw(VALUES)
    read(tomli_w.dumps(content))


@pytest.mark.slow
@given(st.data())
@settings(max_examples=300)
def test_the_papers_drive_with_arbitrary_numbers(drive: Drive, data: st.DataObject) -> None:
    content = drive.model_dump(by_alias=True, exclude_none=True)
    for group in (content["belt"], content["contact"], content["simulation"], *content["pulley"]):
        key = data.draw(st.sampled_from([key for key, value in group.items() if isinstance(value, float)]))
        group[key] *= data.draw(st.sampled_from([1.0, 1.0, 1e-13, 1e-3, 0.99, 1e3, 1e13]))
    content["pulley"][0]["center"] = data.draw(st.sampled_from([(-0.191441, 0.0), (1e14, 1e14), (-0.191, 1e-300)]))
    read(tomli_w.dumps(content))


LENGTHS = {"crossed": 1.88, "flat": 2.58, "serpentine": 1.84}
SPRING = {"kind": "rotary", "pulley": "tensioner", "pivot": [-0.17, 0.17], "inertia": 0.1, "preload": 30.0, "rate": 9.0}
FIXED = {"kind": "fixed", "pulley": "idler", "direction": [0.6, 0.8], "take_up": 1e-3}


@pytest.mark.slow
@given(st.sampled_from(sorted(LENGTHS)), st.data())
@settings(max_examples=200)
def test_any_layout_with_arbitrary_numbers(make_drive: Callable[..., Drive], layout: str, data: st.DataObject) -> None:
    drive = make_drive(layout, length=LENGTHS[layout]).model_dump(by_alias=True, exclude_none=True)
    drive["tensioner"] = data.draw(st.lists(st.sampled_from([dict(SPRING), dict(FIXED)]), max_size=2))
    drive["belt"]["installed_tension"] = 300.0
    factors = st.sampled_from([1.0, 1.0, 1.0, 0.9, 1.1, 1e-3, 1e3, 1e13])
    for group in (drive["belt"], drive["contact"], *drive["pulley"], *drive["tensioner"]):
        key = data.draw(st.sampled_from([key for key, value in group.items() if isinstance(value, float)]))
        group[key] *= data.draw(factors)
    dropped = data.draw(st.sampled_from(["length", "installed_tension"]))
    drive["belt"].pop(dropped)
    order = data.draw(st.permutations(drive["pulley"])) if data.draw(st.booleans()) else drive["pulley"]
    read(tomli_w.dumps(drive | {"pulley": list(order)}))


@given(st.text())
def test_arbitrary_text(text: str) -> None:
    read(text)


def test_a_written_drive_asks_for_its_tension_again_until_its_length_is_found(drive: Drive) -> None:
    asked = drive.replace(belt=drive.belt.replace(installed_tension=40.0))
    again = loads(dumps(asked))
    assert again == asked
    assert (again.belt.installed_tension, again.belt.length) == (40.0, None)
    found = prepare(asked).tightened(1e-5).drive
    assert loads(dumps(found)).belt.length == found.belt_length == asked.belt_length - 1e-5
    assert loads(dumps(found)).belt.installed_tension is None


@pytest.mark.parametrize(
    ("given", "spelled_out"),
    [
        ('speed = "800 rpm"', 'speed = { kind = "constant", value = "800 rpm" }'),
        ("speed = -12.5", 'speed = { kind = "constant", value = -12.5 }'),
        ('side = "back"', 'side = "outside"'),
        ('side = "Ribs"', 'side = "inside"'),
        ('friction = "35 %"', "friction = 0.35"),
        ('torque = "-1.2 N m"', 'torque = { kind = "constant", value = -1.2 }'),
        (
            'load = [{ kind = "resistance", constant = 1.0, schedule = "50 %" }]',
            'load = [{ kind = "resistance", constant = 1.0, schedule = { kind = "constant", value = 0.5 } }]',
        ),
    ],
)
def test_numbers_and_words_as_an_engineer_writes_them(given: str, spelled_out: str) -> None:
    def pulley(line: str) -> Any:
        text = f'name = "fan"\ncenter = [0, 0]\nradius = "0.1 m"\n{line}\n'
        return Pulley(**tomllib.loads(text if "speed =" in line and "load" not in line else f"{text}inertia = 1.0\n"))

    assert pulley(given) == pulley(spelled_out)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ('speed = "800 foo"', r'speed.value = "800 foo" has an unknown unit "foo"'),
        ('speed = "800"', 'speed.value = "800" has no unit'),
        ("speed = true", "speed = true has no kind"),
        ('side = "left"', 'side = "left" is not a valid choice. Choose one of inside, outside'),
        ('friction = "35"', 'friction = "35" must be a number without a unit. .* or write a fraction as "1 %"'),
        (
            'friction = "35 % ± 2 %"',
            "friction = .* is ambiguous: the tolerance could be relative or in percentage points",
        ),
    ],
)
def test_what_cannot_be_read_is_said(drive_text: str, given: str, told: str) -> None:
    lines = [line for line in drive_text.splitlines() if not line.startswith(("speed", "side"))]
    lines.insert(lines.index('name = "driver"') + 1, given)
    with pytest.raises(ModelError, match=told):
        loads("\n".join(lines))


def test_a_constant_in_short_form_is_a_number_like_any(drive_text: str) -> None:
    """Its tolerance is known, it is changed where it stands, and the schema of editors allows it."""
    (line,) = [line for line in drive_text.splitlines() if line.startswith("speed")]
    drive = loads(drive_text.replace(line, 'speed = "800 ± 5 rpm"'))
    path = "pulley[driver].speed.value"
    assert tolerances_of(drive) == {path: pytest.approx(5.0 / RPM)}
    text = edited(drive, {path: 900.0 / RPM})
    assert 'speed = "900 ± 5 rpm"' in text
    assert loads(text) == drive.with_({path: 900.0 / RPM})
    assert json_schema()["$defs"]["Pulley"]["properties"]["speed"]["anyOf"][0]["anyOf"][0] == {"type": "number"}
