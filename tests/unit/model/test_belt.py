import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive


def test_section_of_the_papers_belt(drive: Drive) -> None:
    belt = drive.belt.replace(shear_correction=13 / 15.3)
    assert belt.area == pytest.approx(1e-4)
    assert belt.second_moment == pytest.approx(1e-8 / 12)
    assert belt.fourth_moment == pytest.approx(1e-12 / 80)
    assert belt.shear_modulus == pytest.approx(1e8 / 2.6)
    assert belt.shear_stiffness == pytest.approx(13 / 15.3 * 1e8 / 2.6 * 1e-4 * 0.01)
    assert belt.axial_stiffness == pytest.approx(1e4)
    assert belt.bending_stiffness == pytest.approx(1e8 * 1e-8 / 12 * 0.01)
    assert belt.mass_per_length == pytest.approx(0.1036)
    assert belt.rotary_inertia == pytest.approx(1036e-8 / 12)


def test_the_thickness_lies_in_the_plane_of_bending(drive: Drive) -> None:
    flat = drive.belt.replace(width=0.02, thickness=0.005)
    assert flat.area == pytest.approx(drive.belt.area)
    assert flat.second_moment == pytest.approx(drive.belt.second_moment / 4)


def test_sections_stay_normal_without_a_shear_correction(drive: Drive) -> None:
    """Then shear does not follow the bending stiffness, which is measured with all that gives way."""
    normal = drive.belt
    assert normal.shear_stiffness == pytest.approx(20.0 * normal.axial_stiffness)
    assert normal.replace(bending_factor=1e-3).shear_stiffness == normal.shear_stiffness
    assert drive.belt.replace(shear_correction=0.5).shear_stiffness == pytest.approx(0.5 * 1e8 / 2.6 * 1e-6)


def test_replace_validates(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"belt\.width = -1"):
        drive.belt.replace(width=-1)


def test_parts_cannot_be_changed(drive: Drive) -> None:
    with pytest.raises(ValueError, match="frozen"):
        drive.belt.length = 1.0  # type: ignore[misc]


def test_the_constructor_tells_all_that_is_wrong() -> None:
    with pytest.raises(ModelError) as caught:
        Belt(length=-1, width=0.01, thickness=0.01, density=1000, youngs_modulus=1e8)  # type: ignore[call-arg]
    first, second = str(caught.value).splitlines()
    assert first.startswith("belt.length = -1 must be greater than 0")
    assert second.startswith("belt.poissons_ratio is missing")


@pytest.mark.parametrize(("kind", "curves"), [("ancf", 12), ("truss", 12), ("three-node-beam", 24)])
def test_curves(drive: Drive, kind: str, curves: int) -> None:
    belt = drive.belt.replace(elements=12, discretization=kind)
    assert belt.element_kind.name == kind
    assert belt.element_kind.curves * belt.given_elements == curves


@pytest.mark.parametrize("kind", ["ancf", "truss", "three-node-beam"])
def test_fewest_elements(drive: Drive, kind: str) -> None:
    assert drive.belt.replace(elements=3, discretization=kind).elements == 3


def test_length_and_installed_tension_take_the_place_of_each_other(drive: Drive) -> None:
    asked = drive.belt.replace(installed_tension=40.0)
    assert "length" not in asked.arguments
    assert asked.installed_tension == 40.0
    again = asked.replace(length=1.2)
    assert (again.length, again.installed_tension) == (1.2, None)
    assert drive.belt.replace(length=None, installed_tension=40.0) == asked


def test_a_belt_with_length_and_tension_keeps_both(drive: Drive) -> None:
    """Then a fixed tensioner takes up what is missing."""
    both = drive.belt.replace(length=1.2, installed_tension=40.0)
    assert (both.length, both.installed_tension) == (1.2, 40.0)
    assert both.replace(installed_tension=50.0).length == 1.2


def test_a_belt_without_length_and_tension_is_refused(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"length is missing\. Give the unstretched length, nominal_length or"):
        drive.replace(belt=drive.belt.replace(length=None))


def test_compression_needs_to_know_how_hard_the_belt_is(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"compression_loss_factor = 0\.4 needs contact_stiffness"):
        drive.belt.replace(compression_loss_factor=0.4)
    assert drive.belt.replace(compression_loss_factor=0.4, contact_stiffness=1e7).compression_loss_factor == 0.4
