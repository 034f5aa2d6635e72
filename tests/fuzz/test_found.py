"""What mutations and trials have found: each input once ended in a traceback, took long, or was echoed whole."""

import os
import re
import time
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import advise, install, load, loads, tensioner_balances
from beltdyn.results import open_result, open_run
from beltdyn.results.dataset import is_result
from beltdyn.transient.checkpoint import is_checkpoint, read_checkpoint
from beltdyn.transient.simulate import simulate
from validation.published import demo_text

LENGTH, WIDTH = "length = 1.2727", "width = 0.01"
TORQUE = 'torque = { kind = "cosine_ramp", start = 0.05, end = 0.6, value = 0.0 }'
LONGEST_MESSAGE = 5000
LONGEST_TIME = 20.0
"""Processor time that a refusal may take beside other work, s: what grows with the square of a file takes minutes."""
LONG = 100_000
FAR = "center = [0.191441, 0.0]"
PULLEY = """
[[pulley]]
name = "p{0}"
center = [{0}, 0]
radius = 0.1
inertia = 1
"""

Change = Callable[[str], str]


def put(line: str) -> Change:
    return lambda text: f"{line}\n{text}"


def replace(old: str, new: str) -> Change:
    def change(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return change


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (put("a." * 1000 + "b = 1"), "nested too deeply"),
        (put("a." * 50_000 + "b = 1"), "nested too deeply"),
        (put("[" + "a . " * 50_000 + "b]"), "nested too deeply"),
        (put('"a".' * 50_000 + "b = 1"), "nested too deeply"),
        (put("a = " + "[" * 5000 + "]" * 5000), "nested too deeply"),
        (put("a = " + "{ a = " * 5000 + "1" + " }" * 5000), "nested too deeply"),
        (put("# " + "x" * 5_000_000), "longer than 4,000,000"),
        (put("x" * LONG + " = 1"), "is not a known key"),
        (put("x" * LONG), "is not valid TOML"),
        (replace(WIDTH, f'width = "{"x" * LONG}"'), "must be a number in m"),
        (replace(WIDTH, f"width = {'9' * LONG}"), "too many digits"),
        (replace('name = "driver"', f'name = "{"x" * LONG}"'), "longer than"),
        (replace(WIDTH, "width = [" + '"x", ' * LONG + "]"), "must be a number"),
        (
            replace(TORQUE, 'torque = { kind = "table", times = [' + '"x", ' * LONG + "], values = [0] }"),
            "more errors are not shown",
        ),
        (replace(LENGTH, "installed_tension = 1e-12"), "below rounding. Give at least"),
        (replace(FAR, "center = [8e12, 0]"), "the extent of the drive is 8e+12 m; the limit is 1e+07 times the radius"),
        (lambda text: text + "".join(PULLEY.format(number) for number in range(20_000)), "more than 1000 entries"),
        (lambda text: re.sub(r"(?m)^elements = \d+", "elements = 100000", text), "must be at most 10000"),
    ],
)
def test_drive_files(change: Change, part: str) -> None:
    begun = time.process_time()
    with pytest.raises(ModelError) as refusal:
        loads(change(demo_text()))
    assert part in str(refusal.value)
    assert len(str(refusal.value)) < LONGEST_MESSAGE
    assert time.process_time() - begun < LONGEST_TIME


FLAT = files("beltdyn").joinpath("examples", "flat_belt_idler.toml")
LONG_ARM = """
[[tensioner]]
pulley = "driven"
kind = "rotary"
pivot = [0.2, {0}]
preload = "{0} N*m"
rate = {0}
inertia = 1
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        FLAT.read_text(encoding="utf-8").replace("center = [0.65, 0.0]", "center = [1e5, 0.0]"),
        *(demo_text() + LONG_ARM.format(length) for length in (1e3, 1e5, 1e9)),
        demo_text().replace("center = [0.191441, 0.0]", "center = [1e5, 0.0]").replace(LENGTH, "length = 200400")
        + '[[tensioner]]\npulley = "driven"\nkind = "sliding"\ndirection = [1, 0]\npreload = 9\nrate = 0.01\nmass = 1',
    ],
    ids=["far pulley", "arm of 1 km", "arm of 100 km", "arm of a million km", "far slider"],
)
def test_balances_of_tensioners_in_drives_of_any_size(text: str) -> None:
    """Steps of a fraction of the smallest radius took the search through the length of such a belt without end."""
    begun = time.process_time()
    drive = loads(text)
    installation = install(drive)
    advise(drive, installation)
    (balances,) = tensioner_balances(drive, installation)
    assert [balance.stable for balance in balances if balance.here] == [True]
    assert time.process_time() - begun < LONGEST_TIME


def test_dots_in_texts_and_comments_are_no_keys() -> None:
    text = "# " + "a." * 1000 + "\n" + demo_text().replace('name = "driver"', 'name = "a.a.a.a.a.a.a.a"')
    assert loads(text).pulleys[0].name == "a.a.a.a.a.a.a.a"


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("user:secret:0:0\nroot:secret:0:0\n", "has no numbers"),
        ("secret\nsecret\n" * LONG, "has no numbers"),
        ("0,1\n1,two\n", 'line 2, column 2: "two" is not a number'),
        ("0,1\n" + "x" * LONG, "is not two numbers"),
        pytest.param(
            "\n".join(f"{number},1" for number in range(300_000)), "has 300,000 lines; the limit is 250,000", id="long"
        ),
    ],
)
def test_tables_are_quoted_only_where_they_are_tables(tmp_path: Path, content: str, told: str) -> None:
    """The file may be any, by mistake."""
    (tmp_path / "load.csv").write_text(content, encoding="utf-8")
    with pytest.raises(ModelError) as refusal:
        loads(demo_text().replace(TORQUE, 'torque = { kind = "table", file = "load.csv" }'), tmp_path)
    assert "secret" not in str(refusal.value)
    assert told in str(refusal.value)
    assert len(str(refusal.value)) < 500


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes and devices are a matter of POSIX")
@pytest.mark.parametrize("name", ["pipe", "/dev/zero"])
def test_pipes_and_devices_are_not_read(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    table = demo_text().replace(TORQUE, f'torque = {{ kind = "table", file = "{name}" }}')
    path = tmp_path / name
    later = loads(demo_text()).with_({"simulation.start": {"file": str(path)}})
    for read in (
        lambda: loads(table, tmp_path),
        lambda: load(path),
        lambda: open_run(path),
        lambda: open_result(path),
        lambda: read_checkpoint(path),
        lambda: simulate(later),
    ):
        with pytest.raises(ModelError, match="it is a device or a pipe, not a file"):
            read()
    assert not is_checkpoint(path)
    assert not is_result(path)
