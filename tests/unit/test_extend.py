"""Kinds that a script registers, with the examples of the documentation as its modules."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import beltdyn.extend
from beltdyn.kernel import CACHE_VARIABLE

CODE = Path(__file__).parents[2] / "docs" / "extending" / "code"

READ = """
import beltdyn as bd
drive = bd.example("two_pulley")
schema = bd.model.json_schema()["$defs"]
assert "smooth" not in schema["Contact"]["properties"]["friction_law"]["enum"]

import cable, gas_spring, hunt_crossley, lobed, permanent_magnet_motor, progressive_coupling, rubber, smooth
import tension_ratio

schema = bd.model.json_schema()["$defs"]
assert "smooth" in schema["Contact"]["properties"]["friction_law"]["enum"]
driver, driven = drive.pulleys
motor = dict(kind="permanent_magnet_motor", voltage="3 V", torque_constant=0.5, resistance=0.5, current_limit=2.0)
coupling = dict(kind="progressive_coupling", stiffness=5.0, cubic_stiffness=4.0, inertia=1e-3)
own = drive.replace(
    belt=drive.belt.replace(stretch_law="rubber", second_share=0.3, discretization="cable"),
    contact=drive.contact.replace(
        friction_law="smooth", smoothing_velocity="5 cm/s", creep_rate_factor=None,
        normal_law="hunt_crossley", impact_damping=0.5,
    ),
    pulley=[
        driver.replace(speed=None, inertia=0.02, load=[motor], hub=[coupling]),
        driven.replace(surface={"kind": "lobed", "lobe_height": "0.2 mm", "lobes": 6}),
    ],
)
assert bd.loads(bd.dumps(own)) == own
assert own.element_kind.name == "cable"

from beltdyn.system.build import drive_system
system = drive_system(own)
assert (type(system.law.friction).__name__, type(system.law.normal).__name__) == ("Smooth", "HuntCrossley")
assert type(system.element.section.stretch).__name__ == "Rubber"
assert system.shaft_loads.table.dtype.names[-1].startswith("permanent_magnet_motor_")
assert not any(name.startswith("permanent") for name in drive_system(drive).shaft_loads.table.dtype.names)
for kind in own.own_kinds:
    print(kind, kind.origin)
print(bd.plot.tension_ratio.__name__, "tension_ratio" in bd.plot.FIGURES)
"""

LAWS = '''
from typing import NamedTuple

import numpy as np

from beltdyn.extend import FrictionLaw, Parameter, StretchLaw, Stretching, kernel, register


class Stiffening(NamedTuple):
    """N = EA (e + a e^n) over the strain e."""

    stiffness: float
    growth: float
    exponent: float

    def tension(self, stretch):
        e = np.asarray(stretch, dtype=float) - 1.0
        return self.stiffness * (e + self.growth * np.abs(e) ** (self.exponent - 1.0) * e)

    def tangent_stiffness(self, stretch):
        e = np.asarray(stretch, dtype=float) - 1.0
        return self.stiffness * (1.0 + self.exponent * self.growth * np.abs(e) ** (self.exponent - 1.0))

    def stretch(self, tension):
        g = 1.0 + np.asarray(tension, dtype=float) / self.stiffness
        for _ in range(60):
            g = g - (self.tension(g) - tension) / self.tangent_stiffness(g)
        return g


@kernel
def stiffening(law, metric):
    g = metric**0.5
    e, n = g - 1.0, law.exponent
    power = abs(e) ** (n - 1.0)
    tension = law.stiffness * (e + law.growth * power * e)
    rate = law.stiffness * (1.0 + n * law.growth * power)
    energy = law.stiffness * (0.5 * e * e + law.growth * power * e * e / (n + 1.0))
    return Stretching(energy, 0.5 * tension / g, 0.25 * (rate - tension / g) / metric)


growth = Parameter("growth", "", "the factor on the power of the strain")
exponent = Parameter("exponent", "", "the power of the strain", above=1.0)
register(StretchLaw("stiffening", "with the strain", Stiffening, stiffening, (growth, exponent)))


class Dry(NamedTuple):
    """f = -mu f_n v / (|v| + v_c)."""

    creep_scale: float

    def saturation(self, normal, friction, rim):
        return np.full(np.broadcast_shapes(*map(np.shape, (normal, friction, rim))), 99.0 * self.creep_scale)

    def smoothed(self, factor):
        return Dry(self.creep_scale * factor)


@kernel
def dry(law, slip, normal, friction, rim):
    width = abs(slip) + law.creep_scale
    share = FACTOR * slip / width
    return -friction * normal * share, -friction * normal * FACTOR * law.creep_scale / width**2, -friction * share, 0.0


register(FrictionLaw("dry", Dry, dry, (Parameter("creep_scale", "m/s", "the slip velocity at half of the friction"),)))
'''
SCRIPT = """
import sys

import matplotlib
matplotlib.use("Agg")

