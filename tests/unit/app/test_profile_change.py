"""Another profile of the belt: what fits stays, and the rest is converted or cleared."""

import random
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.app.beginnings import edits_of_entry
from beltdyn.app.draft import Draft, draft
from beltdyn.app.forms import fields
from beltdyn.app.profile_change import edits_of_profile
from beltdyn.model import Drive, estimate_at_rest, prepare, read_catalogue
from beltdyn.model.catalogue import Entry
from beltdyn.model.toml import example_texts
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

HERE = Path(__file__).parent
PROFILES = read_catalogue()
SMOOTH: dict[str, Any] = {
    "belt": {"profile": "PK", "ribs": 6, "installed_tension": 300.0},
    "pulley": [
        {"name": "driver", "center": [0, 0], "radius": 0.075, "speed": 150.0},
        {"name": "driven", "center": [0.4, 0.0], "radius": 0.05, "inertia": 0.003},
    ],
}
CHANGES = [*(name for name, entry in PROFILES.items() if entry.strength is None), "EP 400/3", "ST 1000", None]
"""Conveyor belts by class are alike; None is without a profile."""
REFUSALS = (
    "would stretch the belt",  # a round or elastic belt under a heavy preload
    "as placed by the tensioners",
    "must be at most 10000",  # teeth of a conveyor
    "crossed = true is incompatible with teeth",
    'moves "carriage" to',  # whole teeth of a large pitch move a printer's carriage farther
)
"""What no choice of lengths can mend, and messages say."""


def is_heavy(entry: Entry) -> bool:
    """Whether a profile has teeth, or is a conveyor belt, which 300 N do not bend around a small pulley."""
    return entry.toothing is not None or entry.strength is not None


def with_profile(before: Draft, profile: str | None) -> Draft:
    return draft(changed_data(dict(before.data), edits_of_profile(before, profile, HERE)), HERE)


def tension(drive: Drive) -> float:
    return float(estimate_at_rest(prepare(drive))[1].tension)


@cache
def example(name: str) -> Draft:
    return draft(tomllib.loads(example_texts()[name]), HERE)


def check(name: str, profile: str | None) -> Draft:
    """A change of an example: valid with pulleys of their sizes, or refused in words; the file keeps its comments."""
    before, text = example(name), example_texts()[name]
    edits = edits_of_profile(before, profile, HERE)
    after = draft(changed_data(dict(before.data), edits), HERE)
    assert changed_text(text, edits, dict(after.data)) is not None, (name, profile)
    if after.drive is None:
        assert after.told
        assert all(any(words in one.sentence for words in REFUSALS) for one in after.told), (name, profile, after.told)
        return after
    assert before.drive is not None
    toothing = after.drive.belt.toothing if after.drive.belt.teeth else None
    for pulley in after.drive.pulleys:
        old, new = (float(one.radii[one.number_of(pulley.name)]) for one in (before.drive, after.drive))
        rounding = 0.0 if toothing is None or pulley.teeth in (None, 4) else 0.5 * toothing.pitch / (2.0 * np.pi)
        offsets = sum(max(one.belt.pitch_offset, one.belt.back_offset) for one in (before.drive, after.drive))
        if toothing is None or pulley.teeth != 4:
            assert abs(new - old) <= rounding + offsets + 1e-5, (name, profile, pulley.name)
    return after


@pytest.mark.slow
@pytest.mark.parametrize("name", list(example_texts()))
def test_every_example_takes_every_profile(name: str) -> None:
    for profile in CHANGES:
        check(name, profile)


def check_with_a_load(generator: random.Random) -> None:
    """A drawn change of an example, then a new load on a pulley that takes some, and another change."""
    after = check(generator.choice(list(example_texts())), generator.choice(CHANGES))
    number = generator.randrange(len(after.data["pulley"]))
    loads = next((one for one in fields(after.data, ("pulley", number)) if one.key == "load"), None)
    if after.drive is None or loads is None:
        return
    kind = generator.choice(loads.choices)
    edits = edits_of_entry(after.data, loads.location, kind, after.drive)
    loaded = draft(changed_data(dict(after.data), edits), HERE)
    assert loaded.told == [], (kind, loaded.told)
    again = with_profile(loaded, generator.choice(CHANGES))
    assert again.drive is not None or all(any(words in one.sentence for words in REFUSALS) for one in again.told)


@pytest.mark.parametrize("seed", range(12))
def test_examples_take_profiles_and_loads(seed: int) -> None:
    check_with_a_load(random.Random(seed))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 105))
def test_many_examples_take_profiles_and_loads(seed: int) -> None:
    generator = random.Random(seed)
    for _ in range(20):
        check_with_a_load(generator)


