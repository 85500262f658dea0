"""Types of robots, and figures of scenes and motion, as the command has them.

A test of the command writes this file, crates/script/tests/facts.rs: do not change it here.
"""

import math
from typing import Literal, NamedTuple

STEP = 0.05  # s of simulation time, unless a scene has other steps
RIM_SPEED = 0.09  # m/s at the wheels' rims, in turns and in moves without a speed
RIM_ACCELERATION = 0.5  # m/s² at the rims, when accelerating and braking
MOTOR_ACCELERATION = 1.0  # m/s² at the rims, at most, unless a scene has it
SENSOR_RANGE = 1.0  # m of a distance sensor, unless a scene has it
SENSOR_CONE = math.radians(20.0)  # opening angle of a sensor, unless a scene has it
TRACK = 0.3  # m between left and right wheels, unless a scene has it
WHEELBASE = 0.25  # m between front and rear wheels, unless a scene has it

# What a robot is like in ROS 2, unless a scene has it.
ROS2_CMD_VEL = "cmd_vel"
ROS2_STAMPED = False
ROS2_ODOM = "odom"
ROS2_RANGES = "range/{sensor}"
ROS2_BASE_FRAME = "base_link"
ROS2_ODOM_FRAME = "odom"
ROS2_QOS = "best-effort"
ROS2_SPEED_LIMIT = 0.5

TypeName = Literal["tw", "fw", "fwh"]


class RobotType(NamedTuple):
    """What tells a type of robot apart from the others."""

    robot: str  # the class that scripts make robots of
    drive: str  # the class that drives them
    number: str  # of its wheels, in words
    wheels: tuple[str, ...]  # their places in order
    pushes: tuple[float, ...]  # to the left, as a share of that ahead
    mecanum: bool
    one_axle: bool  # so that casters must support it
    scrubs: bool  # whether wheels slide sideways in turns
    grip: float  # as in a scene, unless that says otherwise


ROBOT_TYPES: dict[TypeName, RobotType] = {
    "tw": RobotType(
        robot="TwoWheelRobot",
        drive="TwoWheelDrive",
        number="two",
        wheels=("left", "right"),
        pushes=(0.0, 0.0),
        mecanum=False,
        one_axle=True,
        scrubs=False,
        grip=1.0,
    ),
    "fw": RobotType(
        robot="FourWheelRobot",
        drive="FourWheelDrive",
        number="four",
        wheels=("left_front", "left_rear", "right_front", "right_rear"),
        pushes=(0.0, 0.0, 0.0, 0.0),
        mecanum=False,
        one_axle=False,
        scrubs=True,
        grip=1.0,
    ),
    "fwh": RobotType(
        robot="MecanumRobot",
        drive="MecanumDrive",
        number="four",
        wheels=("left_front", "left_rear", "right_front", "right_rear"),
        pushes=(-1.0, 1.0, 1.0, -1.0),
        mecanum=True,
        one_axle=False,
        scrubs=False,
        grip=0.05,
    ),
}
