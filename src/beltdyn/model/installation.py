"""The belt at rest on its pulleys: closed-form estimates, or static equilibrium."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.carrier import moved
from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.model.tensioner_balance import TensionerBalance, all_balances
from beltdyn.theory.sagging_span import lowest_frequency, sag_parameter


@dataclass(frozen=True)
class Installation:
    """The belt at rest, without friction.

    Attributes
    ----------
    strain : float
        Strain of the belt laid on its path, path / length - 1.
    laid_tension : float
        Tension of the laid belt, N.
    tension : float
        Mean tension of the spans with the penetration into the pulleys, N.
    span_tensions : ndarray, shape (s,), N
        Tension of each of s spans: the same in all, but for weight and the mesh.
    penetrations : ndarray, shape (n,), m
        Penetration into each pulley, in the middle of the arc.
    tensioner_positions : ndarray, shape (K,), m or rad
        Where springs hold the sliding and the rotary tensioners.
    path : Path
        The path with the tensioners there, without penetration.
    hub_loads : ndarray, shape (n, 2), N
        Force of the belt on each pulley; without weight T (u_out - u_in), of size 2 T sin(wrap angle / 2).
    span_frequencies : ndarray, shape (s,), Hz
        Lowest frequency at which each span swings across, with the bending stiffness of the belt and its sag.

    Examples
    --------
    >>> installed = bd.install(drive)
    >>> print(f"{installed.tension:.2f} N, {installed.span_frequencies[0]:.1f} Hz")
    26.56 N, 21.0 Hz
    """

    strain: float
    laid_tension: float
    tension: float
    span_tensions: FloatArray
    penetrations: FloatArray
    tensioner_positions: FloatArray
    path: Path
    hub_loads: FloatArray
    span_frequencies: FloatArray


def install(drive: Drive) -> Installation:
    """Estimate tension, penetration and tensioner positions for the belt at rest.

    `beltdyn.model.static_estimate` and `beltdyn.model.tensioner_balance` have the equations, which leave out bending
    stiffness and weight; `beltdyn.bring_to_rest` finds static equilibrium.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    Installation

    Examples
    --------
    >>> round(bd.install(drive).tension, 1)  # N
    26.6
    """
    estimate, positions = drive.balance
    path = estimate.path
    turned = path.span_directions[: path.count] - np.roll(path.span_directions, 1, axis=0)[: path.count]
    tensions = np.full(path.spans, estimate.tension)
    return describe(drive, tensions, estimate.penetrations.copy(), estimate.tension * turned, positions.copy())


def describe(
    drive: Drive, span_tensions: FloatArray, penetrations: FloatArray, hub_loads: FloatArray, positions: FloatArray
) -> Installation:
    """Describe a belt at rest."""
    path = moved(drive.path, drive.carriers, positions)
    laid = path.length / drive.belt_length
    return Installation(
        strain=laid - 1,
        laid_tension=float(drive.belt.stretch_parameters.tension(laid)),
        tension=float(span_tensions.mean()),
        span_tensions=span_tensions,
        penetrations=penetrations,
        tensioner_positions=positions,
        path=path,
        hub_loads=hub_loads,
        span_frequencies=_span_frequencies(drive, path, span_tensions),
    )


def tensioner_balances(drive: Drive, installation: Installation) -> tuple[tuple[TensionerBalance, ...], ...]:
    """Find all equilibrium positions of each spring-loaded tensioner, with the others held.

    Parameters
    ----------
    drive : Drive
    installation : Installation
        The belt at rest.

    Returns
    -------
    tuple of tuples of TensionerBalance
        For each tensioner, in ascending order of the positions; without bending stiffness and weight.

    Examples
    --------
    >>> bd.tensioner_balances(drive, bd.install(drive))  # it has no tensioners
    ()
    """
    belt, contact = drive.loaded_belt, drive.completed.contact
    return all_balances(drive.path, belt, contact, drive.carriers, installation.tensioner_positions)


def _span_frequencies(drive: Drive, path: Path, tensions: FloatArray) -> FloatArray:
    """First frequencies of spans, Hz; see `theory.sagging_span`.

    The mass of a metre is that of the stretched belt. A slack belt does not swing: zero.
    """
    if not tensions.min() > 0.0:
        return np.zeros(path.spans)
    belt, mass = drive.belt, drive.belt.mass_per_length * drive.belt_length / path.length
    across = np.abs(path.span_directions @ np.array([-drive.gravity[1], drive.gravity[0]]))
    found = [
        lowest_frequency(
            length,
            tension,
            mass,
            bending=belt.bending_stiffness,
            sag_parameter=sag_parameter(mass * gravity, length, tension, belt.local_stiffness(tension)),
        )
        for length, gravity, tension in zip(path.span_lengths.tolist(), across.tolist(), tensions.tolist(), strict=True)
    ]
    return np.array(found)
