#: if standalone
"""How robots that cannot move sideways keep to a line, or to a spot."""

import math

from .pose import Pose

#: endif


def steer(speed: float, offset: Pose, to_go: float) -> float:
    """The turn rate in rad/s that leads a moving robot back on its line.

    `offset` is the robot's pose seen from the line, `to_go` what is left of it. The robot
    aims at the line under an angle that grows with its distance, up to half a radian, and
    that fades out at the end of the line, where only the heading counts. At constant
    speed this is a critically damped system in the distance driven.
    """
    reach = max(0.15, 0.4 * abs(speed))
    fade = min(1.0, abs(to_go) / (2.0 * reach))
    aim = max(-0.5, min(0.5, -offset.y / (2.0 * reach))) * fade
    return 2.0 / reach * (speed * aim - abs(speed) * offset.theta)


def speed_back(offset: Pose) -> float:
    """The speed in m/s that leads a turning robot back on its spot.

    `offset` is the robot's pose seen from the spot. Wheels that slip drive the robot away
    from it; on the way around, every direction is ahead or behind for a while.
    """
    ahead = offset.x * math.cos(offset.theta) + offset.y * math.sin(offset.theta)
    return max(-0.02, min(0.02, -2.0 * ahead))
