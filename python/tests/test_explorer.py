"""Exploration of worlds that it was not tuned for."""

import math
from collections.abc import Callable

import pytest
from ideal_robot import RADIUS, IdealRobot, at_once
from length import few
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.explorer import Explorer, UnboundedAreaError
from pydslrep_runtime.slam.occupancy_grid import OccupancyGrid
from rooms import Pillar, Position, Rooms, Wall, generate

STEP = 0.5


def explore(
    rooms: Rooms, *surprises: Pillar, extent: float = 20.0
) -> tuple[IdealRobot, Explorer]:
    robot = IdealRobot(rooms, OccupancyGrid(RADIUS))
    robot.surprises += surprises
    explorer = Explorer(robot, robot.grid, STEP, math.pi, extent)
    at_once(explorer.explore())
    assert not robot.touched
    for a, b, length in explorer.map.edges():
        ends = explorer.map.nodes[a].position, explorer.map.nodes[b].position
        assert length == pytest.approx(math.dist(*ends))
        assert rooms.is_straight(*ends)
    return robot, explorer


def coverage(rooms: Rooms, explorer: Explorer) -> float:
    nodes = [node.position for node in explorer.map.nodes]
    return rooms.coverage(nodes, STEP + 1.0, grain=0.2)


def two_rooms(door: float) -> Rooms:
    """Side by side, with a door between them."""
    rooms = Rooms(4.0, 2.5, start=(0.6, 0.5))
    rooms.walls = [
        Wall((2.0, 0.0), (2.0, 1.1)),
        Wall((2.0, 1.1 + door), (2.0, 2.5)),
    ]
    return rooms


@pytest.mark.parametrize("seed", few(1, (14, 3)))
def test_generated_rooms(seed: int) -> None:
    rooms = generate(seed)
    _, explorer = explore(rooms)
    assert coverage(rooms, explorer) >= 0.95


def test_a_door_is_passed_if_the_robot_fits() -> None:
    rooms = two_rooms(0.75)
    _, explorer = explore(rooms)
    assert coverage(rooms, explorer) > 0.99
    narrow = two_rooms(0.35)
    _, explorer = explore(narrow)
    assert max(node.x for node in explorer.map.nodes) < 2.0


@pytest.mark.parametrize(
    ("low", "start"), few(1, [(1.1, 0.6), (0.5, 0.5), (1.37, 0.7)])
)
def test_a_narrow_door_is_found_from_nodes_beside_it(low: float, start: float) -> None:
    # A robot that is unsure of its pose keeps 5 cm more: few ways lead through.
    rooms = Rooms(4.0, 2.5, start=(start, 0.5))
    rooms.walls = [Wall((2.0, 0.0), (2.0, low)), Wall((2.0, low + 0.74), (2.0, 2.5))]
    robot = IdealRobot(rooms, OccupancyGrid(RADIUS + 0.05))
    explorer = Explorer(robot, robot.grid, STEP, math.pi, 20.0, prefers_walls=True)
    at_once(explorer.explore())
    assert not robot.touched
    assert coverage(rooms, explorer) > 0.99


def test_a_loop_is_closed_by_an_edge() -> None:
    rooms = Rooms(3.0, 3.0, start=(0.5, 0.5))
    rooms.walls = [Wall((1.0, y), (2.0, y)) for y in (1.05, 1.5, 1.95)]
    rooms.walls += [Wall((x, 1.0), (x, 2.0)) for x in (1.05, 1.95)]
    _, explorer = explore(rooms)
    edges = list(explorer.map.edges())
    assert len(edges) >= len(explorer.map.nodes)
    # Around the block, two paths of similar length lead to the opposite corner.
    corner = explorer.map.nodes_near((2.5, 2.5), 0.4)[0]
    way = explorer.map.path(explorer.map.nodes[0], corner)
    explorer.map.block(way[0], way[1])
    assert corner.number in explorer.map.distances(explorer.map.nodes[0])


def test_every_frontier_has_a_target_in_the_end() -> None:
    _, explorer = explore(two_rooms(0.9))
    count = len(explorer.map.nodes)
    frontiers = [way for node in explorer.map.nodes for way in node.frontiers]
    assert frontiers
    assert all(way.target in range(count) for way in frontiers)


def test_an_obstacle_blocks_one_path_only() -> None:
    rooms = two_rooms(0.9)
    _, without = explore(rooms)
    # In the middle of the first room, unknown until the robot is near.
    _, explorer = explore(rooms, Pillar((1.3, 1.6), 0.05))
    assert coverage(rooms, explorer) >= 0.95
    assert all(
        math.dist(node.position, (1.3, 1.6)) > RADIUS for node in explorer.map.nodes
    )
    assert len(explorer.map.nodes) < 2 * len(without.map.nodes)


