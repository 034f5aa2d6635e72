"""`python -m validation.paper`, the command behind `make paper`."""

import argparse
import sys
from pathlib import Path

from beltdyn.cli.console import show, show_error
from beltdyn.cli.progress import runs_bar
from beltdyn.errors import BeltdynError, SimulationError
from beltdyn.signals import ending_in_order, exit_code
from validation.paper import build_paper


def main(arguments: list[str] | None = None) -> int:
    """Run the paper's cases on all cores and write one page that compares them with its statements."""
    parser = argparse.ArgumentParser(prog="python -m validation.paper", description=main.__doc__)
    parser.add_argument("--out", type=Path, default=Path("beltdyn-paper"), help="folder for paper.html and its runs")
    folder = parser.parse_args(arguments).out
    try:
        with ending_in_order(), runs_bar(at_end="writing the page") as report:
            outcome = build_paper(folder, report)
    except BeltdynError as error:
        show_error(str(error))
        return error.exit_code
    except KeyboardInterrupt:
        show_error("interrupted")
        return exit_code()
    for name, reason in outcome.failures.items():
        show_error(f"the run {name} failed: {reason}")
    show(f"Page: {outcome.page}")
    return SimulationError.exit_code if outcome.failures else 0


if __name__ == "__main__":
    sys.exit(main())
