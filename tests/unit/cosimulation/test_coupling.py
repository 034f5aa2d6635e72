"""The engine of docs/fmu.md on the crank of a drive: work through the shaft, and the same engine inside the drive."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pythonfmu import FmuBuilder

from beltdyn.cosimulation import fmu
from beltdyn.model import Drive
from beltdyn.transient.simulator import Simulator

pytestmark = pytest.mark.skipif(not FmuBuilder.has_binary(), reason="pythonfmu has no binary for this system")

PAGE = Path(__file__).parents[3] / "docs" / "fmu.md"
STEP, END = 1e-3, 0.05


class CallsOf2:
    """A unit of either version with the calls of FMI 2.0 that the page makes."""

    def __init__(self, host: Any) -> None:
        unit = host.unit
        self.doStep = unit.doStep
        self.getReal, self.setReal = (unit.getFloat64, unit.setFloat64) if host.newer else (unit.getReal, unit.setReal)
        self.getFMUstate, self.setFMUstate = host.save, host.restore
        self.freeFMUstate = unit.freeFMUState if host.newer else unit.freeFMUstate


@pytest.fixture(scope="module")
def page() -> dict[str, Any]:
    """What the program of the page defines."""
    code = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[-1]
    names: dict[str, Any] = {}
    exec(compile(code, "docs/fmu.md", "exec"), names)
    return names


@pytest.fixture(scope="module", params=[pytest.param("2.0", marks=pytest.mark.slow), "3.0"])
def unit(request: pytest.FixtureRequest, drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fmu(drive, tmp_path_factory.mktemp("units") / "drive.fmu", ["pulley[driver].speed"], fmi=request.param)


@pytest.fixture(scope="module")
def inside(drive: Drive, page: dict[str, Any]) -> dict[str, float]:
    """Outputs of a drive that has the engine as the inertia and the load of its driver."""
    mean, swing = page["MEAN"], page["SWING"]
    torque = {"kind": "table", "speeds": [-100.0, 100.0], "torques": [mean, mean]}
    load = torque | {"harmonics": [{"order": 2, "amplitude": swing / mean}]}
    driver = drive.pulleys[0].replace(speed=None, inertia=page["INERTIA"], load=[load])
    simulator = Simulator(drive.replace(pulley=[driver, *drive.pulleys[1:]]))
    simulator.step(END)
    return simulator.outputs()


LOST = ("friction_loss", "damping_loss", "numerical_loss")
HELD = ("kinetic_energy", "strain_energy", "penalty_energy")


@pytest.mark.slow
def test_work_through_the_shaft_is_held_or_lost(
    unit: Path, page: dict[str, Any], host: Callable[[Path], Any], inside: dict[str, float]
) -> None:
    """That of the gas by the engine, to rounding, and by the drive, to 1e-4: its time steps are worth as much (rtol).

    What the coupling misses falls to a tenth or less with each try; the numbers are those of the page.
    """
    missed = []
    for tries in (1, 2, 3):
        one = host(unit).begin()
        before = sum(one.get(name) for name in HELD)
        speed, of_gas, through = page["couple"](CallsOf2(one), one.references, STEP, END, tries)
        engine, work = 0.5 * page["INERTIA"] * speed**2, one.get("driver_work")
        held, lost = sum(one.get(name) for name in HELD) - before, sum(one.get(name) for name in LOST)
        assert of_gas == pytest.approx(engine + through, rel=1e-12)
        assert work + one.get("torque_work") == pytest.approx(held + lost, rel=1e-4)
        missed.append(abs(through - work))
    assert missed[0] > 10.0 * missed[1] > 100.0 * missed[2]
    assert missed[2] < 1e-5 * work
    assert speed == pytest.approx(inside["pulley_speed[driver]"], rel=0.01)
    told = [float(one) for one in re.findall(r"\| (\d\.\d+) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)]
    assert told == pytest.approx([of_gas, engine, through, work, held, lost], rel=0.02)


def test_the_instance_of_the_page_runs(drive: Drive, page: dict[str, Any], tmp_path: Path) -> None:
    unit, references = page["instance"](str(fmu(drive, tmp_path / "demo.fmu", ["pulley[driver].speed"])))
    speed, of_gas, through = page["couple"](unit, references, STEP, 3.0 * STEP, 2)
    unit.freeInstance()
    assert of_gas - through == pytest.approx(0.5 * page["INERTIA"] * speed**2, rel=1e-12)
