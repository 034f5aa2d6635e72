"""What contact along the belt amounts to for every pulley and span."""

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.results.mechanics import cells, gross_sliding, pressing, sliding_shares, sliding_velocity
from beltdyn.results.mid_span import mid_span_displacements


def contact_scalars(
    drive: Drive,
    belt_coordinate: FloatArray,
    touched: IntArray,
    normal: FloatArray,
    slip_velocity: FloatArray,
    places: FloatArray,
    centers: FloatArray,
) -> dict[str, FloatArray]:
    """Sum up contact along the belt.

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
    places : ndarray, shape (k, points, 2)
        m.
    centers : ndarray, shape (k, pulleys, 2)
        Where the pulleys are, m.

    Returns
    -------
    dict
        ``sliding_speed`` (m/s, see `mechanics.gross_sliding`) and ``sliding_share``, shape (k, pulleys);
        ``mid_span_displacement`` (m), shape (k, spans).
    """
    sliding = sliding_velocity(slip_velocity, normal, touched, drive)
    pressed = pressing(normal, touched, len(drive.pulleys))
    return {
        "sliding_speed": gross_sliding(sliding, pressed, drive),
        "sliding_share": sliding_shares(sliding, pressed, cells(belt_coordinate, drive.belt.length)),
        "mid_span_displacement": mid_span_displacements(drive, centers, places, touched),
    }
