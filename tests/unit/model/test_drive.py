import pickle
import re
from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, advise, describe_time, dumps, install, loads
from beltdyn.model.layout import with_chosen
from validation.published import loaded_two_pulley

MakeDrive = Callable[..., Drive]


def test_constructor_takes_parts_or_mappings(drive: Drive) -> None:
    again = Drive(
        belt=drive.belt,
        pulley=[drive.pulleys[0], drive.pulleys[1].model_dump()],
        contact=drive.contact,
        simulation={"duration": 1.0, "output_interval": "1 ms", "frame": "travelling", "start": "laid"},
    )
    assert again == drive
    assert hash(again) == hash(drive)


def test_replace_lays_the_path_anew(drive: Drive) -> None:
    shifted = drive.pulleys[1].replace(center=(0.192, 0.0))
    changed = drive.replace(pulley=[drive.pulleys[0], shifted])
    assert changed.path.length == pytest.approx(drive.path.length + 2 * (0.192 - 0.191441))
    assert "0.192" in changed.text


def test_slack_belt(drive: Drive) -> None:
    with pytest.raises(ModelError) as caught:
        drive.replace(belt=drive.belt.replace(length=1.40))
    assert str(caught.value) == (
        "belt.length = 1.4 m is longer than the path around the pulleys (1.2763 m): the belt would hang slack. "
        "Shorten it, or move the pulleys apart."
    )


def test_a_belt_that_is_hardly_too_long_is_told_with_enough_digits(drive: Drive) -> None:
    length = drive.path.length
    with pytest.raises(ModelError, match=rf"belt.length = {length!r} m is as long as the path .* \({length!r} m\)"):
        drive.replace(belt=drive.belt.replace(length=length))
    longer = length + 2e-9
    with pytest.raises(ModelError, match=rf"belt.length = {longer:.10g} m is longer than .* \({length:.10g} m\)"):
        drive.replace(belt=drive.belt.replace(length=longer))


def test_numbers_that_follow_and_cannot_be_used_are_told_as_such(drive: Drive) -> None:
    """And not as if the file had given them."""
    with pytest.raises(ValueError, match=r"the default contact.stiffness = 1e\+16, .* is not usable"):
        with_chosen(drive.contact, drive.belt, {"stiffness": 1e16})


def test_pulleys_know_their_motion(drive: Drive) -> None:
    assert [pulley.prescribed for pulley in drive.pulleys] == [True, False]


def test_installation_of_the_papers_drive(drive: Drive) -> None:
    """The measured mean tension of this drive at rest is 26.6 N, its penetration 3e-5 m."""
    installation = install(drive)
    stretch = drive.path.length / 1.2727
    assert installation.strain == pytest.approx(stretch - 1)
    assert installation.laid_tension == pytest.approx(1e4 * (stretch**2 - 1) * stretch / 2)
    assert installation.tension == pytest.approx(26.6, abs=0.1)
    np.testing.assert_allclose(installation.penetrations, 3.3e-5, rtol=0.02)


def test_the_time_that_a_run_takes(drive: Drive) -> None:
    """Where it is long with what makes it so."""

    def told(**simulation: float) -> str:
        return describe_time(drive.replace(simulation=drive.simulation.replace(**simulation)))

    assert told(duration=100.0, rtol=1e-4) == "about 34 s (6.9 to 140 s)"
    assert told(duration=1000.0, rtol=1e-4) == (
        "about 5.7 min (1.1 to 23 min): 1000 s in 3,000,000 steps, limited by simulation.rtol = 0.0001"
    )
    stepped = told(duration=1000.0, rtol=1e-2, max_step=1e-4)
    assert stepped.endswith("in 10,000,000 steps, limited by simulation.max_step = 0.0001 s")
    assert describe_time(drive.replace(simulation=drive.simulation.replace(integrator="bdf"))) == ""


def test_installed_belt_balances(drive: Drive) -> None:
    """The path shortened by the penetrations is as long as the belt at this tension."""
    installation = install(drive)
    shortened = drive.path.length - drive.path.wrap_angles @ installation.penetrations
    stretch = shortened / drive.belt_length
    assert installation.tension == pytest.approx(1e4 * (stretch**2 - 1) * stretch / 2)


