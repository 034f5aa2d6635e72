"""The motion of shafts whose speed is prescribed."""

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.profiles.functions import prescribed_motion
from beltdyn.system.arrays import System


@kernel
def prescribe(
    system: System, time: float, position: FloatArray, velocity: FloatArray, acceleration: FloatArray
) -> None:
    """Write the motion of the prescribed shafts into a state.

    Parameters
    ----------
    system
        The system.
    time
        s.
    position, velocity, acceleration : ndarray, shape (6 N + D,)
        The entries of prescribed bodies are overwritten.
    """
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown < 0:
            i = system.first_body + body
            position[i], velocity[i], acceleration[i] = prescribed_motion(system.profiles, p, time)
