"""The summary of a run on the screen."""

import math
from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_facts, show_table, show_warnings

if TYPE_CHECKING:
    from beltdyn.results import Resolution, Run, Summary


def show_summary(run: "Run") -> None:
    """Write what a user wants to know of a run first."""
    from beltdyn.results import summarize

    if run.outputs == 0:
        show("Nothing was computed before the run ended.")
        return
    summary = summarize(run)
    over = f" (means from {summary.start:.4g} to {summary.end:.4g} s)" if summary.end > summary.start else ""
    show_table(
        f"\nPulleys{over}",
        ("", "speed", "torque from belt", "slip", "wrap angle", "hub load"),
        [
            (
                pulley.name,
                f"{pulley.speed:.4f} rad/s",
                f"{pulley.belt_torque:.4g} N m",
                "" if math.isnan(pulley.slip) else f"{pulley.slip:.3%}",
                f"{math.degrees(pulley.wrap_angle):.1f}°",
                f"{pulley.hub_load:.4g} N",
            )
            for pulley in summary.pulleys
        ],
    )
    show_table(
        f"\nSpans{over}",
        ("", "tension", "belt speed"),
        [(span.name, f"{span.tension:.4g} N", f"{span.belt_speed:.4g} m/s") for span in summary.spans],
    )
    show()
    show_facts(_facts(summary))
    show_warnings(summary.warnings)


def _facts(summary: "Summary") -> list[tuple[str, str]]:
    """What the solver did; of a static equilibrium, which takes no steps, nothing but the time."""
    facts = [
        ("mesh", _mesh(summary.resolution)),
        ("energy closure", f"within {abs(summary.energy_closure):.1e} of the energy put in"),
        ("outputs", f"{summary.outputs}"),
        ("steps", f"{summary.steps}, {summary.rejected_steps} rejected, {summary.newton_iterations} Newton iterations"),
        ("real-time factor", f"{summary.real_time_factor:.3g} s of computing for each simulated second"),
    ]
    took = f"{summary.wall_time:.3g} s, and {summary.compile_time:.3g} s to prepare kernels"
    known = not math.isnan(summary.wall_time)
    return [*(facts if summary.steps else []), *([("time taken", took)] if known else [])]


def _mesh(resolution: "Resolution") -> str:
    """The estimated errors of the mesh; without contact there are none of forces."""
    known = [error for error in resolution.force_errors if math.isfinite(error)]
    forces = f"contact forces ripple by {max(known):.1%} of their mean, " if known else ""
    return f"{forces}tension is up to {resolution.tension_error:.1%} too high"