def test_advice_on_the_mesh(drive: Drive) -> None:
    """The belt takes what is advised; that it resolves what is said is validated in tests/validation."""
    tension, *contact, mesh = advise(drive, install(drive))
    needed = max(int(number) for number in re.findall(r"(\d+) for ", mesh))
    fine = drive.replace(belt=drive.belt.replace(elements=needed))
    assert advise(fine, install(fine)) == [tension, *contact]
    coarse = drive.replace(belt=drive.belt.replace(elements=needed // 2))
    assert len(advise(coarse, install(coarse))) == 2 + len(contact)


def test_advice_on_the_tension_lost(drive: Drive) -> None:
    """With the stiffness that is advised, less than 2 % is lost, by the rounding up."""
    warning = advise(drive, install(drive))[0]
    assert warning == (
        "the contact between belt and pulleys is so soft that it reduces the belt tension by 5.8%, more than 2%. "
        "Tensions and hub loads are too low by that share: about 26.56 N instead of 28.19 N on rigid pulleys. Increase "
        "contact.stiffness to 3.1e+07 N/m^2 or more (contact.allowed_penetration = 1.1e-05 m)."
    )
    stiff = drive.replace(contact=drive.contact.replace(stiffness=3.1e7))
    installation = install(stiff)
    assert not any("soft" in warning for warning in advise(stiff, installation))
    assert installation.tension / installation.laid_tension == pytest.approx(0.98, abs=1e-3)


def test_advice_on_a_belt_of_given_tension_is_about_its_length(drive: Drive) -> None:
    """It has the tension that was asked for; what penetration costs is length, which other contact gives back."""
    soft = drive.belt.replace(installed_tension=26.56)
    given = drive.replace(belt=soft)
    hard = drive.replace(belt=soft, contact=drive.contact.replace(stiffness=1e14))
    (warning,) = (text for text in advise(given, install(given)) if "rigid pulleys" in text)
    assert warning == (
        "the contact between belt and pulleys is so soft that the belt must be "
        f"{1e3 * (hard.belt_length - given.belt_length):.3g} mm shorter for 26.56 N than on rigid pulleys. Its length "
        f"of {given.belt_length:.5g} m is too short by that amount; the tension is correct, after a loss of 5.8%. If "
        "the length matters, increase contact.stiffness to 3.1e+07 N/m^2 or more (contact.allowed_penetration = 1.0e-05"
        " m)."
    )
    for remedy in ({"stiffness": 3.1e7}, {"allowed_penetration": 1.0e-5}):
        better = drive.replace(belt=soft, contact=drive.contact.replace(**remedy))
        installation = install(better)
        assert not any("rigid pulleys" in text for text in advise(better, installation))
        assert installation.tension == pytest.approx(26.56)
        assert 0.975 < installation.tension / installation.laid_tension < 0.985


def test_advice_on_the_tension_lost_in_case_2() -> None:
    """The loaded drive of the paper loses two fifths of its tension."""
    case = loaded_two_pulley()
    warning = advise(case, install(case))[0]
    assert "reduces the belt tension by 40.1%, more than 2%" in warning


def test_advice_on_soft_pulleys(drive: Drive) -> None:
    belt = drive.belt.replace(length=1.1, elements=100)
    soft = drive.replace(belt=belt, contact=drive.contact.replace(stiffness=1e5))
    strain, tension, penetration, *_ = advise(soft, install(soft))
    assert "at rest is stretched by 16.0%, more than 10%" in strain
    assert "reduces the belt tension by" in tension
    assert re.search(
        r"into driver by (\d+%) of its radius and into driven by \1 of its radius, more than 10%", penetration
    )


def test_elements_without_ends_cannot_be_tied_by_multipliers(drive: Drive) -> None:
    beams = drive.belt.replace(discretization="three-node-beam", elements=30)
    with pytest.raises(ModelError) as caught:
        drive.replace(belt=beams, simulation=drive.simulation.replace(joint="multipliers"))
    assert str(caught.value) == (
        'simulation.joint = "multipliers" is incompatible with belt.discretization = "three-node-beam", whose elements '
        'have no ends to join. Choose joint = "shared_node", or discretization = "ancf".'
    )


@pytest.mark.parametrize(("kind", "links_each"), [("truss", 1), ("three-node-beam", 2)])
def test_advice_on_links(drive: Drive, kind: str, links_each: int) -> None:
    """The belt takes what is advised; a beam has two links, and needs half as many elements as a truss."""
    chain = drive.replace(belt=drive.belt.replace(discretization=kind, elements=60))
    tension, *contact, mesh = advise(chain, install(chain))
    needed = max(int(number) for number in re.findall(r"(\d+) for ", mesh))
    trusses = drive.replace(belt=drive.belt.replace(discretization="truss", elements=60))
    links = max(int(number) for number in re.findall(r"(\d+) for ", advise(trusses, install(trusses))[-1]))
    assert needed * links_each == pytest.approx(links, abs=3 * links_each)
    brief = chain.simulation.replace(duration=1e-3, output_interval=1e-3)
    advised = chain.replace(belt=chain.belt.replace(elements=needed), simulation=brief)
    assert advise(advised, install(advised)) == [tension, *contact]


def test_contact_at_nodes_needs_the_mesh_that_contact_along_elements_needs(drive: Drive) -> None:
    nodal = drive.replace(contact=drive.contact.replace(sampling="nodal"))
    assert advise(nodal, install(nodal)) == advise(drive, install(drive))


def test_a_drive_travels_between_processes_with_its_text(drive: Drive) -> None:
    """Its profiles are generic classes, which cannot travel on their own."""
    again = pickle.loads(pickle.dumps(drive))
    assert (again, again.text) == (drive, drive.text)
    changed = drive.replace(simulation=drive.simulation.replace(rtol=1 / 3e4))
    assert pickle.loads(pickle.dumps(changed)) == changed


def test_breakpoints_are_those_of_all_profiles(drive: Drive) -> None:
    """Of the paper's ramps, which coincide, and of what switches loads and clutches."""
    schedule = {"kind": "step", "time": 0.3, "value": 1.0}
    load = {"kind": "resistance", "linear": 0.1, "schedule": schedule}
    clutch = {"kind": "friction_clutch", "capacity": 1.0, "locking_damping": 1.0, "inertia": 1.0}
    changed = drive.pulleys[1].replace(load=[load], hub=[clutch | {"schedule": schedule | {"time": 0.1}}])
    assert drive.breakpoints == (0.05, 0.6)
    assert drive.replace(pulley=[drive.pulleys[0], changed]).breakpoints == (0.05, 0.1, 0.3, 0.6)


def test_effective_radii(make_drive: MakeDrive) -> None:
    drive = make_drive("flat", pitch_offset=0.002, back_offset="3 mm")
    np.testing.assert_allclose(drive.radii, [0.102, 0.043, 0.202])
    np.testing.assert_allclose(drive.path.radii, [0.102, -0.043, 0.202])
    np.testing.assert_array_equal(drive.centers, [[0, 0], [0.25, -0.05], [0.8, 0]])
    assert [pulley.turning for pulley in drive.pulleys] == [1, -1, 1]


def test_rolling_radii(make_drive: MakeDrive) -> None:
    """R (1 + 3 EI / 2 EA R^2), of a rectangle R (1 + h^2 / 8 R^2), to first order; bending does not shorten links."""
    drive = make_drive("flat", bending_factor=1.0)
    part = 0.125 * (drive.belt.thickness / drive.radii) ** 2
    np.testing.assert_allclose(drive.rolling_radii / drive.radii - 1.0, part, rtol=1.1 * part.max())
    links = drive.replace(belt=drive.belt.replace(discretization="truss", elements=60))
    np.testing.assert_array_equal(links.rolling_radii, links.radii)


def test_tensioner_on_its_stop(make_drive: MakeDrive) -> None:
    tensioner = {"kind": "sliding", "pulley": "idler", "direction": (0, 1), "mass": 0.5, "preload": 900.0}
    held = tensioner | {"stops": (-0.01, 0.01), "stop_stiffness": 1e7}
    drive = make_drive("flat", length=2.6, tensioner=[held])
    assert any("the tensioner of idler rests on its upper stop" in warning for warning in advise(drive, install(drive)))
    free = make_drive("flat", length=2.6, tensioner=[tensioner | {"mass": 0.5, "preload": 300.0, "rate": 2e3}])
    assert not any("stop" in warning or "soft" in warning for warning in advise(free, install(free)))


@pytest.mark.parametrize("layout", ["open", "crossed", "flat", "serpentine"])
def test_drives_of_any_layout_travel_between_processes(make_drive: MakeDrive, layout: str) -> None:
    drive = make_drive(layout, contact={"allowed_penetration": 1e-5}, pitch_offset=0.001)
    assert pickle.loads(pickle.dumps(drive)) == drive
    assert drive.replace(simulation=drive.simulation.replace(rtol=1e-4)).belt == drive.belt


def test_friction_is_the_pulleys_or_the_contacts_or_the_belts(drive: Drive) -> None:
    driver, driven = drive.pulleys
    belt = drive.belt.replace(friction=0.5)
    given = drive.replace(belt=belt, pulley=[driver.replace(friction=0.3), driven])
    assert given.frictions == pytest.approx([0.3, 1.2])
    left = given.replace(contact=drive.contact.replace(friction=None))
    assert left.frictions == pytest.approx([0.3, 0.5])
    with pytest.raises(ModelError, match="friction is missing"):
        drive.replace(contact=drive.contact.replace(friction=None))


def test_a_drive_may_have_a_name_and_a_description(drive: Drive) -> None:
    named = drive.replace(name="  Fan of the paint shop ", description="Two belts.\nInstalled in spring.")
    assert (named.name, named.title, drive.title) == ("Fan of the paint shop", "Fan of the paint shop", "Belt drive")
    assert loads(dumps(named)) == named
    assert "Fan of the paint shop" in named._repr_html_()
    assert "Installed in spring." in named._repr_html_()
    for name in ("", " ", "two\nlines", "x" * 101):
        with pytest.raises(ModelError, match="name"):
            drive.replace(name=name)
