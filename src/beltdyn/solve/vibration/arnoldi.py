"""Eigenvalues of largest magnitude of a linear map, by the Arnoldi method without restarts.

It works on one vector at a time: on the small matrices of whole bases (ARPACK) the threads of linear algebra wait for
each other longer than they compute.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray

_BATCH = 40
"""Steps after which eigenvalues are looked at."""


class Ritz(NamedTuple):
    """Eigenvalues as known after some steps, the largest first."""

    values: ComplexArray
    """Shape (steps,)."""
    residuals: FloatArray
    """Error of A v = value v for the unit vector v, over the magnitude of the value, shape (steps,)."""
    within: ComplexArray
    """Coordinates of the eigenvectors in the basis, shape (steps, steps)."""
    basis: list[ComplexArray]
    """Orthonormal vectors, one more than there are steps."""

    def vectors(self, count: int) -> ComplexArray:
        """Eigenvectors of so many of the largest values, in columns."""
        found = np.zeros((self.basis[0].size, count), complex)
        for direction, parts in zip(self.basis, self.within[:, :count], strict=False):
            found += np.multiply.outer(direction, parts)
        return found


def arnoldi(apply: Callable[[ComplexArray], ComplexArray], size: int, most: int) -> Iterator[Ritz]:
    """Find eigenvalues of a map, better after each batch of steps.

    Parameters
    ----------
    apply
        The map, from vectors of shape (size,) to such.
    size
        Of its vectors.
    most
        Batches of steps.
    """
    most = min(most, -(-size // _BATCH))
    vector = np.random.default_rng(0).standard_normal(size).astype(complex)
    basis = [vector / np.linalg.norm(vector)]
    projected = np.zeros((most * _BATCH + 1, most * _BATCH), complex)
    for steps in range(1, min(most * _BATCH, size) + 1):
        vector = apply(basis[-1])
        for _ in range(2):  # once more, since what is found already comes back by rounding
            for number, direction in enumerate(basis):
                part = np.vdot(direction, vector)
                projected[number, steps - 1] += part
                vector -= part * direction
        rest = float(np.linalg.norm(vector))
        if not np.isfinite(rest):
            return
        if steps % _BATCH == 0 or steps == size:
            values, within = np.linalg.eig(projected[:steps, :steps])
            order = np.argsort(-np.abs(values))
            values, within = values[order], within[:, order]
            with np.errstate(divide="ignore", invalid="ignore"):
                residuals = rest * np.abs(within[-1]) / np.abs(values)
            yield Ritz(values, residuals, within, basis)
        projected[steps, steps - 1] = rest
        basis.append(vector / rest if rest > 0.0 else vector)
