"""Rules that the pulleys of a drive must obey together, so that a belt can run around them."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley

_LEAST_WRAP = 1e-6  # rad
_ROUNDING = 1e-6  # rad


def lay_path(pulleys: Sequence[Pulley]) -> Path:
    """Lay a path around pulleys listed counter-clockwise, and check that it is one.

    Parameters
    ----------
    pulleys : sequence of Pulley
        In the order in which the belt meets them.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If there are fewer than two pulleys, names are used twice, pulleys overlap, the order is not
        counter-clockwise, or the belt misses a pulley or would run through one.
    """
    if len(pulleys) < 2:
        raise ValueError(f"the drive has {len(pulleys)} pulley: a belt drive needs two or more. Add a [[pulley]]")
    _check_names(pulleys)
    _check_distances(pulleys)
    path = _path(pulleys)
    _check_turning(pulleys, path)
    _check_spans(pulleys, path)
    return path


def _path(pulleys: Sequence[Pulley]) -> Path:
    return Path(np.array([pulley.center for pulley in pulleys]), np.array([pulley.radius for pulley in pulleys]))


def _check_names(pulleys: Sequence[Pulley]) -> None:
    names = [pulley.name for pulley in pulleys]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f'pulley.name = "{name}" is used {names.count(name)} times: names must differ. Rename one')


def _check_distances(pulleys: Sequence[Pulley]) -> None:
    for one, other in combinations(pulleys, 2):
        distance, radii = np.hypot(*np.subtract(one.center, other.center)), one.radius + other.radius
        if not distance > radii:
            raise ValueError(
                f'pulleys "{one.name}" and "{other.name}" overlap: their centers are {distance:.5g} m apart, '
                f"and their radii add up to {radii:.5g} m. Move them apart, or make one smaller"
            )


def _check_turning(pulleys: Sequence[Pulley], path: Path) -> None:
    if abs(path.total_turning - 2 * np.pi) < _ROUNDING:
        for pulley, wrap in zip(pulleys, path.wrap_angles, strict=True):
            if wrap < _LEAST_WRAP:
                raise ValueError(_missed(pulley))
        return
    outermost = _outermost(path)
    for index, pulley in enumerate(pulleys):
        if index not in outermost:
            raise ValueError(_missed(pulley))
    order = ", ".join(f'"{pulleys[index].name}"' for index in outermost)
    raise ValueError(
        "the pulleys are not listed in the order in which the belt meets them when it runs counter-clockwise. "
        f"List them so: {order}"
    )


def _outermost(path: Path) -> list[int]:
    """Pulleys that a belt around all of them touches, counter-clockwise, from the first one listed if it is one."""
    angles = np.arange(0, 2 * np.pi, 1e-3)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    reached = np.argmax(path.centers @ directions + path.radii[:, None], axis=0)
    found = list(dict.fromkeys(reached.tolist()))
    start = found.index(0) if 0 in found else 0
    return found[start:] + found[:start]


def _missed(pulley: Pulley) -> str:
    return (
        f'pulley "{pulley.name}" is not touched by the belt: it lies inside the path around the others. '
        "Move it outwards, or remove it"
    )


def _check_spans(pulleys: Sequence[Pulley], path: Path) -> None:
    for span, (start, direction) in enumerate(zip(path.span_points[:, 0], path.span_directions, strict=True)):
        ends = (span, (span + 1) % len(pulleys))
        for index, pulley in enumerate(pulleys):
            across = np.subtract(pulley.center, start)
            along = np.clip(across @ direction, 0, path.span_lengths[span])
            if index not in ends and np.linalg.norm(across - along * direction) < pulley.radius:
                raise ValueError(
                    f'the belt between "{pulleys[ends[0]].name}" and "{pulleys[ends[1]].name}" would run through '
                    f'pulley "{pulley.name}". Move it, or list the pulleys in the order in which the belt meets them'
                )
