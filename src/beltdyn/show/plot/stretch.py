"""Tension over strain of a belt of the catalogue."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from beltdyn.model import Entry
from beltdyn.show.plot.figures import save
from beltdyn.show.plot.style import COLORS, INK, axes_or_new, dash, new_figure, styled
from beltdyn.stretch import Linear

_BEYOND = 1.1
"""Largest strain that is drawn, over the last one that was measured."""
_LARGEST = 0.01
"""Largest strain that is drawn of a belt without a curve."""


@styled
def stretch(entry: Entry, name: str = "", ax: Axes | None = None) -> Axes:
    """Draw the tension of a catalogue belt over its strain, with the measured points.

    The dashed line is the initial slope.

    Parameters
    ----------
    entry : Entry
        The profile, as `beltdyn.read_catalogue` gives it.
    name : str
        The title; by default that of the entry.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> bd.plot.stretch(bd.read_catalogue()["PK"], name="PK").get_xlabel()
    'Strain [%]'
    """
    ax, curve = axes_or_new(ax), entry.stretch_curve
    law = Linear(entry.axial_stiffness) if curve is None else curve.parameters
    strain = np.linspace(0.0, _LARGEST if curve is None else _BEYOND * curve.strains[-1], 200)
    tension = law.tension(1.0 + strain)
    ax.plot(100.0 * strain, tension, color=COLORS[0], label="in a drive")
    if curve is not None:
        points = 100.0 * np.array(curve.strains), np.array(curve.tensions)
        ax.plot(*points, color=COLORS[1], marker="o", linestyle="", label="measured")
        begins = f"{entry.axial_stiffness:.4g} N × strain"
        ax.plot(
            100.0 * strain, entry.axial_stiffness * strain, color=INK, linewidth=0.8, linestyle=dash(1), label=begins
        )
        ax.set_ylim(0.0, 1.2 * float(max(tension)))
        ax.legend(loc="lower right")
    ax.set(xlabel="Strain [%]", ylabel="Tension [N]")
    ax.set_title(name or entry.title)
    return ax


@styled
def save_stretch(entry: Entry, path: Path | str, name: str = "", *, overwrite: bool = False) -> Path:
    """Save the tension-strain diagram of a catalogue belt; see `stretch`.

    Parameters
    ----------
    entry : Entry
        The profile.
    path : Path or str
        The file: PNG, SVG, PDF or another format of matplotlib.
    name : str
        The title; by default that of the entry.
    overwrite : bool
        Replace any regular file, and not only figures of beltdyn.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If the format is unknown, the file cannot be written, or would replace one that is no figure of ours.

    Examples
    --------
    >>> belt = bd.read_catalogue()["PK"]
    >>> bd.plot.save_stretch(belt, "stretch.svg", name="PK").name
    'stretch.svg'
    """
    figure = new_figure()
    stretch(entry, name, figure.add_subplot())
    return save(figure, Path(path), overwrite)