@pytest.mark.parametrize("profile", [name for name in CHANGES if name in PROFILES and not is_heavy(PROFILES[name])])
def test_smooth_belts_keep_their_tension(profile: str) -> None:
    """From ribs to any other smooth belt, and back; V-belts and flat belts are about as wide."""
    before = draft(SMOOTH, HERE)
    after = with_profile(before, profile)
    assert after.drive is not None
    assert before.drive is not None
    entry = PROFILES[profile]
    if entry.is_v_belt or entry.sold_by == "width":  # ribs remain ribs, and a round belt has its diameter
        assert after.drive.belt.width == pytest.approx(before.drive.belt.width, rel=0.5)
    if not profile.startswith("round"):
        assert after.data["belt"]["installed_tension"] == 300.0
    again = with_profile(after, "PK")
    assert again.told == []
    assert again.data["belt"].keys() == SMOOTH["belt"].keys()


def test_teeth_come_and_go_with_the_profile() -> None:
    """A fixed tensioner takes up what whole teeth leave, so that the tension stays."""
    before = draft(SMOOTH, HERE)
    after = with_profile(before, "HTD 8M")
    assert after.drive is not None
    assert [one["teeth"] for one in after.data["pulley"]] == [60, 40]
    assert after.data["belt"]["width"] == "20 mm"
    assert [one["kind"] for one in after.data["tensioner"]] == ["fixed"]
    assert tension(after.drive) == pytest.approx(300.0, rel=0.01)
    back = with_profile(after, "PK")
    assert back.drive is not None
    assert "teeth" not in back.data["belt"]
    assert all("teeth" not in one for one in back.data["pulley"])
    assert tension(back.drive) == pytest.approx(300.0, rel=0.01)


def test_a_timing_drive_is_itself_again() -> None:
    before = example("timing_drive")
    again = with_profile(with_profile(before, "PK"), "HTD 8M")
    assert [one.get("teeth") for one in again.data["pulley"]] == [one.get("teeth") for one in before.data["pulley"]]
    assert again.data["belt"] == before.data["belt"] | {"width": again.data["belt"]["width"]}


@pytest.mark.parametrize("profile", ["XH", "T5", "flat-aramid"])
@pytest.mark.parametrize("name", ["gantry_axis", "printer_axis"])
def test_a_carriage_stays_on_the_line_of_its_belt(name: str, profile: str) -> None:
    """Both pulleys are of one size, and the shafts at zero height: whole teeth change the height of the line."""
    drive = draft(changed_data(dict(example(name).data), edits_of_profile(example(name), profile, HERE)), HERE)
    if drive.drive is None:
        assert "beyond its stroke" in drive.told[0].sentence
        return
    assert drive.drive.carriage is not None
    assert drive.drive.carriage.center[1] == pytest.approx(float(drive.drive.radii[0]), abs=2e-6)


def test_a_nominal_length_stays_where_it_is_sold() -> None:
    drive = draft(changed_data(SMOOTH, [Edit("remove", ("belt", "installed_tension"))]), HERE)
    sold = next(length for length in PROFILES["SPZ"].lengths if length in PROFILES["SPA"].lengths and length > 1.0)
    distance = 0.5 * (sold - np.pi * 0.125) - 0.001
    belt = {"profile": "SPZ", "ribs": 2, "nominal_length": f"{1e3 * sold:g} mm"}
    pulleys = [drive.data["pulley"][0], drive.data["pulley"][1] | {"center": [float(distance), 0.0]}]
    before = draft({"belt": belt, "pulley": pulleys}, HERE)
    assert before.drive is not None, before.told
    assert with_profile(before, "XPZ").data["belt"].get("nominal_length") == belt["nominal_length"]
    other = with_profile(before, "PJ-elastic")
    assert other.drive is not None
    assert tension(other.drive) == pytest.approx(tension(before.drive), rel=0.5)


def test_values_stay_without_the_profile() -> None:
    before = draft(SMOOTH, HERE)
    after = with_profile(before, None)
    assert before.drive is not None
    assert after.drive is not None
    assert "profile" not in after.data["belt"]
    assert "ribs" not in after.data["belt"]
    assert after.drive.belt.axial_stiffness == pytest.approx(before.drive.belt.axial_stiffness, rel=1e-4)
    assert after.drive.frictions == pytest.approx(before.drive.frictions, rel=1e-4)


@pytest.mark.parametrize("profile", ["PJ", "SPA", "flat-aramid", "round-85A", "HTD 8M"])
@pytest.mark.parametrize("broken", [{"pulley": []}, {"belt": {}}, {"belt": {"profile": "PK", "friction": "wet"}}, {}])
def test_drives_that_are_not_whole_yet_take_profiles(profile: str, broken: dict[str, Any]) -> None:
    """As on an empty canvas; what the belt then lacks is said."""
    before = draft(SMOOTH | broken, HERE)
    after = with_profile(before, profile)
    assert after.data["belt"]["profile"] == profile
    assert "ribs" not in after.data["belt"] or PROFILES[profile].sold_by == "ribs"
    assert with_profile(after, None).data["belt"].get("profile") is None
