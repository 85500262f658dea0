"""A turn in place that shows how far the wheels of a robot in ROS 2 seem to be apart."""

import math

from . import drives
from .backend import RobotSpec
from .facts import RIM_SPEED, ROBOT_TYPES, TRACK
from .pose import Pose, wrap_angle
from .ros2 import Ros2, Ros2Robot
from .ros2_findings import finding
from .ros2_topics import Topics
from .scene.findings import Finding
from .settings import REPLY_TIMEOUT

SETTLING = 1.0  # s until it turns as fast as it can
MEASURED = math.radians(90.0)  # that it is told to turn then
STANDS = 0.1  # of the rate that it is told, below which it does not turn
TOLERANCE = 0.07  # of that rate: smaller errors, odometry corrects; wheels that roll well creep by some percent


def measure_turn(spec: RobotSpec, *, is_simulated: bool) -> tuple[str, list[Finding]]:
    """Turns a robot to the left, and compares its odometry with what it was told; a note, and what is wrong.

    Raises SetupError and SimulatorError, after having stopped it.
    """
    ros = Ros2(sim_time=is_simulated, timeout=REPLY_TIMEOUT)
    try:
        robot = ros.connect(spec)
        ros.start()
        try:
            told, found = turn(ros, robot, spec)
        finally:
            robot.stop()
    finally:
        ros.close()
    return describe(spec, told, found), judge(spec, told, found)


def turn(ros: Ros2, robot: Ros2Robot, spec: RobotSpec) -> tuple[float, float]:
    """How fast a robot is told to turn, and does turn, in rad/s."""
    drive_type = getattr(drives, ROBOT_TYPES[spec.type].drive)
    drive = drive_type(robot.wheel_mounts(), [*spec.wheels.values()])
    robot.set_wheel_rates(
        drive.turn_in_place(RIM_SPEED, Pose(0.0, 0.0, 0.0), None, 0.0)
    )
    while ros.time < SETTLING:
        ros.advance()
        robot.pose()  # fails if it is too old
    begin, last, turned = robot.pose_time(), robot.pose(), 0.0
    end = begin + MEASURED / robot.turn_rate
    while robot.pose_time() < end:
        ros.advance()
        pose = robot.pose()
        turned += wrap_angle(pose.theta - last.theta)
        last = pose
    return robot.turn_rate, turned / (robot.pose_time() - begin)


def describe(spec: RobotSpec, told: float, found: float) -> str:
    """What a turn has shown, in a sentence."""
    rates = f"told to turn by {math.degrees(told):.1f} deg/s, it turned by {math.degrees(found):.1f} deg/s"
    if found < STANDS * told:
        return f"robot {spec.name}: {rates}"
    track = spec.ros2.get("track", TRACK)
    fits = f"as if its wheels were {track * told / found:.3f} m apart, of {track:.3f} m in the scene"
    return f"robot {spec.name}: {rates}, {fits}"


def judge(spec: RobotSpec, told: float, found: float) -> list[Finding]:
    """What is wrong with a turn."""
    rates = {"told": math.degrees(told), "found": math.degrees(found)}
    if abs(found) < STANDS * told:
        topic = Topics(spec.name, spec.ros2).command.name
        return [finding("does-not-turn", spec.name, topic=topic, **rates)]
    if found < 0.0:
        rates["found"] = -rates["found"]
        return [finding("turns-back", spec.name, **rates)]
    if abs(found / told - 1.0) <= TOLERANCE:
        return []
    track = spec.ros2.get("track", TRACK)
    fits = track * told / found
    return [finding("track", spec.name, track=track, fits=fits, **rates)]
