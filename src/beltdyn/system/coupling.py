"""What a link of a hub chain transmits: torsional isolator, one-way clutch, friction clutch."""

from beltdyn.kernel import kernel
from beltdyn.records import Records
from beltdyn.system.excitation import profile_value
from beltdyn.system.machine_arrays import ISOLATOR, ONE_WAY_CLUTCH, Profiles


@kernel
def coupling_torque(
    profiles: Profiles, couplings: Records, number: int, time: float, twist: float, rate: float
) -> tuple[float, float, float, float, float]:
    """Torque from the front body of a coupling on the back one, and as much against the front one.

    Constants of the kinds: stiffness and damping of an `isolator`; locking damping, drag torque and sense of a
    `one_way_clutch`; locking damping and capacity of a `friction_clutch`, whose capacity a schedule multiplies.

    Parameters
    ----------
    profiles, couplings
        Functions of time, and couplings.
    number
        Which coupling.
    time
        s.
    twist, rate
        Angle of the front body less that of the back one, and its rate, rad and rad/s.

    Returns
    -------
    torque, by_twist, by_rate, energy, loss : float
        Torque, N m, counter-clockwise on the back body, and its derivatives; energy stored, J; power lost, W.
    """
    link = couplings[number]
    first, second, third = link.constants
    if link.kind == ISOLATOR:
        return isolator(twist, rate, first, second)
    if link.kind == ONE_WAY_CLUTCH:
        torque, slope = one_way_clutch(rate, first, second, third)
    else:
        scale = profile_value(profiles, link.schedule, time)[0] if link.schedule >= 0 else 1.0
        torque, slope = friction_clutch(rate, first, scale * second)
    return torque, 0.0, slope, 0.0, torque * rate


@kernel
def isolator(twist: float, rate: float, stiffness: float, damping: float) -> tuple[float, float, float, float, float]:
    """Linear spring and damper in parallel: k twist + c rate.

    Parameters
    ----------
    twist, rate
        rad, rad/s.
    stiffness, damping
        k, N m/rad, and c, N m s/rad.

    Returns
    -------
    torque, by_twist, by_rate, energy, loss : float
        As for `coupling_torque`.
    """
    spring, damper = stiffness * twist, damping * rate
    return spring + damper, stiffness, damping, 0.5 * spring * twist, damper * rate


@kernel
def one_way_clutch(rate: float, locking_damping: float, drag_torque: float, sense: float) -> tuple[float, float]:
    """Torque of an overrunning clutch: sense max(c x, -drag), x = sense rate.

    The front body drives the back one where it is faster in the sense of driving, x > 0, with a torque c x that lets
    it creep, as the friction of the belt does (Eq. 20); where it is slower the clutch overruns and only drags.
    Zhu and Parker (J. Sound Vib. 279, 2005) put a stiff spring in the place of c x.

    Parameters
    ----------
    rate
        Speed of the front body less that of the back one, rad/s.
    locking_damping
        c, N m s/rad.
    drag_torque
        Largest torque while it overruns, N m.
    sense
        +1 if the front body drives counter-clockwise, -1 if clockwise.

    Returns
    -------
    torque, slope : float
        N m, N m s/rad.
    """
    torque = locking_damping * sense * rate
    if torque < -drag_torque:
        return -sense * drag_torque, 0.0
    return sense * torque, locking_damping


@kernel
def friction_clutch(rate: float, locking_damping: float, capacity: float) -> tuple[float, float]:
    """Torque of a clutch that slips at its capacity: c rate between -capacity and +capacity.

    Parameters
    ----------
    rate
        Speed of the front body less that of the back one, rad/s.
    locking_damping
        c, N m s/rad.
    capacity
        Largest torque, N m.

    Returns
    -------
    torque, slope : float
        N m, N m s/rad.
    """
    torque = locking_damping * rate
    if torque > capacity:
        return capacity, 0.0
    if torque < -capacity:
        return -capacity, 0.0
    return torque, locking_damping
