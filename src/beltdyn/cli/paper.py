"""`beltdyn paper`."""

from pathlib import Path

from beltdyn.cli.console import show, show_error
from beltdyn.cli.progress import runs_bar
from beltdyn.errors import SimulationError


def paper(*, out: Path = Path("beltdyn-paper")) -> int:
    """Run the paper's cases and write one page that compares them with its statements, figure by figure.

    Runs go side by side on all cores, for some minutes; then some of them are done again one at a time, for their
    computing times. Ctrl-C ends them and keeps what was computed.

    Parameters
    ----------
    out
        The folder for the page, paper.html, and the drive file of each of its runs with what the page keeps of it.
    """
    from beltdyn.paper import build_paper

    with runs_bar(at_end="timing some runs, and writing the page") as report:
        outcome = build_paper(out, report)
    for name, reason in outcome.failures.items():
        show_error(f"the run {name} failed: {reason}")
    show(f"Page: {outcome.page}")
    return SimulationError.exit_code if outcome.failures else 0