import beltdyn as bd

drive = bd.example("two_pulley")
drive = drive.replace(
    belt=drive.belt.replace(elements=12), simulation=drive.simulation.replace(duration=0.02, start="equilibrium")
)
if "late" in sys.argv:
    bd.simulate(drive)

import permanent_magnet_motor, tension_ratio
exec(compile(open("laws.py").read(), "laws.py", "exec"))  # as if the script itself defined them

driver, driven = drive.pulleys
motor = dict(kind="permanent_magnet_motor", voltage="3 V", torque_constant=0.5, resistance=0.5, current_limit=2.0)
own = drive.replace(
    belt=drive.belt.replace(stretch_law="stiffening", growth=40.0, exponent=2.5),
    contact=drive.contact.replace(friction_law="dry", creep_scale="1 mm/s", creep_rate_factor=None),
    pulley=[driver.replace(speed=None, inertia=0.02, load=[motor]), driven],
)
run = bd.simulate(own, "run.nc", overwrite=True)
assert abs(float(run.dataset["energy_closure"][-1])) < 1e-3 * float(run.dataset["torque_work"][-1])
assert [path.name for path in bd.plot.save_all(run, "figures", ["tension_ratio"], overwrite=True)] == [
    "tension_ratio.png"
]
turning = own.replace(pulley=[driver.replace(speed="12 rad/s"), driven.replace(torque="-0.1 N m")])
steady = bd.steady_state(turning)
print(run.dataset["pulley_speed"].values[-1, 0], steady.dataset["pulley_speed"].values[-1, 1])
"""
TENSIONER = """
import numpy as np
import beltdyn as bd
import gas_spring

force, column, exponent = 120.0, 0.08, 1.2
drive = bd.example("two_pulley")
gas = dict(kind="gas_spring", pulley="driven", direction=[1, 0], mass=0.5)
gas |= dict(force=force, column=column, exponent=exponent)
rest = bd.equilibrium(drive.replace(tensioner=[gas])).dataset
place = rest["tensioner_position"].values.item()
print(rest["hub_force"].values.reshape(2, 2)[1, 0] / -(force * (column / (column + place)) ** exponent))
"""
OPEN = """
import beltdyn as bd
run = bd.open_result("run.nc")
print(run.dataset["pulley_speed"].values[-1, 0])
try:
    run.drive
except bd.ModelError as error:
    print(error)
"""


def run(folder: Path, script: str, *arguments: str) -> list[str]:
    """What a script prints, in lines, with the examples in its path."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(CODE), os.environ.get("PYTHONPATH", "")])}
    environment |= {CACHE_VARIABLE: str(folder / "cache")}
    (folder / "script.py").write_text(script, encoding="utf-8")
    command = [sys.executable, "-W", "ignore", "script.py", *arguments]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_every_name_is_there() -> None:
    assert all(getattr(beltdyn.extend, name) is not None for name in beltdyn.extend.__all__)


@pytest.mark.slow
def test_the_examples_are_modules_of_a_script(tmp_path: Path) -> None:
    assert set(run(tmp_path, READ)) == {
        'stretch law "rubber" rubber',
        'element "cable" cable',
        'surface "lobed" lobed',
        'load "permanent_magnet_motor" permanent_magnet_motor',
        'hub coupling "progressive_coupling" progressive_coupling',
        'normal law "hunt_crossley" hunt_crossley',
        'friction law "smooth" smooth',
        "tension_ratio True",
    }


@pytest.mark.slow
def test_a_tensioner_of_a_script_is_in_balance_from_an_empty_cache(tmp_path: Path) -> None:
    """Another process, which does not know it, compiles a part."""
    assert float(run(tmp_path, TENSIONER)[0]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.slow
def test_a_script_with_own_laws_a_load_and_a_figure(tmp_path: Path) -> None:
    """From an empty cache, from a full one, behind a run without them, and with a changed law."""
    (tmp_path / "laws.py").write_text(f"FACTOR = 1.0\n{LAWS}", encoding="utf-8")
    cold = run(tmp_path, SCRIPT)
    kernels = sorted((tmp_path / "cache").rglob("*.kernel"))
    assert run(tmp_path, SCRIPT) == cold
    assert sorted((tmp_path / "cache").rglob("*.kernel")) == kernels
    assert run(tmp_path, SCRIPT, "late") == cold

    speed, message = run(tmp_path, OPEN)
    assert float(speed) == float(cold[0].split()[0])
    assert 'friction law "dry" of a script' in message
    assert 'load "permanent_magnet_motor" of the module permanent_magnet_motor' in message

    shutil.rmtree(tmp_path / "figures")
    (tmp_path / "laws.py").write_text(f"FACTOR = 0.5\n{LAWS}", encoding="utf-8")
    changed = run(tmp_path, SCRIPT)
    assert float(changed[0].split()[1]) < float(cold[0].split()[1])  # less friction, more slip
