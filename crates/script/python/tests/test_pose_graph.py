import math

import pytest
from pydslrep_parts.pose import Pose
from pydslrep_parts.pose_graph import Compass, Link, PoseGraph
from pydslrep_parts.scan_matching import Matrix

SIDE = Pose(
    1.0, 0.0, math.pi / 2.0
)  # of a square: ahead, then a quarter turn to the left


def information(place: float, heading: float) -> Matrix:
    return [
        [1.0 / place**2, 0.0, 0.0],
        [0.0, 1.0 / place**2, 0.0],
        [0.0, 0.0, 1.0 / heading**2],
    ]


def chain(count: int, step: Pose) -> PoseGraph:
    """Places one after the other, as the wheels have them."""
    graph = PoseGraph()
    here = Pose(0.0, 0.0, 0.0)
    graph.add(here)
    for number in range(1, count):
        here = step.placed_on(here)
        graph.add(here)
        sure = information(0.05, 0.1)
        graph.link(Link(number - 1, number, step, sure, is_certain=True))
    return graph


def test_what_agrees_stays() -> None:
    graph = chain(5, SIDE)
    before = list(graph.poses)
    assert graph.closes([Link(0, 4, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))])
    for pose, was in zip(graph.poses, before, strict=True):
        assert (pose.x, pose.y) == pytest.approx((was.x, was.y), abs=1e-6)


def test_an_error_is_spread_over_the_loop() -> None:
    # The wheels made each side 4 % too long and each turn 3 degrees too wide.
    graph = chain(5, Pose(1.04, 0.0, math.radians(93.0)))
    off = math.hypot(graph.poses[4].x, graph.poses[4].y)
    assert graph.closes([Link(0, 4, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))])
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
    assert graph.closes([Link(0, 60, Pose(0.0, 0.0, 0.0), information(0.01, 0.01))])
    assert math.hypot(graph.poses[60].x, graph.poses[60].y) < 0.02
    radius = 0.5 * 60.0 / math.tau
    for pose in graph.poses:
        away = math.hypot(
            pose.x - graph.poses[30].x / 2, pose.y - graph.poses[30].y / 2
        )
        assert away == pytest.approx(radius, abs=0.1)


def test_a_loop_that_cannot_be_is_none() -> None:
    graph = chain(5, SIDE)
    before = list(graph.poses)
    assert not graph.closes([Link(0, 4, Pose(2.0, 0.0, 0.0), information(0.01, 0.01))])
    assert graph.poses == before
    graph.relax()
    assert math.hypot(graph.poses[4].x, graph.poses[4].y) < 1e-6


def test_a_compass_straightens_a_way() -> None:
    graph = chain(11, Pose(0.5, 0.0, 0.05))
    assert graph.poses[10].y > 1.0
    for place in range(1, 11):
        graph.orient(Compass(place, 0.0, 1.0 / 0.01**2))
    graph.relax()
    assert abs(graph.poses[10].y) < 0.05
    assert graph.poses[10].x == pytest.approx(5.0, abs=0.02)


def test_places_hang_together_by_links_among_them() -> None:
    graph = chain(5, SIDE)
    assert graph.components([0, 1, 3, 4]) == [[0, 1], [3, 4]]
    assert graph.components([4, 3, 2, 1]) == [[1, 2, 3, 4]]
