"""Steering of robots that cannot move sideways, along a line or on a spot."""

import math

from .pose import Pose, wrap_angle

REACH = 0.15  # m of path along which an error is corrected
SOFTNESS = 0.01  # rad
ARC_SPEED = 0.05  # m/s at which a turning robot drives back and forth, at most
MAX_DRIFT = 0.05  # m per radian; a robot that slides further is pushed
DRIFT_DOUBT = 0.002  # rad² of observed steps at which half of a drift is believed
DRIFT_MEMORY = 0.99  # the share of a step's weight that remains after another one


def steer(
    speed: float, offset: Pose, remaining: float, curvature: float = 0.0
) -> float:
    """The turn rate in rad/s that returns a moving robot to its line or circle.

    `offset` is the robot's pose relative to the nearest point of the path, `remaining` the
    distance to its end. The robot approaches the path at an angle that grows with its distance
    from it, up to half a radian, and fades out at the end, where only the heading counts. At
    constant speed this is a critically damped system in the distance driven. On a circle, what
    keeps a robot on it is added; wheels that slip have more effect there, and so has the steering.
    """
    shortest = min(REACH, 1.0 / (5.0 * abs(curvature))) if curvature else REACH
    reach = max(shortest, 0.4 * abs(speed))
    fade = min(1.0, abs(remaining) / (2.0 * reach))
    aim = max(-0.5, min(0.5, -offset.y / (2.0 * reach))) * fade
    correction = 2.0 / reach * (speed * aim - abs(speed) * offset.theta)
    return correction + circling(speed * math.cos(offset.theta), offset, curvature)


def circling(speed: float, offset: Pose, curvature: float) -> float:
    """The turn rate in rad/s of a path at its point nearest to a robot.

    `speed` is the robot's along the path; `offset.y` its distance from it, to the left.
    """
    # The circle through the robot is smaller or larger; but the robot is never at its centre.
    return curvature * speed / max(0.2, 1.0 - curvature * offset.y)


def return_speed(offset: Pose) -> float:
    """The speed in m/s that returns a turning robot to its spot, if the end of the turn is unknown.

    `offset` is the robot's pose relative to the spot. Slipping wheels move the robot away
    from it; during a turn, the spot is ahead of or behind the robot at some time.
    """
    ahead, _ = seen_from(offset)
    return max(-0.02, min(0.02, -2.0 * ahead))


def arc_speed(offset: Pose, turn: float, drift: float, turn_rate: float) -> float:
    """The speed in m/s with which a turning robot is back on its spot at the end of the turn.

    `offset` is the robot's pose relative to the spot, `turn` the angle to go, `drift` how far the robot slides to its
    left per radian, and `turn_rate` its rate in rad/s. A turning robot cannot correct an error to its side, but it will
    face the spot at another time. Of all ways of driving back and forth that end on the spot this takes the shortest
    strokes: with p(s) metres ahead per radian at the angle s from now, the integral of p² is the smallest one for which
    that of p(s) (cos s, sin s) makes up for offset and drift. SOFTNESS allows for a rest of them.
    """
    sin, cos = math.sin(turn), math.cos(turn)
    ahead, left = seen_from(offset)
    ahead -= drift * (1.0 - cos)
    left += drift * sin
    side = math.copysign(1.0, turn)
    # The integrals of cos², sin² and cos · sin.
    cos_cos = turn / 2.0 + sin * cos / 2.0 + side * SOFTNESS
    sin_sin = turn / 2.0 - sin * cos / 2.0 + side * SOFTNESS
    cos_sin = sin * sin / 2.0
    stroke = (cos_sin * left - sin_sin * ahead) / (cos_cos * sin_sin - cos_sin**2)
    return max(-ARC_SPEED, min(ARC_SPEED, stroke * turn_rate))


def seen_from(offset: Pose) -> tuple[float, float]:
    """How far a robot is ahead and to the left of its spot, in its own directions; in metres."""
    cos, sin = math.cos(offset.theta), math.sin(offset.theta)
    return cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x


class Drift:
    """How far a robot slides to its left per radian that it turns, as observed in its turns."""

    def __init__(self) -> None:
        self._slid, self._turned = 0.0, DRIFT_DOUBT

    @property
    def left(self) -> float:
        """Metres per radian; 0 before there is evidence."""
        return max(-MAX_DRIFT, min(MAX_DRIFT, self._slid / self._turned))

    def observe(self, before: Pose, after: Pose) -> None:
        """Adds the poses before and after a step of a turn."""
        turned = wrap_angle(after.theta - before.theta)
        middle = Pose(before.x, before.y, before.theta + turned / 2.0)
        # A least-squares fit in which old steps fade.
        self._slid = DRIFT_MEMORY * self._slid + after.relative_to(middle).y * turned
        self._turned = (
            DRIFT_MEMORY * (self._turned - DRIFT_DOUBT) + turned**2 + DRIFT_DOUBT
        )
