"""Estimate of the belt at rest without friction: stretch and penetration."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.path import Path
from beltdyn.theory.static_tension import stretch_with_penetration


@dataclass(frozen=True)
class StaticEstimate:
    """A belt at rest, without bending stiffness and weight."""

    path: Path
    """Its path, without penetration."""
    length: float
    """Unstretched length, m."""
    stiffness: float
    """Of contact, N/m^2."""
    tension: float
    """N; zero for a slack belt."""
    penetrations: FloatArray
    """Penetration into each pulley, m, shape (n,)."""


def static_estimate(path: Path, belt: Belt, contact: Contact) -> StaticEstimate:
    """Estimate tension and penetration of a belt at rest on its pulleys.

    At the stretch g the tension T is that of the law of stretch. On a pulley of radius R it presses with T g / R per
    unstretched meter, so the belt sinks by d = T g / (R k_p), which shortens the path by the wrap angle times d. Of the
    length and the tension of the belt, and of the stiffness of contact and the largest d, one is given and the other
    found.
    """
    radii, law = np.abs(path.radii), belt.stretch_parameters

    def penetrations(load: float) -> FloatArray:
        if contact.stiffness is None:
            return np.asarray(contact.allowed_penetration * radii.min() / radii)
        return np.asarray(load / (radii * contact.stiffness))

    if belt.installed_tension is not None:
        tension = belt.installed_tension
        stretch = float(law.stretch(tension))
        depths = penetrations(tension * stretch)
        length = (path.length - float(path.wrap_angles @ depths)) / stretch
    else:
        length = belt.given_length
        stretch = _stretch(path, belt, contact, penetrations(0.0))
        tension = max(float(law.tension(stretch)), 0.0)
        depths = penetrations(tension * stretch)
    stiffness = contact.stiffness
    if stiffness is None:
        stiffness = tension * stretch / (float(radii.min()) * float(depths.max()))
    return StaticEstimate(path, length, stiffness, tension, depths)


def _stretch(path: Path, belt: Belt, contact: Contact, depths: FloatArray) -> float:
    """Stretch of a belt of given length that sinks in as deep as allowed, or as the stiffness of contact lets it."""
    length = belt.given_length
    if contact.stiffness is None:
        return (path.length - float(path.wrap_angles @ depths)) / length
    if path.length <= length:
        return path.length / length
    sinking = float(np.sum(path.wrap_angles / np.abs(path.radii))) / contact.stiffness
    return stretch_with_penetration(length, path.length, belt.stretch_parameters, sinking)
