import math

import pytest
from pydslrep_parts.occupancy_grid import Floor, Reading
from pydslrep_parts.pose import Pose

WIDE = math.radians(170.0)


def seen(*readings: Reading, radius: float = 0.1) -> Floor:
    floor = Floor(radius)
    for reading in readings:
        floor.see(reading)
    return floor


def test_there_is_room_only_where_all_was_seen() -> None:
    floor = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 1.0, sees=False))
    assert floor.has_room(0.5, 0.0)
    assert floor.is_open((0.4, 0.0), (0.7, 0.1))
    assert not floor.has_room(0.0, 0.0)  # behind the sensor nobody has looked
    assert not floor.has_room(0.9, 0.0)  # its far end is out of range
    assert not floor.is_open((0.5, 0.0), (0.9, 0.0))


@pytest.mark.parametrize("bearing", [0.0, 0.3, math.pi / 4, 2.0, -math.pi / 2, 3.1])
def test_a_cone_shows_nothing_beside_it(bearing: float) -> None:
    cone = math.radians(20.0)
    floor = seen(Reading(Pose(3.0, -2.0, bearing), cone, 1.0, sees=False), radius=0.01)
    axis = Pose(3.0, -2.0, bearing)
    ahead = axis.ahead(0.8)
    assert floor.has_room(ahead.x, ahead.y)
    for side in (-0.6, 0.6, math.pi):
        beside = axis.turned(side).ahead(0.8)
        assert not floor.has_room(beside.x, beside.y)


def test_what_is_seen_is_in_the_way() -> None:
    wall = Reading(Pose(0.0, 0.0, 0.0), WIDE, 0.6, sees=True)
    floor = seen(wall)
    assert floor.has_room(0.3, 0.0)
    assert not floor.has_room(0.5, 0.0)
    assert not floor.is_undecided((0.3, 0.0), (0.6, 0.0))
    assert floor.is_undecided((0.3, 0.0), (-0.3, 0.0))
    assert not floor.is_undecided((0.3, 0.0), (0.35, 0.0))


def test_a_nearer_look_opens_what_a_wide_cone_hid() -> None:
    floor = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 0.6, sees=True))
    floor.see(Reading(Pose(0.2, 0.0, 0.0), WIDE, 1.0, sees=False))
    assert floor.is_open((0.4, 0.0), (0.8, 0.0))


def test_a_place_is_bare_where_nothing_is_near() -> None:
    floor = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 1.0, sees=False))
    assert floor.is_bare((0.5, 0.0))
    floor.block(1.0, 0.0)
    assert not floor.is_bare((0.5, 0.0))
    assert floor.is_bare((0.0, 0.0))


def test_something_new_closes_the_floor_about_it() -> None:
    floor = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 2.0, sees=False))
    assert floor.is_open((0.4, 0.0), (1.6, 0.0))
    floor.block(1.0, 0.0)
    assert not floor.is_open((0.4, 0.0), (1.6, 0.0))
    assert not floor.is_undecided((0.4, 0.0), (1.6, 0.0))
    assert floor.is_open((0.4, 0.0), (0.7, 0.0))


def test_a_robot_has_been_where_it_stands() -> None:
    floor = Floor(0.3)
    floor.stand(1.0, 1.0)
    assert not floor.has_room(1.0, 1.0)  # it would need a little more
    floor.see(Reading(Pose(1.0, 1.0, 0.0), WIDE, 1.0, sees=False))
    floor.see(Reading(Pose(1.0, 1.0, math.pi), WIDE, 1.0, sees=False))
    floor.see(Reading(Pose(1.0, 1.0, math.pi / 2), WIDE, 1.0, sees=False))
    floor.see(Reading(Pose(1.0, 1.0, -math.pi / 2), WIDE, 1.0, sees=False))
    assert floor.has_room(1.0, 1.0)
