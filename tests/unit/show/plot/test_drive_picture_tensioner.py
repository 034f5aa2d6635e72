"""Spring-loaded tensioners in pictures of a drive."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from beltdyn.model import Drive, prepare
from beltdyn.show.plot.drive_picture import TensionerPicture

IDLER = {"name": "idler", "center": (0.0, -0.09), "radius": 0.03, "side": "outside", "inertia": 0.01, "mass": 0.1}
STOPS = {"stop_stiffness": 100.0}


def with_tensioner(drive: Drive, length: float, **tensioner: object) -> Drive:
    """The paper's drive with an idler on the back of its lower span, which a spring presses upwards."""
    first, last = drive.pulleys
    spring = {"pulley": "idler", "preload": 3.0, "rate": 100.0} | tensioner
    return drive.replace(pulley=[first, IDLER, last], tensioner=[spring], belt=drive.belt.replace(length=length))


def test_an_arm_follows_its_pulley_between_stops(drive: Drive, ax: Axes) -> None:
    arm = {"kind": "rotary", "pivot": (-0.1, -0.15), "inertia": 0.01, "rate": 1.0, "stops": (-0.2, 0.1)}
    sprung = with_tensioner(drive, 1.278, **arm, **STOPS)
    (carrier,) = prepare(sprung).carriers
    picture = TensionerPicture(ax, sprung, carrier)
    way, line, pivot = ax.lines
    centers = np.array([[0.0, 0.0], [0.01, -0.08], [0.3, 0.0]])
    picture.show(centers)
    np.testing.assert_allclose(np.asarray(line.get_xydata()), [(-0.1, -0.15), (0.01, -0.08)])
    np.testing.assert_allclose(np.asarray(pivot.get_xydata()), [(-0.1, -0.15)])
    lower, upper = (patch for patch in ax.patches if isinstance(patch, Circle))
    np.testing.assert_allclose([lower.center, upper.center], np.asarray(way.get_xydata())[[0, -1]])
    np.testing.assert_allclose(lower.center, carrier.place(-0.2)[0])


def test_a_sliding_one_without_stops_has_its_line(drive: Drive, ax: Axes) -> None:
    sprung = with_tensioner(drive, 1.29, kind="sliding", direction=(0.0, 1.0), mass=0.1)
    picture = TensionerPicture(ax, sprung, prepare(sprung).carriers[0])
    picture.show(sprung.centers)
    (line,) = ax.lines
    np.testing.assert_allclose(np.asarray(line.get_xydata()), [(0.0, -0.12), (0.0, -0.06)], atol=1e-12)
