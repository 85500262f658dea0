import math

import pytest
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.occupancy_grid import OccupancyGrid, Reading

WIDE = math.radians(170.0)


def seen(*readings: Reading, radius: float = 0.1) -> OccupancyGrid:
    grid = OccupancyGrid(radius)
    for reading in readings:
        grid.add_reading(reading)
    return grid


def test_clearance_needs_free_cells_all_around() -> None:
    grid = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 1.0, is_hit=False))
    assert grid.has_clearance(0.5, 0.0)
    assert grid.is_path_clear((0.4, 0.0), (0.7, 0.1))
    assert not grid.has_clearance(0.0, 0.0)  # unknown: behind the sensor
    assert not grid.has_clearance(0.9, 0.0)  # its far end is out of range
    assert not grid.is_path_clear((0.5, 0.0), (0.9, 0.0))


@pytest.mark.parametrize("bearing", [0.0, 0.3, math.pi / 4, 2.0, -math.pi / 2, 3.1])
def test_a_cone_frees_nothing_outside_it(bearing: float) -> None:
    cone = math.radians(20.0)
    grid = seen(Reading(Pose(3.0, -2.0, bearing), cone, 1.0, is_hit=False), radius=0.01)
    axis = Pose(3.0, -2.0, bearing)
    ahead = axis.ahead(0.8)
    assert grid.has_clearance(ahead.x, ahead.y)
    for side in (-0.6, 0.6, math.pi):
        outside = axis.turned(side).ahead(0.8)
        assert not grid.has_clearance(outside.x, outside.y)


def test_a_detected_object_is_an_obstacle() -> None:
    wall = Reading(Pose(0.0, 0.0, 0.0), WIDE, 0.6, is_hit=True)
    grid = seen(wall)
    assert grid.has_clearance(0.3, 0.0)
    assert not grid.has_clearance(0.5, 0.0)
    assert not grid.is_unexplored((0.3, 0.0), (0.6, 0.0))
    assert grid.is_unexplored((0.3, 0.0), (-0.3, 0.0))
    assert not grid.is_unexplored((0.3, 0.0), (0.35, 0.0))


def test_a_closer_reading_clears_what_a_wide_cone_blocked() -> None:
    grid = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 0.6, is_hit=True))
    grid.add_reading(Reading(Pose(0.2, 0.0, 0.0), WIDE, 1.0, is_hit=False))
    assert grid.is_path_clear((0.4, 0.0), (0.8, 0.0))


def test_a_position_is_featureless_if_nothing_is_near() -> None:
    grid = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 1.0, is_hit=False))
    assert grid.is_featureless((0.5, 0.0))
    grid.mark_obstacle(1.0, 0.0)
    assert not grid.is_featureless((0.5, 0.0))
    assert grid.is_featureless((0.0, 0.0))


def test_a_new_obstacle_blocks_the_cells_around_it() -> None:
    grid = seen(Reading(Pose(0.0, 0.0, 0.0), WIDE, 2.0, is_hit=False))
    assert grid.is_path_clear((0.4, 0.0), (1.6, 0.0))
    grid.mark_obstacle(1.0, 0.0)
    assert not grid.is_path_clear((0.4, 0.0), (1.6, 0.0))
    assert not grid.is_unexplored((0.4, 0.0), (1.6, 0.0))
    assert grid.is_path_clear((0.4, 0.0), (0.7, 0.0))


def test_the_footprint_of_a_robot_is_free() -> None:
    grid = OccupancyGrid(0.3)
    grid.mark_footprint(1.0, 1.0)
    assert not grid.has_clearance(1.0, 1.0)  # the clearance is wider than the footprint
    grid.add_reading(Reading(Pose(1.0, 1.0, 0.0), WIDE, 1.0, is_hit=False))
    grid.add_reading(Reading(Pose(1.0, 1.0, math.pi), WIDE, 1.0, is_hit=False))
    grid.add_reading(Reading(Pose(1.0, 1.0, math.pi / 2), WIDE, 1.0, is_hit=False))
    grid.add_reading(Reading(Pose(1.0, 1.0, -math.pi / 2), WIDE, 1.0, is_hit=False))
    assert grid.has_clearance(1.0, 1.0)
