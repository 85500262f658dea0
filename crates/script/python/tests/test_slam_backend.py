"""Knowing where it is by what it sees, with wheels that slip."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from pydslrep_parts.occupancy_grid import Floor, Reading
from pydslrep_parts.pose import Pose
from pydslrep_parts.scan_log import Diary, Look
from pydslrep_parts.slam_rover import Surveyor
from rooms import Pillar, Rooms
from slipping_robot import SlippingRobot

AHEAD = Look([Reading(Pose(0.1, 0.0, 0.0), math.radians(170.0), 0.5, sees=True)])


def surveyor(robot: SlippingRobot) -> Surveyor:
    survey: Any = SimpleNamespace(
        by_odometry=True,
        extent=20.0,
        range=lambda robot, sensor, told: told,
        cone=lambda robot, sensor, told: told,
        radius=lambda robot, spanned: spanned,
    )
    driving: Any = robot
    return Surveyor(driving, survey)


def test_exploring_by_wheels_that_slip() -> None:
    # A way around a block, so that there is a loop to close.
    rooms = Rooms(3.0, 3.0, start=(0.6, 0.6), pillars=[Pillar((1.5, 1.5), 0.45)])
    robot = SlippingRobot(rooms, slip=0.02, noise=0.01, seed=1)
    explorer = surveyor(robot).explore()
    explorer.explore()
    assert not robot.touched
    away, turned = robot.off()
    assert away < 0.1
    assert turned < 3.0
    nodes = [node.place for node in explorer.map.nodes]
    assert rooms.coverage(nodes, 1.5, grain=0.2) >= 0.95
    for a, b, length in explorer.map.edges():
        assert rooms.is_straight(nodes[a], nodes[b])
        assert length == pytest.approx(math.dist(nodes[a], nodes[b]))


def test_what_was_seen_moves_with_the_places() -> None:
    diary = Diary()
    start, end = Pose(0.0, 0.0, 0.0), Pose(2.0, 0.0, 0.0)
    diary.note(start, AHEAD)
    diary.arrive(start, start)
    for x in (0.0, 1.0, 2.0):
        diary.note(Pose(x, 0.0, 0.0), AHEAD)
    diary.arrive(end, end)
    straight = Floor(0.05)
    diary.draw(straight, [start, end])
    assert straight.has_room(1.3, 0.0)
    assert not straight.has_room(1.3, 0.5)
    # The second place turns out to be a metre further left: half of that is half-way.
    bent = Floor(0.05)
    diary.draw(bent, [start, Pose(2.0, 1.0, 0.0)])
    assert bent.has_room(1.3, 0.5)
    assert not bent.has_room(1.3, -0.3)


def test_an_obstacle_that_came_near_is_drawn_again() -> None:
    diary = Diary()
    origin = Pose(0.0, 0.0, 0.0)
    diary.note(origin, AHEAD)
    diary.arrive(origin, origin)
    diary.note(origin, Look((), (0.3, 0.0)))
    floor = Floor(0.05)
    diary.draw(floor, [origin])
    assert not floor.has_room(0.3, 0.0)
    floor.clear()
    diary.draw(floor, [Pose(0.0, 0.0, math.pi / 2.0)])
    assert not floor.has_room(0.0, 0.3)
