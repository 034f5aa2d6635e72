import numpy as np

import beltdyn as bd
from beltdyn.arrays import row
from beltdyn.contact.surface import KINDS
from beltdyn.contact.surface.kind import circle_gap
from beltdyn.contact.surface.lobed import lobed_gap

radius, step = 0.08, 1e-6
shape = KINDS["lobed"].constants
rim = row(shape, lobe_height=2e-4, lobes=10.0)
for angle in (0.0, 0.1, 0.25, 2.0, -3.0):
    place = 0.0795 * np.array([np.cos(angle), np.sin(angle)])
    gap = lobed_gap(rim, *place, radius)
    normal = np.array([gap.normal_x, gap.normal_y])
    tangent = np.array([-normal[1], normal[0]])
    ahead, behind, right, left, up, down = (
        lobed_gap(rim, *(place + shift), radius)
        for axis in (tangent, np.array([1.0, 0.0]), np.array([0.0, 1.0]))
        for shift in (step * axis, -step * axis)
    )
    slope = np.array([right.penetration - left.penetration, up.penetration - down.penetration]) / (2 * step)
    assert np.allclose(slope, -normal, atol=1e-6)
    turned = np.array([ahead.normal_x - behind.normal_x, ahead.normal_y - behind.normal_y]) / (2 * step)
    assert np.allclose(turned, gap.curvature * tangent, rtol=1e-4, atol=1e-4)
    smooth = row(shape, lobe_height=1e-15, lobes=10.0)
    assert np.allclose(lobed_gap(smooth, *place, radius), circle_gap(smooth, *place, radius), atol=1e-10)

drive = bd.example("two_pulley")
surface = {"kind": "lobed", "lobe_height": "1 mm", "lobes": 6}
pulleys = [drive.pulleys[0].replace(surface=surface), drive.pulleys[1]]
run = bd.simulate(drive.replace(pulley=pulleys))
data = run.dataset
assert abs(float(data["energy_closure"][-1])) < 1e-3 * float(data["driver_work"][-1])
steady = data.sel(time=slice(0.651, None))  # 12 rad/s
time, tension = steady["time"].values, steady["span_tension"].values[:, 0]
time = time - time[0]
ripple = tension - np.polyval(np.polyfit(time, tension, 3), time)
spectrum = np.abs(np.fft.rfft(ripple * np.hanning(time.size), 8192))
frequency = np.fft.rfftfreq(8192, time[1] - time[0])
assert abs(frequency[np.argmax(spectrum)] - 6 * 12.0 / (2 * np.pi)) < 1.0  # Hz; a window of 0.35 s
