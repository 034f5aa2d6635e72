"""Numbers of contact that are set by hand: those that spoil results are named, those near what is chosen are not."""

from importlib.resources import files
from typing import Any

import pytest

from beltdyn.model import Drive, advise, install, loads
from beltdyn.model.advice import judge_contact

EXAMPLES = {
    file.name.removesuffix(".toml"): file.read_text(encoding="utf-8")
    for file in files("beltdyn").joinpath("examples").iterdir()
}


@pytest.fixture(scope="module")
def drive() -> Drive:
    """A drive that chooses all numbers of contact, with a small pulley, a load and a tensioner."""
    return loads(EXAMPLES["alternator_drive"])


def found(drive: Drive) -> list[str]:
    return [str(finding) for finding in judge_contact(drive, install(drive))]


def contact(drive: Drive, **factors: float) -> Drive:
    """The same drive with numbers of contact that are as many times those that it chooses."""
    chosen = drive.completed.contact
    return drive.with_({f"contact.{key}": factor * chosen.given(key) for key, factor in factors.items()})


@pytest.mark.parametrize("name", [name for name in EXAMPLES if name != "two_pulley"])
def test_examples_choose_their_numbers(name: str) -> None:
    assert found(loads(EXAMPLES[name])) == []


@pytest.mark.parametrize("key", ["stiffness", "damping", "creep_ratio"])
@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
def test_numbers_near_those_that_are_chosen(drive: Drive, key: str, factor: float) -> None:
    assert found(contact(drive, **{key: factor})) == []


@pytest.mark.parametrize("frame", ["staying", "travelling"])
@pytest.mark.parametrize(
    ("key", "factor", "words"),
    [
        ("stiffness", 0.01, "100 times softer"),
        ("stiffness", 100.0, "100 times harder"),
        ("damping", 0.0, "0.0% of critical"),
        ("damping", 20.0, "10 times critical"),
        ("creep_ratio", 10.0, "10 times more slowly"),
        ("creep_ratio", 0.01, "100 times more steeply"),
    ],
)
def test_numbers_that_spoil(drive: Drive, key: str, factor: float, words: str, frame: str) -> None:
    """Each is named with its value and the way back, in `check` too, on either mesh."""
    changed = contact(drive.with_({"simulation.frame": frame}), **{key: factor})
    (text,) = found(changed)
    assert text.startswith(f"contact.{key} = ")
    assert words in text
    assert f"Omit contact.{key}" in text
    assert text in advise(changed, install(changed))


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ({"friction_law": "coefficient_slope", "creep_velocity": 1.0}, "contact.creep_velocity = 1: friction"),
        ({"friction_law": "force_slope", "creep_rate_factor": 100.0}, "contact.creep_rate_factor = 100: friction"),
    ],
)
def test_slopes_of_other_laws(drive: Drive, law: dict[str, Any], words: str) -> None:
    """They are judged by the slip at which friction is fully used, at full speed."""
    (text,) = found(drive.replace(contact=drive.contact.replace(**law)))
    assert text.startswith(words)
    assert "Omit contact.friction_law, contact.creep" in text


def test_friction_at_the_point_of_a_belt_that_sinks_in(drive: Drive) -> None:
    point = {"contact.moment_arm": "point"}
    assert found(drive.with_(point)) == []
    soft = contact(drive, stiffness=0.01).with_(point)
    assert [text.split(" ")[0] for text in found(soft)] == ["contact.stiffness", "contact.moment_arm"]


def test_slip_at_a_cord_on_rubber_of_unknown_stiffness(drive: Drive) -> None:
    """Said where contact has a numerical stiffness, and not where the belt or the user gives one."""
    unknown = {"belt.contact_stiffness": None, "belt.compression_loss_factor": 0.0, "contact.stiffness": None}
    light = drive.with_(unknown | {"contact.slip_radius": "cord"})
    (text,) = found(light)
    assert 'Give belt.contact_stiffness, or set contact.slip_radius = "rim"' in text
    assert found(light.with_({"contact.slip_radius": "rim"})) == []
    assert found(light.with_({"contact.stiffness": light.contact_stiffness})) == []


def test_soft_contact_is_told_once(drive: Drive) -> None:
    """Where `check` tells how far the belt sinks in, nothing is added."""
    soft = contact(drive, stiffness=1e-4)
    texts = advise(soft, install(soft))
    assert [text for text in texts if "softer" in text] == []
    assert any("sinks" in text for text in texts)
