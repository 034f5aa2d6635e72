"""Web lines drawn at random, with driven, idle and held rollers, against a chain of capstans."""

import re
from collections.abc import Callable, Sequence

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from tests.lumped.seeds import blocks
from tests.lumped.web_chain import WEB, Roller, chain, controlled_line, drawn_line, refused_line


@blocks(range(3), 1000, 50)
def test_every_line_runs_with_the_tensions_of_the_chain(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    """The chain has no creep below full friction: by the creep ratio tensions differ by 2 N; one of 1000 is refused."""
    errors, refused = dict[int, float](), list[int]()
    for seed in seeds:
        drawn = drawn_line(seed)
        try:
            run = bd.steady_state(drawn.drive)
        except ConvergenceError:
            refused.append(seed)
            continue
        expected, found = np.array(drawn.chain.tensions), run.dataset.span_tension.values[-1]
        found = np.append(found[-1], found[: expected.size - 1])
        errors[seed] = float(np.max(np.abs(found - expected)) / np.max(expected))
    worst = max(errors, key=lambda seed: errors[seed])
    measured(
        lines=len(seeds), refused=len(refused), median=float(np.median(list(errors.values()))), worst=errors[worst]
    )
    assert len(refused) <= len(seeds) // 1000, refused
    assert errors[worst] < 0.02, worst


@blocks(range(1), 300, 20)
def test_every_controlled_line_holds_its_set_value(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    """By a load cell or a dancer, from any first guess of the roller that it trims; one of 1000 is refused."""
    errors, refused = dict[int, float](), dict[int, str]()
    for seed in seeds:
        drawn = controlled_line(seed)
        try:
            run = bd.steady_state(drawn.drive)
        except ConvergenceError as error:
            refused[seed] = str(error)
            continue
        errors[seed] = float(np.max(np.abs(run.dataset.span_tension.values[-1] / drawn.tensions - 1.0)))
    worst = max(errors, key=lambda seed: errors[seed])
    measured(
        lines=len(seeds), refused=len(refused), median=float(np.median(list(errors.values()))), worst=errors[worst]
    )
    assert len(refused) <= len(seeds) // 1000, refused
    assert errors[worst] < 0.01, worst


@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 200), marks=pytest.mark.slow)], ids=len)
def test_lines_that_cannot_run_are_refused_for_the_reason_of_the_chain(seeds: range) -> None:
    """All driven rollers slide: they are named with the ratios of tension that they hold, and that required, to 2 %."""
    for seed in seeds:
        drawn = refused_line(seed)
        with pytest.raises(ConvergenceError) as refusal:
            bd.steady_state(drawn.drive)
        names, rest = str(refusal.value).split("the web slips on ")[1].split(", whose ")
        assert re.findall(r"`([^`]*)`", names) == drawn.sliding, seed
        stated = re.search(r"allows (\S+) to (\S+) times .* where (\S+) is required", rest)
        assert stated is not None
        assert [float(number) for number in stated.groups()] == pytest.approx(
            [*drawn.allowed, drawn.required], rel=0.02
        ), seed


def line(speed: float, friction: float) -> Drive:
    """A first roller of a speed (rad/s), and a driven one with much grip."""
    return Drive(
        belt=WEB,
        unwinder={"point": [0.0, 0.3], "tension": 100.0},
        pulley=[
            {"name": "first", "center": [0.5, 0.0], "radius": 0.05, "speed": speed, "friction": friction},
            {
                "name": "driven",
                "center": [1.0, 0.3],
                "radius": 0.05,
                "side": "outside",
                "speed": -40.0,
                "friction": 1.0,
            },
        ],
        winder={"point": [1.5, 0.0], "tension": 110.0},
        simulation={"duration": 1.0},
    )


@pytest.mark.parametrize("speed", [39.2, 0.0])
def test_a_web_runs_at_the_speed_of_the_roller_that_grips(speed: float) -> None:
    """The first roller slides, slow or held; the web could also slip through at 33 m/s, lifted by its inertia."""
    drive = line(speed, 0.1)
    wraps = drive.path.wrap_angles
    expected = chain([Roller(0.05 * speed, 0.1 * float(wraps[0])), Roller(2.0, float(wraps[1]))], 100.0, 110.0)
    assert expected is not None
    run = bd.steady_state(drive)
    assert run.dataset.attrs["belt_parameter"] == pytest.approx(expected.passed, rel=1e-3)
    assert run.dataset.span_tension.values[-1, 0] == pytest.approx(expected.tensions[1], rel=5e-3)
