#: if standalone
"""What is known of a robot: from the program, and measured in the scene."""

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
    """What the program says of a robot; the scene tells the rest."""

    name: str
    port: int
    drive: type[Drive]
    wheels: Mapping[str, float]  # radius in metres by the joint's name
    #: if until or slam
    sensors: Sequence[str] = ()
    #: endif
    #: if slam
    eyes: Sequence[str] = ()  # the sensors that it explores with
    #: endif


#: if slam
@dataclass(frozen=True)
class Eye:
    """What is known of a proximity sensor: its mount, and what the simulator tells."""

    mount: Pose  # on the robot, looking along its heading
    range: float | None = None  # m
    cone: float | None = None  # radians


#: endif
class Mounting:
    """Where a robot's wheels are on its body, and which way round their joints turn.

    Objects are given by their matrices: rows of rotation and translation, 12 numbers.
    """

    def __init__(
        self,
        model: RobotModel,
        body: Sequence[float],
        joints: Sequence[Sequence[float]],
    ) -> None:
        """Measures: nothing about a robot is assumed; raises SetupError."""
        x_axis, y_axis = (body[0], body[4], body[8]), (body[1], body[5], body[9])
        mounts, self.senses = [], []
        for joint in joints:
            arm = [joint[i] - body[i] for i in (3, 7, 11)]
            mounts.append((dot(x_axis, arm), dot(y_axis, arm)))
            # A joint turns about its z axis: towards the body's left, it rolls forward.
            axis = (joint[2], joint[6], joint[10])
            self.senses.append(math.copysign(1.0, dot(y_axis, axis)))
        self._center = tuple(
            sum(side) / len(mounts) for side in zip(*mounts, strict=True)
        )
        try:
            self.drive = model.drive(mounts, list(model.wheels.values()))
        except SetupError as error:
            raise SetupError(f"robot {model.name}: {error}") from None

    #: if slam
    def mount(self, body: Sequence[float], sensor: Sequence[float]) -> Pose:
        """Where a sensor is, and where its z axis points, as seen from the wheels' middle."""
        looking = math.atan2(sensor[6], sensor[2])
        return Pose(sensor[3], sensor[7], looking).seen_from(self.pose(body))

    #: endif
    def pose(self, body: Sequence[float]) -> Pose:
        """Where the middle of the wheels is, and the robot's heading."""
        x, y = self._center
        return Pose(
            body[0] * x + body[1] * y + body[3],
            body[4] * x + body[5] * y + body[7],
            math.atan2(body[4], body[0]),
        )
