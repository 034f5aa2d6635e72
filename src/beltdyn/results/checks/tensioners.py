"""Where tensioners stand."""

from collections.abc import Iterator

import numpy as np

from beltdyn.results.checks.finding import Evidence, Finding


def stopped_tensioners(evidence: Evidence) -> Iterator[Finding]:
    """Tensioners that lie on a stop at the end of the run, and since when."""
    moving = [tensioner for tensioner in evidence.drive.tensioners if tensioner.kind != "fixed"]
    for number, tensioner in enumerate(moving):
        if tensioner.stops is None:
            continue
        position = np.asarray(evidence.recorded["tensioner_position"])[:, number]
        lower, upper = tensioner.stops
        for name, on in (("lower", position <= lower), ("upper", position >= upper)):
            if on[-1]:
                first = float(evidence.time[len(on) - int(np.argmin(on[::-1])) if not on.all() else 0])
                since = f" since t = {first:.4g} s" if len(on) > 1 else ""
                yield Finding(
                    f"the tensioner of {tensioner.pulley} is on its {name} stop{since}.",
                    "It no longer keeps the tension:",
                    "change the length of the belt, or the stops.",
                )
