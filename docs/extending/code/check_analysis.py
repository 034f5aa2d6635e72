from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main

drive = bd.example("two_pulley")
tension, stiffness = 200.0, drive.belt.axial_stiffness
length = drive.path.length / (1.0 + tension / stiffness)
tight = drive.replace(belt=drive.belt.replace(length=length, elements=40, bending_factor=1e-3))

found = bd.natural_frequencies(tight, count=5)
strain = drive.path.length / length - 1.0
pull = float(bd.equilibrium(tight).dataset.span_tension[0])
speed = np.sqrt(pull * (1.0 + strain) / tight.belt.mass_per_length)
string = speed / (2.0 * drive.path.span_lengths[0])
frequency = found.dataset.frequency.values
assert np.allclose(frequency[1:], string * np.array([1.0, 1.0, 2.0, 2.0]), rtol=0.01)
assert found.dataset.damping_ratio.values.min() > 0.0
assert found.warnings == []

Path("tight.toml").write_text(bd.dumps(tight), encoding="utf-8")
with pytest.raises(SystemExit) as ended:
    main(["natural-frequencies", "tight.toml", "--count", "3"])
assert ended.value.code == 0
saved = bd.open_result("tight-natural-frequencies.nc")
assert saved.kind == "natural_frequencies"
assert np.allclose(saved.dataset.frequency, frequency[:3])
