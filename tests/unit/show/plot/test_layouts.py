import itertools
from collections.abc import Iterator
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Wedge
from matplotlib.text import Annotation

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, install, load, prepare
from beltdyn.show import plot
from beltdyn.state.installation import bring_to_rest

TASKS = Path(__file__).parents[4] / "docs" / "tasks"


@pytest.fixture(autouse=True)
def _no_window() -> Iterator[None]:
    with mpl.rc_context({"backend": "agg"}):
        yield
    plt.close("all")


@pytest.fixture
def ax() -> Axes:
    return Figure().add_subplot()


@pytest.fixture
def idler_drive(drive: Drive) -> Drive:
    """The paper's drive with an idler on the back of its lower span, which a spring presses upwards."""
    idler = {"name": "idler", "center": (0.0, -0.09), "radius": 0.03, "side": "outside", "inertia": 0.01}
    spring = {"kind": "rotary", "pulley": "idler", "pivot": (-0.1, -0.15), "inertia": 0.01, "preload": 3.0, "rate": 1.0}
    first, last = drive.pulleys
    return drive.replace(
        pulley=[first, idler, last], tensioner=[spring], belt=drive.belt.replace(length=1.29, pitch_offset=0.002)
    )


def belt_lines(ax: Axes) -> list[np.ndarray]:
    return [np.array(line.get_xydata()) for line in ax.lines if line.get_linewidth() == 3.0]


def test_the_belt_is_drawn_along_its_path(idler_drive: Drive, ax: Axes) -> None:
    installation = install(idler_drive)
    assert plot.layout(idler_drive, install(idler_drive), ax) is ax
    lines, path = belt_lines(ax), installation.path
    assert len(lines) == 6
    for number, (arc, span) in enumerate(zip(lines[:3], lines[3:], strict=True)):
        np.testing.assert_allclose(span, path.span_points[number], atol=1e-12)
        np.testing.assert_allclose(arc[[0, -1]], [path.span_points[number - 1, 1], span[0]], atol=1e-12)
        distance = np.linalg.norm(arc - path.centers[number], axis=1)
        np.testing.assert_allclose(distance, abs(path.radii[number]), rtol=1e-12)


def test_pulleys_show_wrap_name_and_sense(idler_drive: Drive, ax: Axes) -> None:
    plot.layout(idler_drive, install(idler_drive), ax)
    wraps = np.degrees(install(idler_drive).path.wrap_angles)
    wedges = [patch for patch in ax.patches if isinstance(patch, Wedge)]
    np.testing.assert_allclose([wedge.theta2 - wedge.theta1 for wedge in wedges], wraps)
    rims = [p for p in ax.patches if isinstance(p, Circle) and p.get_linewidth() == 0.9 and p.radius > 0.02]
    assert [rim.radius for rim in rims] == [0.08125, 0.03, 0.08125]
    words = [text.get_text() for text in ax.texts]
    assert words[:3] == [
        f"{n} {name}\n{wrap:.0f}°"
        for n, name, wrap in zip((1, 2, 3), ("driver", "idler", "driven"), wraps, strict=True)
    ]
    assert words[3:] == [f"{length:.4g} m" for length in install(idler_drive).path.span_lengths]
    arrows = [p.get_path().vertices for p in ax.patches if isinstance(p, FancyArrowPatch) and p.get_zorder() == 2]
    centers = install(idler_drive).path.centers
    turns = []
    for way, center in zip(arrows, centers, strict=True):
        (x, y), (along, up) = np.asarray(way)[0] - center, np.asarray(way)[10] - center
        turns.append(np.sign(x * up - y * along))
    assert turns == [1, -1, 1]


def test_arm_and_pivot_of_a_tensioner(idler_drive: Drive, ax: Axes) -> None:
    plot.layout(idler_drive, install(idler_drive), ax)
    arm = next(line for line in ax.lines if line.get_linewidth() == 2.0)
    np.testing.assert_allclose(np.array(arm.get_xydata()), [(-0.1, -0.15), install(idler_drive).path.centers[1]])


def test_crossing_spans_have_a_gap(drive: Drive, ax: Axes) -> None:
    first, last = drive.pulleys
    belt = drive.belt.replace(crossed=True, length=1.3)
    plot.layout(drive.replace(pulley=[first, last.replace(side="outside")], belt=belt), ax=ax)
    gaps = [line for line in ax.lines if line.get_color() == "white"]
    assert len(gaps) == 2
    plain = Figure().add_subplot()
    plot.layout(drive, ax=plain)
    assert not [line for line in plain.lines if line.get_color() == "white"]


def test_long_names_fit(drive: Drive, ax: Axes) -> None:
    """Beside a small pulley, on the left here, a name takes its own room."""
    first, last = drive.pulleys
    small = first.replace(name="a pulley with a name as long as the drive", radius=0.03)
    plot.layout(drive.replace(pulley=[small, last], belt=drive.belt.replace(length=1.115)), ax=ax)
    ax.figure.canvas.figure.draw_without_rendering()
    frame = ax.get_window_extent()
    for text in ax.texts:
        low, high = text.get_window_extent().get_points()
        assert np.all(low >= frame.p0)
        assert np.all(high <= frame.p1)


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_file(drive: Drive, tmp_path: Path, kind: str) -> None:
    file = plot.save_layout(drive, tmp_path / f"layout.{kind}")
    assert file.stat().st_size > 5_000


