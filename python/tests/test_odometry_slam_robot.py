"""SLAM with wheels that slip."""

import math
import random
from typing import Any

import numpy as np
import pytest
from ideal_robot import at_once
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.occupancy_grid import Cell, OccupancyGrid, Reading
from pydslrep_runtime.slam.odometry.calibration import Calibration
from pydslrep_runtime.slam.odometry.graph_slam import GraphSlam
from pydslrep_runtime.slam.odometry.odometer import Leg
from pydslrep_runtime.slam.odometry.robot import OdometrySlamRobot
from pydslrep_runtime.slam.odometry.scan_log import ScanLog
from pydslrep_runtime.slam.odometry.surface import SurfacePoints
from rooms import Pillar, Rooms, Wall
from slipping_robot import SlippingRobot, slam_robot

AHEAD = [Reading(Pose(0.1, 0.0, 0.0), math.radians(170.0), 0.5, is_hit=True)]


class Grid(OccupancyGrid):
    """A grid that shows its cells."""

    def cells(self) -> tuple[set[Cell], set[Cell]]:
        return self._free, self._occupied - self._free


def test_exploring_with_wheels_that_slip() -> None:
    # A path around a block: a loop to close.
    rooms = Rooms(3.0, 3.0, start=(0.6, 0.6), pillars=[Pillar((1.5, 1.5), 0.45)])
    robot = SlippingRobot(rooms, slip=0.02, noise=0.01, seed=1)
    explorer = slam_robot(robot).explorer()
    at_once(explorer.explore())
    assert not robot.touched
    away, turned = robot.off()
    assert away < 0.1
    assert turned < 3.0
    nodes = [node.position for node in explorer.map.nodes]
    assert rooms.coverage(nodes, 1.5, grain=0.2) >= 0.95
    for a, b, length in explorer.map.edges():
        assert rooms.is_straight(nodes[a], nodes[b])
        assert length == pytest.approx(math.dist(nodes[a], nodes[b]))


# Neither half turns nor quarter turns leave it as it is.
SCALENE = Rooms(1.6, 1.2, start=(0.6, 0.5), walls=[Wall((1.2, 0.0), (1.2, 0.5))])


def pushed(robot: SlippingRobot, angle: float) -> OdometrySlamRobot:
    """A robot after a push that its wheels have not noticed, and another scan."""
    exploring = slam_robot(robot)
    at_once(exploring.localise())
    robot.here = robot.here.turned(angle)
    at_once(exploring.localise())
    return exploring


@pytest.mark.parametrize("degrees", [25.0, -40.0, 55.0])
def test_a_robot_that_was_turned_finds_its_way(degrees: float) -> None:
    robot = SlippingRobot(SCALENE, noise=0.01)
    exploring = pushed(robot, math.radians(degrees))
    assert not exploring.uncertain()
    away, turned = robot.off()
    assert away < 0.05
    assert turned < 3.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_robot_notices_that_it_could_not_turn(side: float) -> None:
    rooms = Rooms(1.8, 3.0, start=(0.4, 1.0))
    robot = SlippingRobot(rooms, noise=0.01)
    exploring = slam_robot(robot)
    at_once(exploring.localise())
    # Its wheels turn on, by more than a quarter turn, before it is free.
    robot.blocked_steps = 110
    post = robot.here.turned(side * math.radians(75.0)).ahead(0.19)
    robot.blocks = [(post.x, post.y)]
    at_once(exploring.localise())
    away, turned = robot.off()
    assert away < 0.05
    assert turned < 3.0


class Walls:
    """A scan of walls, most of them at one angle, the rest at right angles to the axes."""

    def __init__(self, degrees: float, part: float) -> None:
        count = round(40 * part)
        bearing = np.linspace(0.0, math.tau, 40)
        normal = np.exp(1j * np.radians(np.where(np.arange(40) < count, degrees, 0.0)))
        self._points = SurfacePoints(np.exp(1j * bearing), normal, np.zeros(40))

    def middle_pose(self) -> Pose:
        return Pose(0.0, 0.0, 0.0)

    def turned(self) -> float:
        return math.pi

    def surface_points(self) -> SurfacePoints:
        return self._points


@pytest.mark.parametrize(
    ("way", "degrees", "part", "corrected"),
    [
        (9.0, 12.0, 0.7, 0.0),
        (9.0, 12.0, 0.9, -12.0),
        # The longer no walls have told the heading, the less sure is the estimate.
        (9.0, 9.0, 0.6, -9.0),
        (2.5, 9.0, 0.6, 0.0),
    ],
)
def test_few_oblique_walls_do_not_turn_the_robot(
    way: float, degrees: float, part: float, corrected: float
) -> None:
    slam, start = GraphSlam(Calibration()), Pose(0.0, 0.0, 0.0)
    first: Any = Walls(0.0, 1.0)
    slam.add_keyframe(first, start, Leg(0.0, 0.0))
    # Too far for a match with the first.
    second: Any = Walls(degrees, part)
    second.middle_pose = lambda: Pose(9.0, 0.0, 0.0)
    here = slam.add_keyframe(second, Pose(9.0, 0.0, 0.0), Leg(way, 0.0))
    assert math.degrees(here.theta) == pytest.approx(corrected, abs=3.0)


