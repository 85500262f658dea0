import math

import pytest
from pydslrep_parts.dominant_orientation import grain_of
from pydslrep_parts.pose import Pose, wrap_angle
from pydslrep_parts.scan import Mark, Sweep
from pydslrep_parts.scan_matching import KnownMark, KnownMarks, match, solve
from rooms import Pillar, Rooms
from slipping_robot import SlippingRobot, sweep_from

ROOM = Rooms(1.4, 1.7)
HERE = Pose(0.6, 0.8, 0.4)


def known(marks: list[Mark], place: Pose) -> KnownMarks:
    ends = (Pose(mark.x, mark.y, mark.normal).placed_on(place) for mark in marks)
    return KnownMarks(
        KnownMark(end.x, end.y, math.cos(end.theta), math.sin(end.theta), 7)
        for end in ends
    )


def off_walls(sweep: Sweep, room: Rooms) -> list[tuple[float, float]]:
    """How far off the nearest wall marks are in metres, and their normals in degrees."""
    found = []
    for mark in sweep.marks():
        at = Pose(mark.x, mark.y, mark.normal).placed_on(sweep.middle())
        sides = [
            (at.x, 0.0),
            (at.y, 90.0),
            (room.width - at.x, 180.0),
            (room.height - at.y, -90.0),
        ]
        away, normal = min(sides, key=lambda side: abs(side[0]))
        turned = wrap_angle(at.theta - math.radians(normal))
        found.append((abs(away), abs(math.degrees(turned))))
    return found


@pytest.mark.parametrize("angle", [math.pi, -math.pi])
def test_marks_lie_on_the_walls(angle: float) -> None:
    found = off_walls(sweep_from(SlippingRobot(ROOM), HERE, angle), ROOM)
    assert len(found) > 200
    aways, turns = (sorted(values) for values in zip(*found, strict=True))
    # Corners are rounded by cones, flat walls are not.
    assert aways[len(aways) * 3 // 4] < 0.005
    assert turns[len(turns) // 2] < 1.5


def test_noise_moves_marks_little() -> None:
    robot = SlippingRobot(ROOM, noise=0.01)
    aways = sorted(away for away, _ in off_walls(sweep_from(robot, HERE), ROOM))
    assert len(aways) > 100
    assert aways[len(aways) // 2] < 0.008


def test_nothing_near_leaves_no_marks() -> None:
    wide = Rooms(9.0, 9.0, pillars=[Pillar((1.0, 1.0), 0.1)])
    assert sweep_from(SlippingRobot(wide), Pose(4.0, 4.0, 0.0)).marks() == []


def test_equations_are_solved() -> None:
    found = solve([[4.0, 1.0, 0.0], [1.0, 3.0, 1.0], [0.0, 1.0, 2.0]], [6.0, 10.0, 8.0])
    assert found == pytest.approx([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    "off", [Pose(0.0, 0.0, 0.0), Pose(0.06, -0.05, 0.0), Pose(-0.04, 0.05, -0.08)]
)
def test_marks_tell_where_they_are_seen_from(off: Pose) -> None:
    robot = SlippingRobot(ROOM, noise=0.01)
    first = sweep_from(robot, HERE)
    second = sweep_from(robot, Pose(0.8, 1.0, -1.0))
    there = second.middle()
    guess = Pose(there.x + off.x, there.y + off.y, there.theta + off.theta)
    found = match(
        second.marks(), guess, (0.1, 0.1), known(first.marks(), first.middle())
    )
    assert found is not None
    assert list(found.information) == [7]
    assert math.hypot(found.pose.x - there.x, found.pose.y - there.y) < 0.01
    assert abs(wrap_angle(found.pose.theta - there.theta)) < math.radians(1.0)


def test_along_a_bare_wall_the_guess_stays() -> None:
    corridor = Rooms(9.0, 1.2)
    robot = SlippingRobot(corridor)
    first = sweep_from(robot, Pose(4.0, 0.6, 0.0))
    second = sweep_from(robot, Pose(4.4, 0.6, 0.0))
    there = second.middle()
    guess = Pose(there.x + 0.05, there.y + 0.05, there.theta)
    found = match(
        second.marks(), guess, (0.1, 0.1), known(first.marks(), first.middle())
    )
    assert found is not None
    assert found.pose.y == pytest.approx(there.y, abs=0.01)
    assert found.pose.x == pytest.approx(guess.x, abs=0.03)
    information = found.information[7]
    assert information[1][1] > 20.0 * information[0][0]


def test_what_was_never_seen_matches_nothing() -> None:
    marks = sweep_from(SlippingRobot(ROOM), HERE).marks()
    assert match(marks, Pose(5.0, 5.0, 0.0), (0.1, 0.1), known(marks, HERE)) is None


def test_walls_tell_the_heading_and_how_far_wheels_slipped() -> None:
    sweep = sweep_from(SlippingRobot(ROOM), HERE)
    walls = -sweep.middle().theta
    found = grain_of(sweep.marks(), walls + 0.1, 0.3)
    assert found is not None
    assert math.remainder(found.angle - walls, math.pi / 2.0) == pytest.approx(
        0.0, abs=0.01
    )
    assert found.share > 0.8
    # A sweep that turned further than its wheels: what is seen late is further left.
    late = [
        Mark(mark.x, mark.y, mark.normal - 0.06 * mark.when, mark.when)
        for mark in sweep.marks()
    ]
    slipped = grain_of(late, walls, 0.3)
    assert slipped is not None
    assert 0.02 < slipped.drift - found.drift < 0.08


def test_few_marks_tell_no_heading() -> None:
    assert grain_of([Mark(1.0, 0.0, math.pi)] * 10, 0.0, 0.3) is None
