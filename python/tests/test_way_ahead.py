"""What a robot remembers of the way ahead."""

import math

from ideal_robot import RADIUS, at_once
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.occupancy_grid import Reading
from pydslrep_runtime.slam.odometry.robot import OdometrySlamRobot
from pydslrep_runtime.slam.odometry.way_ahead import WayAhead
from rooms import Rooms, Wall
from slipping_robot import SlippingRobot, slam_robot

AHEAD = Pose(0.15, 0.0, 0.0)
START = Pose(0.0, 0.0, 0.0)


def seen(distance: float, *, is_hit: bool = True) -> Reading:
    """A reading of the sensor that looks ahead."""
    return Reading(AHEAD, math.radians(20.0), distance, is_hit)


def looking_ahead(robot: SlippingRobot) -> OdometrySlamRobot:
    """A robot that has made its first scan and looks along the x axis."""
    exploring = slam_robot(robot)
    at_once(exploring.localise())
    at_once(exploring.turn_by(-exploring.pose().theta))
    return exploring


def drive(goal: float, *walls: Wall) -> tuple[bool, SlippingRobot]:
    """Drives from 0.5 m along the x axis in a room; whether it got there, and the robot."""
    robot = SlippingRobot(Rooms(2.5, 2.0, start=(0.5, 1.0), walls=[*walls]), noise=0.01)
    exploring = looking_ahead(robot)
    robot.touched.clear()
    return at_once(exploring.drive_to((goal, 1.0), lambda: False)), robot


def test_a_robot_remembers_the_end_of_a_wall_that_has_left_its_cone() -> None:
    # In front of its right half: from 0.28 m on, the cone of its sensor is too narrow.
    arrived, robot = drive(1.3, Wall((1.3, 0.9), (2.4, 0.9)))
    assert not arrived
    assert not robot.touched
    assert robot.here.x > 0.9


def test_a_robot_remembers_what_it_has_seen_before_it_drives() -> None:
    # So near that only a look aside has seen it.
    arrived, robot = drive(1.0, Wall((0.8, 0.9), (2.4, 0.9)))
    assert not arrived
    assert not robot.touched


def test_what_is_beside_the_way_does_not_stop_a_robot() -> None:
    arrived, _ = drive(1.3, *(Wall((1.3, y), (2.4, y)) for y in (0.7, 1.3)))
    assert arrived


def test_what_may_be_beside_the_way_is_not_ahead() -> None:
    way = WayAhead(START, RADIUS)
    # The cone is wider than the robot there.
    way.add(START, [seen(0.9)])
    way.add(START, [seen(0.3, is_hit=False)])
    assert not way.is_near_end(START, 9.0)
    way.add(START, [seen(0.5)])
    assert way.is_near_end(START, 0.66)
    assert not way.is_near_end(START, 0.64)
