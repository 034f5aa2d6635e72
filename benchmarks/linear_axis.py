"""Computing time of one second of a printer's axis; the goal is 1 s: `python benchmarks/linear_axis.py`."""

import sys

import beltdyn as bd


def main() -> None:
    """Simulate it once to compile, and then three times; the least time counts."""
    drive = bd.example("printer_axis")
    bd.simulate(drive.with_({"simulation.duration": 0.02}))
    for rtol in (1e-3, 2e-3):
        runs = [bd.simulate(drive.with_({"simulation.rtol": rtol})).dataset.attrs for _ in range(3)]
        wall, processor = (min(float(one[name]) for one in runs) for name in ("wall_time", "cpu_time"))
        sys.stdout.write(
            f"rtol = {rtol:g}: {wall:.2f} s, {processor:.2f} s of the processor, in {runs[0]['steps']} steps\n"
        )


if __name__ == "__main__":
    main()
