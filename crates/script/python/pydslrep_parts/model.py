#: if standalone
"""Models of robots: from the program, and measured in the scene."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .drive import Drive
from .errors import SetupError
from .pose import Pose

#: endif


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """The scalar product."""
    return sum(p * q for p, q in zip(a, b, strict=True))


@dataclass(frozen=True)
class RobotModel:
    """A robot as the program declares it; the rest is measured in the scene."""

    name: str
    port: int
    drive: type[Drive]
    wheels: Mapping[str, float]  # radius in metres by the joint's name
    #: if until or slam
    sensors: Sequence[str] = ()
    #: endif
    #: if slam
    slam_sensors: Sequence[str] = ()  # that it explores with
    #: endif


#: if slam
@dataclass(frozen=True)
class SensorCone:
    """The mount and detection volume of a proximity sensor."""

    mount: Pose  # on the robot, pointing along its heading
    range: float | None = None  # m; None if unknown
    angle: float | None = None  # radians from edge to edge; None if unknown


#: endif
class Mounting:
    """The positions of a robot's wheels on its body, and the signs of their joints' axes.

    Objects are given as matrices: rows of rotation and translation, 12 numbers.
    """

    def __init__(
        self,
        model: RobotModel,
        body: Sequence[float],
        joints: Sequence[Sequence[float]],
    ) -> None:
        """Measures a robot without assuming its dimensions; raises SetupError."""
        x_axis, y_axis = (body[0], body[4], body[8]), (body[1], body[5], body[9])
        mounts, self.axis_signs = [], []
        for joint in joints:
            arm = [joint[i] - body[i] for i in (3, 7, 11)]
            mounts.append((dot(x_axis, arm), dot(y_axis, arm)))
            # If a joint's z axis points left, a positive rate rolls the wheel forward.
            axis = (joint[2], joint[6], joint[10])
            self.axis_signs.append(math.copysign(1.0, dot(y_axis, axis)))
        self._center = tuple(
            sum(side) / len(mounts) for side in zip(*mounts, strict=True)
        )
        try:
            self.drive = model.drive(mounts, list(model.wheels.values()))
        except SetupError as error:
            raise SetupError(f"robot {model.name}: {error}") from None

    #: if slam
    def mount(self, body: Sequence[float], sensor: Sequence[float]) -> Pose:
        """A sensor's pose relative to the wheels' centre; it points along its z axis."""
        bearing = math.atan2(sensor[6], sensor[2])
        return Pose(sensor[3], sensor[7], bearing).relative_to(self.pose(body))

    #: endif
    def pose(self, body: Sequence[float]) -> Pose:
        """The pose of the wheels' centre."""
        x, y = self._center
        return Pose(
            body[0] * x + body[1] * y + body[3],
            body[4] * x + body[5] * y + body[7],
            math.atan2(body[4], body[0]),
        )