class Kidnapped(IdealRobot):
    """Is somewhere else after a scan, once, and knows it."""

    def __init__(self, rooms: Rooms, number: int, to: Position) -> None:
        super().__init__(rooms, OccupancyGrid(RADIUS))
        self.number, self.to = number, to

    async def localise(self) -> int:
        if len(self.positions) == self.number:
            self.here = Pose(*self.to, self.here.theta)
            self.look()
        return await super().localise()

    def uncertain(self) -> tuple[int, ...]:
        return (self.number,)


@pytest.mark.parametrize("number", [22, 28, 34])
def test_a_robot_that_was_lost_goes_on_where_it_is(number: int) -> None:
    rooms = two_rooms(0.9)
    robot = Kidnapped(rooms, number, rooms.start)
    explorer = Explorer(robot, robot.grid, STEP, math.pi, 20.0)
    at_once(explorer.explore())
    assert not robot.touched
    assert coverage(rooms, explorer) >= 0.95
    nodes = explorer.map.nodes
    for a, b, _ in explorer.map.edges():
        assert rooms.is_straight(nodes[a].position, nodes[b].position)


class Mistaken(IdealRobot):
    """Mistakes a door for an obstacle, twice."""

    missed = 0

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        if self.missed < 2 and (self.here.x < 2.0) != (goal[0] < 2.0):
            self.missed += 1
            return False
        return await super().drive_to(goal, should_stop)


@pytest.mark.parametrize("prefers_walls", [True, False])
def test_a_robot_that_localises_by_walls_tries_a_door_again(
    prefers_walls: bool,
) -> None:
    rooms = two_rooms(0.9)
    robot = Mistaken(rooms, OccupancyGrid(RADIUS))
    explorer = Explorer(
        robot, robot.grid, STEP, math.pi, 20.0, prefers_walls=prefers_walls
    )
    at_once(explorer.explore())
    assert robot.missed
    assert (coverage(rooms, explorer) >= 0.95) == prefers_walls


class Misled(IdealRobot):
    """Is stopped by a wall in which its grid has holes."""

    def __init__(self, rooms: Rooms) -> None:
        super().__init__(rooms, OccupancyGrid(RADIUS))
        self.bumps: list[Position] = []

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        if self.here.x < 2.0 < goal[0] + RADIUS:
            dx, dy = goal[0] - self.here.x, goal[1] - self.here.y
            heading = math.atan2(dy, dx)
            way = (2.0 - RADIUS - self.here.x) / math.cos(heading)
            self.here = Pose(self.here.x, self.here.y, heading).ahead(way)
            bump = self.here.ahead(RADIUS)
            self.bumps.append((bump.x, bump.y))
            return False
        return await super().drive_to(goal, should_stop)


def test_a_robot_gives_up_a_wall_that_it_keeps_bumping_into() -> None:
    # Without its wall, the grid shows a second room.
    robot = Misled(Rooms(4.0, 2.5, start=(0.6, 0.5)))
    explorer = Explorer(robot, robot.grid, STEP, math.pi, 20.0, prefers_walls=True)
    at_once(explorer.explore())
    for place in robot.bumps:
        assert sum(math.dist(place, bump) < 0.1 for bump in robot.bumps) <= 5
    assert robot.bumps
    frontiers = [way for node in explorer.map.nodes for way in node.frontiers]
    assert all(way.target is not None for way in frontiers)


def test_a_closet_gives_a_map_of_one_node() -> None:
    _, explorer = explore(Rooms(0.7, 0.7, start=(0.35, 0.35)))
    assert len(explorer.map.nodes) == 1
    assert not explorer.map.nodes[0].frontiers


def test_too_many_nodes_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Explorer, "MAX_NODES", 20)
    with pytest.raises(UnboundedAreaError, match="still open after 20 nodes"):
        explore(Rooms(50.0, 50.0, start=(25.0, 25.0)), extent=30.0)


def test_an_area_beyond_the_extent_is_an_error() -> None:
    message = r"still open 3\.\d m from the start.* set --extent to more than 3 m"
    with pytest.raises(UnboundedAreaError, match=message):
        explore(Rooms(50.0, 50.0, start=(25.0, 25.0)), extent=3.0)
    explore(Rooms(3.0, 1.0, start=(0.5, 0.5)), extent=3.0)


def test_a_robot_that_needs_walls_explores_open_space_last() -> None:
    rooms = Rooms(3.6, 3.6, start=(0.5, 0.5))
    robot = IdealRobot(rooms, OccupancyGrid(RADIUS))
    explorer = Explorer(robot, robot.grid, STEP, math.pi, 20.0, prefers_walls=True)
    at_once(explorer.explore())
    assert coverage(rooms, explorer) > 0.99

    def to_wall(position: tuple[float, float]) -> float:
        return min(*position, 3.6 - position[0], 3.6 - position[1])

    ways = [to_wall(node.position) for node in explorer.map.nodes]
    half = len(ways) // 2
    assert max(ways) > 1.2
    assert sum(ways[:half]) < 0.7 * sum(ways[half:])


def test_the_same_world_is_explored_the_same_way() -> None:
    first, second = (explore(two_rooms(0.8))[1].map.as_json() for _ in range(2))
    assert first == second
