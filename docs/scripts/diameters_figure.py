"""Draw docs/_static/diameters.png: by which diameters pulleys are sold, and where the tension of their belts runs."""

from math import pi, tan
from pathlib import Path

from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.show.plot.style import new_figure, styled

PICTURE = Path(__file__).parents[1] / "_static" / "diameters.png"
Points = list[tuple[float, float]]

METAL = {"facecolor": "0.8", "edgecolor": "0.35", "linewidth": 1.0}
RUBBER = {"facecolor": "tab:blue", "edgecolor": "tab:blue", "alpha": 0.35}


def v_belt(axes: Axes, entry: bd.model.Entry) -> None:
    """Draw a V-belt in its groove, mm above the datum diameter."""
    half, top, slope = 500 * entry.width, 1e3 * entry.back_offset, tan(0.5 * (entry.wedge_angle or pi))
    bottom = top - 1e3 * entry.thickness
    floor, land = bottom - 3, half + 9
    flanks = [(half + slope * y, y) for y in (top, floor)]
    mirrored = [(-x, y) for x, y in reversed(flanks)]
    depth = floor - 7
    axes.fill(
        *zip(*[(land, top), *flanks, *mirrored, (-land, top), (-land, depth), (land, depth)], strict=True), **METAL
    )
    belt = [(half + slope * y, y) for y in (top, bottom)]
    axes.fill(*zip(*[*belt, *((-x, y) for x, y in reversed(belt))], strict=True), **RUBBER)
    label(axes, entry, land, "datum diameter $d_d$")


def v_ribbed(axes: Axes, entry: bd.model.Entry, ribs: int = 4) -> None:
    """Draw a V-ribbed belt in its grooves, mm above the effective diameter."""
    pitch, slope = 1e3 * entry.width, tan(0.5 * (entry.wedge_angle or pi))
    back = 1e3 * (entry.pitch_offset + entry.back_offset)
    tip = back - 1e3 * entry.thickness
    half, left = 0.42 * pitch, -0.5 * ribs * pitch
    edge = [
        point
        for number in range(ribs)
        for middle in [left + (number + 0.5) * pitch]
        for point in (
            *((middle - half, 0.0), (middle - half - slope * tip, tip)),
            *((middle + half + slope * tip, tip), (middle + half, 0.0)),
        )
    ]
    land, depth = -left + 0.6 * pitch, tip - 2.5
    grooves: Points = [(x, y if y == 0 else y - 0.4) for x, y in edge]
    axes.fill(*zip(*[(-land, 0), *grooves, (land, 0), (land, depth), (-land, depth)], strict=True), **METAL)
    axes.fill(*zip(*[(left, back), (left, 0.3), *edge, (-left, 0.3), (-left, back)], strict=True), **RUBBER)
    label(axes, entry, land, "effective diameter $d_e$")


def flat(axes: Axes, entry: bd.model.Entry) -> None:
    """Draw a flat belt on its rim, mm above the outside diameter."""
    half, land = 500 * entry.width, 500 * entry.width + 2
    axes.fill([-land, land, land, -land], [0, 0, -3, -3], **METAL)
    axes.fill([-half, half, half, -half], [0, 0, *2 * [1e3 * entry.thickness]], **RUBBER)
    label(axes, entry, land, "outside diameter")


def label(axes: Axes, entry: bd.model.Entry, land: float, diameter: str) -> None:
    """Draw the lines that count, and how far they are apart."""
    line, back = 1e3 * entry.pitch_offset, 1e3 * (entry.pitch_offset + entry.back_offset)
    reach = 2.3 * land
    axes.plot([-land, reach], [0, 0], color="black", linewidth=1.2)
    axes.plot([-land, reach], [line, line], color="tab:red", linestyle="--", linewidth=1.2)
    axes.plot([1.05 * land, 1.2 * land], [back, back], color="0.5", linewidth=0.8)
    axes.annotate(f"{diameter}\n= diameter\n= 2 radius", (1.1 * land, 0), (0, -4), textcoords="offset points", va="top")
    axes.annotate(
        "tension line", (0, line), (0, 2), textcoords="offset points", ha="center", color="tab:red", fontsize=8
    )
    for lower, upper, name in ((0.0, line, "pitch_offset"), (line, back, "back_offset")):
        if upper > lower:
            ends = (1.13 * land, upper), (1.13 * land, lower)
            axes.annotate("", *ends, arrowprops={"arrowstyle": "<->", "color": "0.3", "shrinkA": 0, "shrinkB": 0})
            axes.text(1.18 * land, (lower + upper) / 2, f"{name} {upper - lower:.3g} mm", va="center", fontsize=8)
    axes.set_aspect("equal")
    axes.set_axis_off()


@styled
def draw(path: Path) -> None:
    """Draw the three sorts of pulleys side by side.

    Parameters
    ----------
    path
        The PNG to write.
    """
    figure = new_figure((12.0, 3.4))
    entries = bd.read_catalogue()
    sorts = (("SPB", v_belt, "V-belt"), ("PK", v_ribbed, "V-ribbed belt"), ("flat-polyamide", flat, "flat belt"))
    for axes, (name, sort, title) in zip(figure.subplots(1, 3), sorts, strict=True):
        sort(axes, entries[name])
        axes.set_title(f"{title} {name}" if name.isupper() else title)
    figure.savefig(path, dpi=130, bbox_inches="tight")


if __name__ == "__main__":
    draw(PICTURE)
