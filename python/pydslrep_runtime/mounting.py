"""Where a robot's wheels and sensors are, measured in a simulator's scene.

Objects are given as matrices: rows of rotation and translation, 12 numbers.
"""

import math
from collections.abc import Iterable, Sequence

from .pose import Pose


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """The scalar product."""
    return sum(p * q for p, q in zip(a, b, strict=True))


MAX_MISALIGNMENT = (
    30.0  # degrees; a body or an axis that is further off is meant to point elsewhere
)
LOST = 0.02  # m by which a wheel has moved on its body, above which it is none of it


def angle_to_vertical(body: Sequence[float]) -> float:
    """The angle between a body's z axis and the vertical, in degrees."""
    return math.degrees(math.acos(max(-1.0, min(1.0, body[10]))))


def angle_to_left(body: Sequence[float], joint: Sequence[float]) -> float:
    """The angle between a joint's axis, in either direction, and a body's y axis, in degrees."""
    cosine = dot((body[1], body[5], body[9]), (joint[2], joint[6], joint[10]))
    return math.degrees(math.acos(min(1.0, abs(cosine))))


def positions(
    body: Sequence[float], joints: Iterable[Sequence[float]]
) -> list[tuple[float, float]]:
    """Where joints are on a body: x ahead and y to the left, in metres."""
    x_axis, y_axis = (body[0], body[4], body[8]), (body[1], body[5], body[9])
    arms = [[joint[i] - body[i] for i in (3, 7, 11)] for joint in joints]
    return [(dot(x_axis, arm), dot(y_axis, arm)) for arm in arms]


class Mounting:
    """The positions of a robot's wheels on its body, and the signs of their joints' axes."""

    def __init__(
        self, body: Sequence[float], joints: Sequence[Sequence[float]]
    ) -> None:
        """Measures a robot without assuming its dimensions."""
        y_axis = (body[1], body[5], body[9])
        self.wheels = positions(body, joints)  # x ahead and y left in the body, m
        self.axis_signs: list[float] = []
        for joint in joints:
            # If a joint's z axis points left, a positive rate rolls the wheel forward.
            axis = (joint[2], joint[6], joint[10])
            self.axis_signs.append(math.copysign(1.0, dot(y_axis, axis)))
        self._center = tuple(
            sum(side) / len(self.wheels) for side in zip(*self.wheels, strict=True)
        )

    def has_lost_wheels(
        self, body: Sequence[float], joints: Sequence[Sequence[float]]
    ) -> bool:
        """Whether wheels have moved away from where they were on the body."""
        now = positions(body, joints)
        return any(
            math.dist(*pair) > LOST for pair in zip(self.wheels, now, strict=True)
        )

    def mount(self, body: Sequence[float], sensor: Sequence[float]) -> Pose:
        """A sensor's pose relative to the wheels' centre; it points along its z axis."""
        bearing = math.atan2(sensor[6], sensor[2])
        return Pose(sensor[3], sensor[7], bearing).relative_to(self.pose(body))

    def pose(self, body: Sequence[float]) -> Pose:
        """The pose of the wheels' centre."""
        x, y = self._center
        return Pose(
            body[0] * x + body[1] * y + body[3],
            body[4] * x + body[5] * y + body[7],
            math.atan2(body[4], body[0]),
        )
