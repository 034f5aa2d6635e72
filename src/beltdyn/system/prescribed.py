"""The motion of shafts whose speed is prescribed."""

from beltdyn.kernel import kernel
from beltdyn.machines.profiles.functions import prescribed_motion
from beltdyn.system.arrays import Motion, System


@kernel
def prescribe(system: System, motion: Motion) -> None:
    """Overwrite the motion of the prescribed bodies by what is prescribed at its time."""
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown < 0:
            i = system.first_body + body
            motion.position[i], motion.velocity[i], motion.acceleration[i] = prescribed_motion(
                system.profiles, p, motion.time
            )
