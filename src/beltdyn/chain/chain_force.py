"""Strain energy, elastic force and exact tangent of three links with the springs at their ends.

Points p0 to p2 belong to one block of coordinates, p3 to p5 to the next.  A piece of chain is made of the links p0-p1,
p1-p2, p2-p3 and of the springs at p1, p2 and p3, so that pieces put together make the whole chain.
"""

from beltdyn.arrays import FloatArray
from beltdyn.chain.torsional_spring import add_spring, spring_energy
from beltdyn.chain.truss import add_truss, truss_energy
from beltdyn.kernel import kernel

LINKS = 3
"""Links of a piece of chain."""


@kernel
def chain_energy(e: FloatArray, axial: float, bending: float, length: float) -> float:
    """Strain energy of a piece of chain.

    Parameters
    ----------
    e : ndarray, shape (12,)
        Places of p0 to p5, m.
    axial
        E A alpha1, N.
    bending
        E I alpha2, N m^2; zero for a truss.
    length
        Reference length of the piece, m.

    Returns
    -------
    float
        J.
    """
    link, total = length / LINKS, 0.0
    for k in range(LINKS):
        total += truss_energy(e, 2 * k, axial, link) + spring_energy(e, 2 * k, bending / link)
    return total


@kernel
def chain_force(
    e: FloatArray, axial: float, bending: float, length: float, gradient: FloatArray, tangent: FloatArray
) -> None:
    """Gradient of `chain_energy` (the elastic force with the opposite sign) and its exact tangent.

    Parameters
    ----------
    e, axial, bending, length
        As for `chain_energy`.
    gradient : ndarray, shape (12,)
        Overwritten by dU/de, N.
    tangent : ndarray, shape (12, 12)
        Overwritten by d2U/de2, N/m.
    """
    gradient[:] = 0.0
    tangent[:] = 0.0
    link = length / LINKS
    for k in range(LINKS):
        add_truss(e, 2 * k, axial, link, gradient, tangent)
        if bending > 0.0:
            add_spring(e, 2 * k, bending / link, gradient, tangent)
