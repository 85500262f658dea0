import math

import numpy as np
import pytest
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.odometry.pose_graph import Constraint, PoseGraph
from pydslrep_runtime.slam.odometry.poses import Array

SIDE = Pose(
    1.0, 0.0, math.pi / 2.0
)  # of a square: ahead, then a quarter turn to the left


def information(position: float, heading: float) -> Array:
    return np.diag(np.array([position, position, heading]) ** -2)


def chain(count: int, step: Pose) -> PoseGraph:
    """Poses one after the other, connected by odometry."""
    graph = PoseGraph()
    here = Pose(0.0, 0.0, 0.0)
    graph.add(here)
    for number in range(1, count):
        here = step.transformed_by(here)
        graph.add(here)
        sure = information(0.05, 0.1)
        graph.add_constraint(
            Constraint(number - 1, number, step, sure, is_odometry=True)
        )
    return graph


def test_consistent_poses_stay() -> None:
    graph = chain(5, SIDE)
    before = list(graph.poses)
    assert graph.try_loop_closure(
        [Constraint(0, 4, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))]
    )
    for pose, was in zip(graph.poses, before, strict=True):
        assert (pose.x, pose.y) == pytest.approx((was.x, was.y), abs=1e-6)


def test_an_error_is_spread_over_the_loop() -> None:
    # Odometry: each side is 4 % too long, each turn 3 degrees too wide.
    graph = chain(5, Pose(1.04, 0.0, math.radians(93.0)))
    off = math.hypot(graph.poses[4].x, graph.poses[4].y)
    assert graph.try_loop_closure(
        [Constraint(0, 4, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))]
    )
    assert math.hypot(graph.poses[0].x, graph.poses[0].y) < 1e-6
    assert off > 0.1
    assert math.hypot(graph.poses[4].x, graph.poses[4].y) < 0.01
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    for pose, corner in zip(graph.poses, corners, strict=False):
        assert math.dist((pose.x, pose.y), corner) < 0.06


def test_a_long_loop_closes() -> None:
    step = Pose(0.5, 0.0, math.tau / 60.0 + 0.003)
    graph = chain(61, step)
    assert math.hypot(graph.poses[60].x, graph.poses[60].y) > 0.3
    assert graph.try_loop_closure(
        [Constraint(0, 60, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))]
    )
    assert math.hypot(graph.poses[60].x, graph.poses[60].y) < 0.02
    radius = 0.5 * 60.0 / math.tau
    for pose in graph.poses:
        away = math.hypot(
            pose.x - graph.poses[30].x / 2, pose.y - graph.poses[30].y / 2
        )
        assert away == pytest.approx(radius, abs=0.1)


def test_an_impossible_loop_is_rejected() -> None:
    graph = chain(5, SIDE)
    before = list(graph.poses)
    assert not graph.try_loop_closure(
        [Constraint(0, 4, Pose(2.0, 0.0, 0.0), information(0.01, 0.01))]
    )
    assert graph.poses == before
    graph.optimise()
    assert math.hypot(graph.poses[4].x, graph.poses[4].y) < 1e-6


def test_loops_close_after_a_push() -> None:
    graph = chain(6, SIDE)
    # By its scans, the robot has not moved from 0 to 1, which odometry did not notice.
    scans = Constraint(0, 1, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))
    graph.add_constraint(scans)
    graph.optimise()
    loop = Constraint(1, 5, Pose(0.03, 0.0, 0.0), information(0.01, 0.01))
    assert graph.try_loop_closure([loop])


def test_headings_straighten_a_path() -> None:
    graph = chain(11, Pose(0.5, 0.0, 0.05))
    assert graph.poses[10].y > 1.0
    for position in range(1, 11):
        graph.add_heading(position, 0.0, 0.01)
    graph.optimise()
    assert abs(graph.poses[10].y) < 0.05
    assert graph.poses[10].x == pytest.approx(5.0, abs=0.02)


def test_components_are_connected_by_constraints() -> None:
    graph = chain(5, SIDE)
    assert graph.connected_components([0, 1, 3, 4]) == [[0, 1], [3, 4]]
    assert graph.connected_components([4, 3, 2, 1]) == [[1, 2, 3, 4]]