@pytest.mark.parametrize(("name", "words"), [("layout.bmpx", "not a format for figures"), ("layout", "no suffix")])
def test_unknown_format(drive: Drive, tmp_path: Path, name: str, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        plot.save_layout(drive, tmp_path / name)


def test_unwritable_file(drive: Drive, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be written"):
        plot.save_layout(drive, tmp_path / "nowhere" / "layout.png")


def test_ends_of_a_belt_are_drawn_where_its_path_ends(drive: Drive, ax: Axes) -> None:
    """A square at the fixed end, and both names beyond the ends, along the spans."""
    ends = (
        {"name": "anchor", "kind": "fixed", "point": (0.1, -0.4)},
        {"name": "pull", "kind": "pulled", "direction": (0.0, -1.0), "tension": 20.0},
    )
    drum = {"name": "drum", "center": (0.0, 0.0), "radius": 0.1, "inertia": 1.0}
    open_drive = drive.replace(pulley=[drum], end=ends)
    path = open_drive.path
    plot.layout(open_drive, ax=ax)
    lines = belt_lines(ax)
    assert len(lines) == 3
    np.testing.assert_allclose(lines[1:], path.span_points, atol=1e-12)
    (square,) = (line for line in ax.lines if line.get_marker() == "s")
    assert path.ends is not None
    np.testing.assert_allclose(np.array(square.get_xydata()), path.ends[:1])
    places = {text.get_text(): text for text in ax.texts if isinstance(text, Annotation)}
    for name, point in zip(("anchor", "pull"), path.ends, strict=True):
        np.testing.assert_allclose(places[name].xy, point)
        assert places[name].get_position()[1] < 0.0
    low, high = ax.get_ylim()
    assert low < path.ends[:, 1].min() < high


def test_stops_of_a_tensioner_are_drawn_where_its_pulley_stands(idler_drive: Drive, ax: Axes) -> None:
    stops = {"stops": (-0.2, 0.1), "stop_stiffness": 100.0}
    stopped = idler_drive.replace(tensioner=[idler_drive.tensioners[0].replace(**stops)])
    plot.layout(stopped, ax=ax)
    (carrier,) = prepare(stopped).carriers
    rims = {str(patch.get_label()): patch for patch in ax.patches if "stop" in str(patch.get_label())}
    for name, position in (("lower stop", -0.2), ("upper stop", 0.1)):
        rim = rims[name]
        assert isinstance(rim, Circle)
        np.testing.assert_allclose(rim.center, carrier.place(position)[0])
        assert rim.radius == 0.03


@pytest.mark.slow
def test_a_long_drive_is_drawn_wide(drive: Drive) -> None:
    first, last = drive.pulleys
    far = drive.replace(pulley=[first, last.replace(center=(8.0, 0.0))], belt=drive.belt.replace(length=16.8))
    page = plot.layout(far).figure.figure
    assert page.get_figwidth() > 12.0
    assert page.get_figheight() < 4.0


def test_numbers_below_a_narrow_drive_do_not_meet(drive: Drive) -> None:
    first, last = drive.pulleys
    upright = [first.replace(center=(0.0, 0.0)), last.replace(center=(0.0, 0.382882))]
    ax = plot.layout(drive.replace(pulley=upright))
    ax.figure.canvas.figure.draw_without_rendering()
    low, high = ax.get_xlim()
    boxes = [tick.label1.get_window_extent() for tick in ax.xaxis.get_major_ticks() if low <= tick.get_loc() <= high]
    assert len(boxes) > 1
    assert all(one.x1 < other.x0 for one, other in itertools.pairwise(boxes))


@pytest.mark.slow
def test_the_tension_is_that_of_equilibrium(drive: Drive, ax: Axes) -> None:
    """Of what is asked for, and of what a length gives; by hand where there is no equilibrium."""
    tight = drive.replace(belt=drive.belt.replace(installed_tension=40.0))
    found = bring_to_rest(tight).drive
    for one in (tight, found):
        assert plot.layout(one, ax=ax).get_title(loc="left").endswith(" m, 40 N at rest")
    soft = drive.replace(contact=drive.contact.replace(stiffness=10.0))
    with pytest.raises(ConvergenceError):
        bring_to_rest(soft)
    assert plot.layout(soft, ax=ax) is ax


def test_names_of_a_web_line_stand_beyond_the_web(ax: Axes) -> None:
    """No span runs there, whichever face of the web a roller touches."""
    drive = load(TASKS / "coater.toml")
    plot.layout(drive, install(drive), ax)
    path = install(drive).path
    ways = path.span_directions
    names = [text for text in ax.texts if text.get_text().endswith("°")]
    for number, text in enumerate(names):
        middle = ax.transData.inverted().transform(text.get_window_extent())[:, 1].mean()
        assert np.sign(middle - path.centers[number, 1]) == np.sign(ways[number - 1, 1] - ways[number, 1])
    assert len(names) == path.count


def test_a_span_without_room_has_no_length_written_on_it(ax: Axes) -> None:
    drive = load(TASKS / "handrail.toml")
    plot.layout(drive, install(drive), ax)
    assert [text.get_text() for text in ax.texts if text.get_text().endswith(" m")] == ["6.972 m", "10 m", "4.118 m"]
