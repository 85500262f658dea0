#: if standalone
"""Steering of robots that cannot move sideways, along a line or on a spot."""

import math

from .pose import Pose

#: endif


def steer(speed: float, offset: Pose, remaining: float) -> float:
    """The turn rate in rad/s that returns a moving robot to its line.

    `offset` is the robot's pose relative to the line, `remaining` the distance to its end.
    The robot approaches the line at an angle that grows with its distance from it, up to
    half a radian, and fades out at the end, where only the heading counts. At constant
    speed this is a critically damped system in the distance driven.
    """
    reach = max(0.15, 0.4 * abs(speed))
    fade = min(1.0, abs(remaining) / (2.0 * reach))
    aim = max(-0.5, min(0.5, -offset.y / (2.0 * reach))) * fade
    return 2.0 / reach * (speed * aim - abs(speed) * offset.theta)


def return_speed(offset: Pose) -> float:
    """The speed in m/s that returns a turning robot to its spot.

    `offset` is the robot's pose relative to the spot. Slipping wheels move the robot away
    from it; during a turn, the spot is ahead of or behind the robot at some time.
    """
    ahead = offset.x * math.cos(offset.theta) + offset.y * math.sin(offset.theta)
    return max(-0.02, min(0.02, -2.0 * ahead))
