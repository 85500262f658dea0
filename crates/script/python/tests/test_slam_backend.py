"""SLAM with wheels that slip."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from pydslrep_parts.occupancy_grid import OccupancyGrid, Reading
from pydslrep_parts.pose import Pose
from pydslrep_parts.scan_log import Observation, ScanLog
from pydslrep_parts.slam_rover import SlamRover
from rooms import Pillar, Rooms
from slipping_robot import SlippingRobot

AHEAD = Observation(
    [Reading(Pose(0.1, 0.0, 0.0), math.radians(170.0), 0.5, is_hit=True)]
)


def rover(robot: SlippingRobot) -> SlamRover:
    slam_session: Any = SimpleNamespace(
        uses_odometry=True,
        extent=20.0,
        range=lambda robot, sensor, reported: reported,
        cone=lambda robot, sensor, reported: reported,
        radius=lambda robot, spanned: spanned,
    )
    driving: Any = robot
    return SlamRover(driving, slam_session)


def test_exploring_with_wheels_that_slip() -> None:
    # A path around a block: a loop to close.
    rooms = Rooms(3.0, 3.0, start=(0.6, 0.6), pillars=[Pillar((1.5, 1.5), 0.45)])
    robot = SlippingRobot(rooms, slip=0.02, noise=0.01, seed=1)
    explorer = rover(robot).explorer()
    explorer.explore()
    assert not robot.touched
    away, turned = robot.off()
    assert away < 0.1
    assert turned < 3.0
    nodes = [node.position for node in explorer.map.nodes]
    assert rooms.coverage(nodes, 1.5, grain=0.2) >= 0.95
    for a, b, length in explorer.map.edges():
        assert rooms.is_straight(nodes[a], nodes[b])
        assert length == pytest.approx(math.dist(nodes[a], nodes[b]))


def test_observations_move_with_the_keyframes() -> None:
    log = ScanLog()
    start, end = Pose(0.0, 0.0, 0.0), Pose(2.0, 0.0, 0.0)
    log.add(start, AHEAD)
    log.add_keyframe(start, start)
    for x in (0.0, 1.0, 2.0):
        log.add(Pose(x, 0.0, 0.0), AHEAD)
    log.add_keyframe(end, end)
    straight = OccupancyGrid(0.05)
    log.replay(straight, [start, end])
    assert straight.has_clearance(1.3, 0.0)
    assert not straight.has_clearance(1.3, 0.5)
    # The second keyframe moves a metre to the left: halfway, that is half a metre.
    bent = OccupancyGrid(0.05)
    log.replay(bent, [start, Pose(2.0, 1.0, 0.0)])
    assert bent.has_clearance(1.3, 0.5)
    assert not bent.has_clearance(1.3, -0.3)


def test_an_obstacle_moves_with_its_keyframe() -> None:
    log = ScanLog()
    origin = Pose(0.0, 0.0, 0.0)
    log.add(origin, AHEAD)
    log.add_keyframe(origin, origin)
    log.add(origin, Observation((), (0.3, 0.0)))
    grid = OccupancyGrid(0.05)
    log.replay(grid, [origin])
    assert not grid.has_clearance(0.3, 0.0)
    grid.reset()
    log.replay(grid, [Pose(0.0, 0.0, math.pi / 2.0)])
    assert not grid.has_clearance(0.0, 0.3)
