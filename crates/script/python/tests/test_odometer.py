import math
from types import SimpleNamespace
from typing import Any

import pytest
from drifting_rover import DriftingRover
from ghost_rover import RADIUS
from pydslrep_parts.explorer import Explorer
from pydslrep_parts.floor import Floor
from pydslrep_parts.memory import Memory
from pydslrep_parts.odometer import Odometer
from pydslrep_parts.pose import Pose
from rooms import Rooms, Wall

ROOM = [(x / 20.0, y) for x in range(-20, 21) for y in (-0.8, 1.0)]
ROOM += [(x, y / 20.0) for y in range(-16, 21) for x in (-1.0, 1.0)]


def body(angles: list[float]) -> Any:
    model = SimpleNamespace(wheels={"l": 0.05, "r": 0.05})
    return SimpleNamespace(
        model=model,
        drive=SimpleNamespace(turning_radius=0.15),
        pose=lambda: Pose(1.0, 2.0, math.pi / 2.0),
        wheel_angles=lambda: list(angles),
    )


def test_wheels_that_turn_alike_drive_straight() -> None:
    angles = [3.0, -3.0]
    odometer = Odometer(body(angles))
    angles[:] = [5.0, -1.0]
    there = odometer.pose()
    assert (there.x, there.y) == pytest.approx((1.0, 2.1))
    assert odometer.pose() == there


def test_a_joint_may_begin_anew_after_a_turn() -> None:
    angles = [3.1, 3.1]
    odometer = Odometer(body(angles))
    angles[:] = [3.1 - math.tau + 0.2] * 2
    assert odometer.pose().y == pytest.approx(2.01)


def test_an_arc_is_exact() -> None:
    angles = [0.0, 0.0]
    odometer = Odometer(body(angles))
    # About a centre 0.3 m to the left, by 0.2 rad: rims at 0.15 and 0.45 m from it.
    angles[:] = [0.15 * 0.2 / 0.05, 0.45 * 0.2 / 0.05]
    there = odometer.pose()
    assert there.theta == pytest.approx(math.pi / 2.0 + 0.2)
    assert there.x == pytest.approx(1.0 - 0.3 + 0.3 * math.cos(0.2))
    assert there.y == pytest.approx(2.0 + 0.3 * math.sin(0.2))


@pytest.mark.parametrize(
    "off", [Pose(0.0, 0.0, 0.0), Pose(0.08, -0.06, 0.0), Pose(0.03, 0.05, -0.08)]
)
def test_what_was_seen_before_tells_where_a_robot_is(off: Pose) -> None:
    memory = Memory()
    here = Pose(0.0, 0.0, 0.4)
    assert memory.recognise(here, ROOM) == here
    believed = Pose(off.x, off.y, 0.4 + off.theta)
    moved = [Pose(*p, 0.0).seen_from(here).placed_on(believed) for p in ROOM]
    found = memory.recognise(believed, [(p.x, p.y) for p in moved])
    assert (found.x, found.y) == pytest.approx((0.0, 0.0), abs=0.025)
    assert found.theta == pytest.approx(0.4, abs=math.radians(1.5))


def test_what_is_new_or_little_changes_nothing() -> None:
    memory = Memory()
    here = Pose(0.0, 0.0, 0.0)
    memory.recognise(here, ROOM)
    assert memory.recognise(Pose(0.1, 0.0, 0.0), ROOM[:5]) == Pose(0.1, 0.0, 0.0)
    far = Pose(5.0, 0.0, 0.0)
    assert memory.recognise(far, [(x + 5.0, y) for x, y in ROOM]) == far


def test_exploring_by_wheels_that_do_not_slip() -> None:
    rooms = Rooms(4.0, 2.5, start=(0.6, 0.5))
    rooms.walls = [Wall((2.0, 0.0), (2.0, 1.0)), Wall((2.0, 2.0), (2.0, 2.5))]
    rover = DriftingRover(rooms, Floor(RADIUS + 0.05), slip=0.0)
    explorer = Explorer(rover, rover.floor, 0.5, math.pi)
    explorer.explore()
    assert not rover.touched
    assert rover.off() < 0.1
    nodes = [node.place for node in explorer.map.nodes]
    assert rooms.coverage(nodes, 1.5, grain=0.2) >= 0.95
