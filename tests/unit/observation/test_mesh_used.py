"""Results name the mesh and the elements that they are from, whatever analysis and elements a drive asks for."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest

from beltdyn import campbell, equilibrium, modes, operating_map, sensitivity, simulate, steady_state, traction
from beltdyn import sheet as drive_sheet
from beltdyn.elements import ELEMENTS
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, prepare
from beltdyn.results import Result
from beltdyn.results.provenance import mesh_used
from beltdyn.results.summary import VALUES
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Facts

Change = Callable[..., Drive]
ASKED = (None, *ELEMENTS)
FLOWING: Mapping[str, Callable[[Drive], Result]] = {
    "steady": lambda drive: steady_state(drive, at=1.0),
    "modes": lambda drive: modes(drive, about="rest", count=2),
}
ON_QUINTICS: Mapping[str, Callable[[Drive], object]] = {
    **FLOWING,
    "map": lambda drive: operating_map(drive, speed="60 rpm"),
    "traction": traction,
    "sensitivity": lambda drive: sensitivity(drive, of="largest_tension", numbers="belt.length"),
    "sheet": drive_sheet,
    "campbell": lambda drive: campbell(drive, speed="60, 90 rpm"),
}
"""Analyses about rest or steady running, on a mesh that stays."""
SLOW = [pytest.param(one, marks=() if one is None else pytest.mark.slow) for one in ASKED]


@pytest.fixture
def asked(change: Change) -> Callable[[str | None], Drive]:
    """The paper's drive with its mesh left open and elements of a kind, or of none."""

    def drive(kind: str | None) -> Drive:
        data: dict[str, Any] = change().model_dump(by_alias=True, exclude_none=True)
        del data["simulation"]["frame"]
        return Drive(**data | {"belt": data["belt"] | ({"discretization": kind} if kind else {})})

    return drive


def mesh_of(result: Result) -> tuple[str, str, str]:
    """Frame, elements and what is unused, as the attributes say, of elements that the coordinates are those of."""
    said = result.dataset.attrs
    if "coordinate" in result.dataset.coords:
        assert tuple(result.dataset["coordinate"].values) == ELEMENTS[said["mesh_element"]].coordinates
        assert ELEMENTS[said["mesh_element"]].curves * said["mesh_elements"] == result.dataset.sizes["element"]
    facts = dict(fact for part in sheet(result).parts if isinstance(part, Facts) for fact in part.facts)
    assert facts["mesh"].startswith(f"{said['mesh_elements']} {said['mesh_element']} elements, {said['mesh_frame']}")
    assert ("not used" in facts) == bool(said["mesh_unused"])
    return said["mesh_frame"], said["mesh_element"], said["mesh_unused"]


@pytest.mark.parametrize("kind", [None, "quintic"])
@pytest.mark.parametrize("analysis", FLOWING)
def test_analyses_about_rest_and_steady_running_have_a_mesh_that_stays(
    asked: Callable[[str | None], Drive], analysis: str, kind: str | None
) -> None:
    """What quadrature the drive asks for in runs, they say that it is not used."""
    assert mesh_of(FLOWING[analysis](asked(kind))) == ("staying", "quintic", "")
    other = asked(kind).with_({"belt.quadrature_points": 3})
    assert mesh_of(FLOWING[analysis](other)) == ("staying", "quintic", "belt.quadrature_points = 3")


@pytest.mark.parametrize("kind", sorted(set(ELEMENTS) - {"quintic"}))
@pytest.mark.parametrize("analysis", ON_QUINTICS)
def test_elements_that_an_analysis_would_ignore_are_refused_there(
    asked: Callable[[str | None], Drive], analysis: str, kind: str
) -> None:
    with pytest.raises(ModelError, match=f'belt.discretization = "{kind}" would have no effect: .* Omit it, or'):
        ON_QUINTICS[analysis](asked(kind))


@pytest.mark.parametrize("kind", SLOW)
def test_rest_on_equal_elements_has_those_that_are_asked_for(
    asked: Callable[[str | None], Drive], kind: str | None
) -> None:
    assert mesh_of(equilibrium(asked(kind))) == ("travelling", kind or "ancf", "")


@pytest.mark.parametrize("kind", SLOW)
def test_a_run_has_the_mesh_that_its_elements_need(asked: Callable[[str | None], Drive], kind: str | None) -> None:
    stays = kind in (None, "quintic")
    run = simulate(asked(kind))
    assert mesh_of(run) == ("staying" if stays else "travelling", kind or "quintic", "")
    assert run.dataset.attrs["mesh_frame_reason"] == ("" if stays else f'since belt.discretization = "{kind}"')


def test_a_mesh_that_is_to_stay_refuses_elements_that_it_does_not_have(change: Change) -> None:
    with pytest.raises(ModelError, match=r'belt\.discretization = "truss" is incompatible .* Remove one'):
        change(belt={"discretization": "truss"}, simulation={"frame": "staying"})


@pytest.mark.slow  # kernels of trusses over time
def test_a_run_on_other_elements_is_compared_with_steady_running_on_those_that_it_has(change: Change) -> None:
    drive = change(belt={"discretization": "truss"}, simulation={"frame": "travelling"})
    turning = drive.with_({"pulley[driver].speed": "5 rpm"})
    assert VALUES in simulate(turning, compare_steady=True).dataset.attrs


def test_the_elements_that_are_named_are_those_of_the_drive() -> None:
    """Open belts with teeth travel on quintics, without teeth on the paper's elements."""
    found = []
    for drive in (example("printer_axis"), example("band_brake"), example("timing_drive"), example("two_pulley")):
        prepared = prepare(drive)
        found.append(mesh_used(drive, prepared.frame)["mesh_element"])
        assert found[-1] == prepared.element_kind.name
    assert found == ["quintic", "ancf", "quintic", "ancf"]


@pytest.mark.slow
def test_they_are_those_of_results_by_their_coordinates() -> None:
    for drive in (example("printer_axis"), example("band_brake")):
        rest = equilibrium(drive).dataset
        assert tuple(rest.coordinate.values.tolist()) == ELEMENTS[rest.attrs["mesh_element"]].coordinates


@pytest.mark.slow
def test_other_integrators_take_a_mesh_that_travels(asked: Callable[[str | None], Drive]) -> None:
    drive = asked(None)
    other = drive.replace(simulation=drive.simulation.replace(integrator="cvode"))
    run = simulate(other)
    assert mesh_of(run) == ("travelling", "ancf", "")
    assert run.dataset.attrs["mesh_frame_reason"] == 'since simulation.integrator = "cvode"'


def test_a_run_goes_on_on_the_mesh_of_that_in_which_it_begins(change: Change, tmp_path: Any) -> None:
    """Though the drive leaves its mesh open."""
    before = simulate(change(), tmp_path / "before.nc")
    start = {"file": str(before.path)}
    data = change(simulation={"start": start}).model_dump(by_alias=True, exclude_none=True)
    del data["simulation"]["frame"]
    run = simulate(Drive(**data))
    assert mesh_of(run) == ("travelling", "ancf", "")
    assert run.dataset.attrs["mesh_frame_reason"] == "as in the run it continues"