def test_a_robot_that_was_held_finds_its_way() -> None:
    robot = SlippingRobot(Rooms(4.0, 4.0, start=(0.4, 2.0)), noise=0.01)
    exploring = slam_robot(robot)
    at_once(exploring.localise())
    at_once(exploring.turn_by(-exploring.pose().theta))
    # Its wheels roll on, but it does not move.
    robot.blocks = [(robot.here.x + 0.16, robot.here.y + 0.1)]
    at_once(exploring.drive_to((0.65, 2.0), lambda: False))
    robot.blocks = []
    assert robot.off()[0] > 0.2
    at_once(exploring.localise())
    assert robot.off()[0] < 0.05


def test_a_robot_that_was_held_is_lost_until_a_scan_fits() -> None:
    slam, start = GraphSlam(Calibration()), Pose(0.0, 0.0, 0.0)
    first: Any = Walls(0.0, 1.0)
    slam.add_keyframe(first, start, Leg(0.0))
    # As far as it drives, nothing is known; whether it was held decides.
    for number, turn in ((1, 0.0), (2, None)):
        there: Any = Walls(0.0, 1.0)
        pose = Pose(9.0 * number, 0.0, 0.0)
        there.middle_pose = lambda pose=pose: pose
        slam.add_keyframe(there, pose, Leg(9.0, turn))
        assert slam.is_lost == (turn is None)
    assert slam.uncertain == {2}


def test_a_robot_is_lost_where_two_places_look_alike() -> None:
    # Turned by 90 degrees to the left or to the right?
    robot = SlippingRobot(Rooms(1.8, 1.0, start=(0.9, 0.5)), noise=0.01)
    exploring = pushed(robot, math.radians(90.0))
    assert exploring.uncertain()
    assert 0 not in exploring.uncertain()


def test_a_robot_makes_room_before_it_turns() -> None:
    robot = SlippingRobot(Rooms(1.6, 1.6, start=(0.8, 0.8)))
    exploring = slam_robot(robot)
    at_once(exploring.localise())
    at_once(exploring.turn_by(-exploring.pose().theta))
    at_once(robot.drive_to(exploring.pose().ahead(0.6), lambda _: False))
    at_once(exploring.localise())
    assert not robot.touched


START, END = Pose(0.0, 0.0, 0.0), Pose(2.0, 0.0, 0.0)


def log_of_a_straight_drive(*, is_valid: bool = True) -> ScanLog:
    """The readings from the start to the end, between two keyframes."""
    log = ScanLog()
    log.add(START, AHEAD)
    log.add_keyframe(START, START)
    for x in (0.0, 1.0, 2.0):
        log.add(Pose(x, 0.0, 0.0), AHEAD)
    log.add_keyframe(END, END, is_valid=is_valid)
    return log


def test_readings_move_with_the_keyframes() -> None:
    log = log_of_a_straight_drive()
    straight = OccupancyGrid(0.05)
    log.replay(straight, [START, END])
    assert straight.has_clearance(1.3, 0.0)
    assert not straight.has_clearance(1.3, 0.5)
    # The second keyframe moves a metre to the left: halfway, that is half a metre.
    bent = OccupancyGrid(0.05)
    log.replay(bent, [START, Pose(2.0, 1.0, 0.0)])
    assert bent.has_clearance(1.3, 0.5)
    assert not bent.has_clearance(1.3, -0.3)


def test_readings_are_dropped_where_odometry_has_failed() -> None:
    log = log_of_a_straight_drive(is_valid=False)
    grid = OccupancyGrid(0.05)
    log.replay(grid, [START, END])
    assert not grid.has_clearance(1.3, 0.0)
    assert grid.has_clearance(2.3, 0.0)


def test_an_obstacle_moves_with_its_keyframe() -> None:
    log = ScanLog()
    origin = Pose(0.0, 0.0, 0.0)
    log.add(origin, AHEAD)
    log.add_keyframe(origin, origin)
    log.add_obstacle(origin, 0.3, 0.0)
    grid = OccupancyGrid(0.05)
    log.replay(grid, [origin])
    assert not grid.has_clearance(0.3, 0.0)
    grid.reset()
    log.replay(grid, [Pose(0.0, 0.0, math.pi / 2.0)])
    assert not grid.has_clearance(0.0, 0.3)


def test_a_later_reading_finds_an_obstacle_gone() -> None:
    log = ScanLog()
    origin = Pose(0.0, 0.0, 0.0)
    log.add_keyframe(origin, origin)
    log.add(origin, AHEAD)
    log.add_obstacle(origin, 0.3, 0.0)
    log.add(origin, AHEAD)
    grid = OccupancyGrid(0.05)
    log.replay(grid, [origin])
    assert grid.has_clearance(0.3, 0.0)


@pytest.mark.parametrize("angle", [5.0, 20.0, 45.0])
def test_the_log_finds_the_cells_of_each_reading(angle: float) -> None:
    dice = random.Random(5)
    readings = [
        Reading(
            Pose(dice.uniform(-9, 9), dice.uniform(-9, 9), dice.uniform(-4, 4)),
            math.radians(angle),
            dice.uniform(0.0, 2.0),
            is_hit=dice.random() < 0.5,
        )
        for _ in range(200)
    ]
    one_by_one, together = Grid(0.01), Grid(0.01)
    for reading in readings:
        one_by_one.add_reading(reading)
    one_by_one.mark_footprint(0.0, 0.0)
    log = ScanLog()
    origin = Pose(0.0, 0.0, 0.0)
    log.add_keyframe(origin, origin)
    log.add(origin, readings)
    log.replay(together, [origin])
    assert one_by_one.cells() == together.cells()
    assert len(together.cells()[0]) > 1000
