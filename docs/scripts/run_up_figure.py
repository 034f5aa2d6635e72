"""Draw docs/_static/verification/run_up_orders.png: linear response and a run-up of the same drive, on the same axes.

    python docs/scripts/run_up_figure.py [SWEEP.nc]

The example alternator_drive, whose crank turns with a wave of 0.2 % and order 2, from 900 to 2100 rpm in 2 s.  The
run-up takes some minutes, or is that of a file: `beltdyn sweep` with these speeds.  What a run-up at this rate shows of
a resonance is predicted by one mode: the same run-up of a rotor on a spring, whose orders are taken alike.
"""

import sys
from importlib.resources import files
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

import beltdyn as bd
from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.results.derived import orders
from beltdyn.show.plot.style import new_figure, styled

FILE = Path(__file__).parents[1] / "_static" / "verification" / "run_up_orders.png"
RPM = np.pi / 30.0
FIRST, LAST, DURATION, SETTLING, ORDER = 900.0 * RPM, 2100.0 * RPM, 2.0, 0.5, 2.0
SPAN = "alternator-crank"


def wavy() -> bd.Drive:
    """The drive with its wave."""
    text = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    return bd.loads(text.replace("speed = {", "harmonics = [{ order = 2, amplitude = 0.002 }]\nspeed = {", 1))


def one_mode(drive: bd.Drive, speed: FloatArray) -> FloatArray:
    """Amplitude of order 2 in the run-up over that in steady running, of one mode, at speeds of the crank, rad/s.

    x'' + 2 zeta w (x - u)' + w^2 (x - u) = 0 with u = exp(i 2 angle); the tension goes with x''.
    """
    mode = bd.modes(drive, count=1).dataset.isel(mode=0)
    own, damping = 2.0 * np.pi * float(mode.frequency), float(mode.damping_ratio)
    sys.stdout.write(f"mode: {own / 2.0 / np.pi:.2f} Hz, damping ratio {damping:.4f}\n")
    rate = (LAST - FIRST) / DURATION
    time = np.linspace(0.0, DURATION, int(1000 * DURATION) + 1)

    def angle(at: FloatArray | float) -> FloatArray | float:
        return FIRST * at + 0.5 * rate * at**2

    def steady(turning: FloatArray | float) -> ComplexArray:
        omega = ORDER * np.asarray(turning)
        push = own**2 + 2j * damping * own * omega
        return np.asarray(push / (push - omega**2))

    def slope(at: float, state: ComplexArray) -> list[complex]:
        wave = np.exp(1j * ORDER * angle(at))
        wave_rate = 1j * ORDER * (FIRST + rate * at) * wave
        return [
            state[1],
            own**2 * (wave - state[0]) + 2.0 * damping * own * (wave_rate - state[1]),
        ]

    begin = complex(steady(FIRST))
    start = [begin, 1j * ORDER * FIRST * begin]
    path = solve_ivp(slope, (0.0, DURATION), start, t_eval=time, rtol=1e-8, atol=1e-12, max_step=1e-3)
    pulled = np.array([slope(at, state)[1].real for at, state in zip(time, path.y.T, strict=True)])
    record, turned = (
        xr.DataArray(values, {"time": time}, "time", attrs={"units": unit, "long_name": name})
        for values, unit, name in (
            (pulled, "1", "Acceleration"),
            (angle(time), "rad", "Angle"),
        )
    )
    found = orders(record, turned)
    found = found.interp(order=ORDER)
    seen = np.interp(speed, found["speed"].values, found.values, np.nan, np.nan)
    return np.asarray(seen / np.abs((ORDER * speed) ** 2 * steady(speed)))


@styled
def draw(result: bd.Result, ratio: FloatArray) -> None:
    """Order 2 of the tension of the tight span: linear, over time, and as one mode predicts it."""
    data = result.dataset.isel(excitation=0).sel(span=SPAN)
    speed, linear = data["speed"].values / RPM, data["span_tension_amplitude"].values
    shown = data["run_up_span_tension_amplitude"].values
    figure = new_figure((7.0, 3.8))
    ax = figure.subplots()
    ax.plot(speed, linear, label="linear response")
    ax.plot(speed, shown, "o", markersize=4, label="run-up")
    ax.plot(
        speed,
        linear * ratio,
        "--",
        label="linear response, as a run-up of one mode shows it",
    )
    ax.set(
        xlabel="Speed of the crank [rpm]",
        ylabel="Order 2 of the tension [N]",
        ylim=(0.0, None),
    )
    ax.legend()
    FILE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(FILE)
    for values in zip(speed, linear, shown, shown / linear, ratio, strict=True):
        sys.stdout.write("{:6.0f} rpm {:8.2f} N {:8.2f} N {:6.3f} {:6.3f}\n".format(*values))
    off = np.abs(shown / linear / ratio - 1.0)
    sys.stdout.write(f"largest difference to one mode {np.nanmax(off):.3%}\n")


def main() -> None:
    """Run up, or read, and compare."""
    drive = wavy()
    given = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    run = given or bd.sweep(
        drive,
        pulley="crank",
        from_=FIRST,
        to=LAST,
        duration=DURATION,
        settling=SETTLING,
    )
    result = bd.response(drive, speed="900..2100 rpm", points=25, compare=run)
    draw(result, one_mode(drive, result.dataset["speed"].values))


if __name__ == "__main__":
    main()
