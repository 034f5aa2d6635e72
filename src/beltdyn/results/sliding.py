"""Sliding of the belt on every pulley."""

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.results.mechanics import cells, gross_sliding, pressing, sliding_shares, sliding_velocity


def sliding_of_pulleys(
    drive: Drive,
    belt_coordinate: FloatArray,
    touched: IntArray,
    normal: FloatArray,
    slip_velocity: FloatArray,
    pulley_speed: FloatArray,
) -> dict[str, FloatArray]:
    """Sum up sliding along the belt.

    Parameters
    ----------
    drive : Drive
        The drive.
    belt_coordinate : ndarray, shape (points,)
        Of the contact points, m.
    touched : ndarray of int, shape (k, points)
        Number of the pulley that each touches, -1 where it is free.
    normal, slip_velocity : ndarray, shape (k, points)
        N/m and m/s.
    pulley_speed : ndarray, shape (k, pulleys)
        rad/s.

    Returns
    -------
    dict
        ``sliding_speed`` (m/s, see `mechanics.gross_sliding`) and ``sliding_share``, shape (k, pulleys).
    """
    sliding = sliding_velocity(slip_velocity, normal, touched, pulley_speed, drive)
    pressed = pressing(normal, touched, len(drive.pulleys))
    return {
        "sliding_speed": gross_sliding(sliding, pressed, drive),
        "sliding_share": sliding_shares(sliding, pressed, cells(belt_coordinate, drive.belt_length)),
    }
