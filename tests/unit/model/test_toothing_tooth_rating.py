"""The rating of toothed belts by hand: teeth in mesh, speed, centrifugal force and cords; standard widths and belts."""

from math import inf, pi
from pathlib import Path

import numpy as np
import pytest

from beltdyn.model import example, install, loads, read_catalogue
from beltdyn.model.advice import advise
from beltdyn.model.toothing import RatedTeeth, Toothing, ToothRating

RATING = ToothRating(counted_teeth=6.0, largest_speed=40.0, widths=(0.01, 0.02), source="by hand")
TEETH = Toothing(pitch=0.01, tooth_stiffness=1e6, largest_tooth_load=50.0)
BOTH = np.ones(2, dtype=bool)
TEXT = """
[belt]
profile = "HTD 5M"
width = "9 mm"
teeth = 120
installed_tension = "TENSION N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
teeth = 20
speed = "1000 rpm"
[[pulley]]
name = "shaft"
center = [0.25, 0.0]
teeth = 20
inertia = 1e-4
torque = "-TORQUE N m"
[[tensioner]]
kind = "fixed"
pulley = "shaft"
direction = [1, 0]
[simulation]
duration = 1.0
"""


def rated(rating: ToothRating = RATING, most: float | None = None) -> RatedTeeth:
    return RatedTeeth(rating, TEETH, 0.01, 0.2, most)


def test_the_pull_is_that_of_the_teeth_in_mesh_less_centrifugal_force() -> None:
    diameters = np.array([8.0, 20.0]) * 0.01 / pi
    found = rated().on(diameters, np.array([pi, pi]), 5.0, BOTH)
    assert found.in_mesh == pytest.approx([4.0, 10.0])
    assert found.pull == pytest.approx([4 * 50.0 - 0.2 * 25.0, 6 * 50.0 - 0.2 * 25.0])
    assert found.power == pytest.approx(5.0 * found.pull)
    assert rated(most=120.0).on(diameters, np.array([pi, pi]), 5.0, BOTH).pull == pytest.approx(115.0)
    assert np.isnan(found.on(np.array([True, False])).pull).tolist() == [False, True]


def test_teeth_of_fast_pulleys_carry_less() -> None:
    falling = RATING.replace(speed_loss=0.3, loss_speed=10.0)
    found = rated(falling).on(np.array([0.1, 0.2]), np.array([pi, pi]), 4.5, BOTH)
    assert found.load == pytest.approx(50.0 * (1.0 - 0.3 * np.log10([10.0, 5.5])))


def test_the_next_standard_width() -> None:
    assert [RATING.next_width(one) for one in (0.003, 0.01, 0.0101, 0.03)] == [0.01, 0.01, 0.02, inf]
    assert RATING.replace(widths=()).next_width(0.0123) == 0.0123


@pytest.mark.parametrize("name", [name for name, one in read_catalogue().items() if one.toothing])
def test_toothed_profiles_are_rated_with_standard_belts(name: str) -> None:
    entry = read_catalogue()[name]
    assert entry.tooth_rating is not None
    assert entry.toothing is not None
    assert entry.toothing.largest_tooth_load is not None
    assert list(entry.tooth_counts) == sorted(set(entry.tooth_counts))
    assert entry.lengths == pytest.approx(np.array(entry.tooth_counts) * entry.toothing.pitch)
    assert list(entry.tooth_rating.widths) == sorted(set(entry.tooth_rating.widths))
    by_teeth = entry.toothing.largest_tooth_load * entry.tooth_rating.counted_teeth
    assert entry.largest_tension is not None
    assert 0.5 < by_teeth / entry.largest_tension < 2.0


def test_a_belt_of_a_drive_is_rated_with_its_width() -> None:
    belt, entry = example("timing_drive").rated_belt, read_catalogue()["HTD 8M"]
    assert isinstance(belt, RatedTeeth)
    assert entry.toothing is not None
    assert belt.toothing.largest_tooth_load == pytest.approx(2.0 * (entry.toothing.largest_tooth_load or 0.0))
    assert belt.width == 2.0 * entry.width


def test_check_names_the_width_that_carries_the_pull() -> None:
    """Twenty teeth of 5 mm have 31.8 mm of diameter; 9 mm are rated for 161 N by the cords, 25 mm for 447 N."""
    drive = loads(TEXT.replace("TENSION", "150").replace("TORQUE", "5"))
    told = [one for one in advise(drive, install(drive)) if "teeth in mesh are rated" in one]
    assert len(told) == 1
    assert "is 314.2 N with the service factor, but 10.0 teeth in mesh are rated for 161 N" in told[0]
    assert "Use a belt of 25 mm, the next standard width" in told[0]
    light = loads(TEXT.replace("TENSION", "150").replace("TORQUE", "1.5"))
    assert not [one for one in advise(light, install(light)) if "teeth in mesh are rated" in one]


def test_standard_teeth_need_a_pitch_and_a_rating_the_load_of_a_tooth(tmp_path: Path) -> None:
    lines = "title = 'x'\nsold_by = 'width'\nwidth = 0.01\nthickness = 0.004\naxial_stiffness = 1e5\n"
    lines += "bending_stiffness = 1e-4\nmass_per_length = 0.05\nsource = 'mine'\n"
    file = tmp_path / "mine.toml"
    file.write_text(f"[mine]\n{lines}tooth_counts = [100]\n")
    with pytest.raises(ValueError, match="tooth_counts need the pitch of the teeth"):
        read_catalogue(file)
    rating = "[mine.tooth_rating]\ncounted_teeth = 6\nlargest_speed = 30\nsource = 'mine'\n"
    file.write_text(f"[mine]\n{lines}[mine.toothing]\npitch = 0.008\ntooth_stiffness = 1e6\n{rating}")
    with pytest.raises(ValueError, match=r"tooth_rating needs toothing\.largest_tooth_load"):
        read_catalogue(file)
