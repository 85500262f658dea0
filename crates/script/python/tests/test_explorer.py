"""Exploring worlds that nobody tuned it to."""

import math

import pytest
from ideal_rover import RADIUS, GhostRover
from pydslrep_parts.explorer import Explorer, NoEndError
from pydslrep_parts.occupancy_grid import Floor
from rooms import Pillar, Rooms, Wall, generate

STEP = 0.5


def explore(
    rooms: Rooms, *surprises: Pillar, extent: float = 20.0
) -> tuple[GhostRover, Explorer]:
    rover = GhostRover(rooms, Floor(RADIUS))
    rover.surprises += surprises
    explorer = Explorer(rover, rover.floor, STEP, math.pi, extent)
    explorer.explore()
    assert not rover.touched
    for a, b, length in explorer.map.edges():
        ends = explorer.map.nodes[a].place, explorer.map.nodes[b].place
        assert length == pytest.approx(math.dist(*ends))
        assert rooms.is_straight(*ends)
    return rover, explorer


def coverage(rooms: Rooms, explorer: Explorer) -> float:
    nodes = [node.place for node in explorer.map.nodes]
    return rooms.coverage(nodes, STEP + 1.0, grain=0.2)


def two_rooms(door: float) -> Rooms:
    """Side by side, with a door between them."""
    rooms = Rooms(4.0, 2.5, start=(0.6, 0.5))
    rooms.walls = [
        Wall((2.0, 0.0), (2.0, 1.1)),
        Wall((2.0, 1.1 + door), (2.0, 2.5)),
    ]
    return rooms


@pytest.mark.parametrize("seed", [3, 14])
def test_generated_rooms(seed: int) -> None:
    rooms = generate(seed)
    _, explorer = explore(rooms)
    assert coverage(rooms, explorer) >= 0.95


def test_a_door_is_gone_through_where_the_robot_fits() -> None:
    rooms = two_rooms(0.75)
    _, explorer = explore(rooms)
    assert coverage(rooms, explorer) > 0.99
    narrow = two_rooms(0.35)
    _, explorer = explore(narrow)
    assert max(node.x for node in explorer.map.nodes) < 2.0


def test_a_loop_is_closed_by_an_edge() -> None:
    rooms = Rooms(3.0, 3.0, start=(0.5, 0.5))
    rooms.walls = [Wall((1.0, y), (2.0, y)) for y in (1.05, 1.5, 1.95)]
    rooms.walls += [Wall((x, 1.0), (x, 2.0)) for x in (1.05, 1.95)]
    _, explorer = explore(rooms)
    edges = list(explorer.map.edges())
    assert len(edges) >= len(explorer.map.nodes)
    # All about it there are two ways to the opposite corner, about as long.
    corner = explorer.map.near((2.5, 2.5), 0.4)[0]
    way = explorer.map.path(explorer.map.nodes[0], corner)
    explorer.map.block(way[0], way[1])
    assert corner.number in explorer.map.distances(explorer.map.nodes[0])


def test_every_exit_leads_somewhere_in_the_end() -> None:
    _, explorer = explore(two_rooms(0.9))
    count = len(explorer.map.nodes)
    exits = [way for node in explorer.map.nodes for way in node.exits]
    assert exits
    assert all(way.leads_to in range(count) for way in exits)


def test_what_comes_near_closes_a_way_and_nothing_else() -> None:
    rooms = two_rooms(0.9)
    _, without = explore(rooms)
    # In the middle of the first room, where nothing was seen before.
    _, explorer = explore(rooms, Pillar((1.3, 1.6), 0.05))
    assert coverage(rooms, explorer) >= 0.95
    assert all(
        math.dist(node.place, (1.3, 1.6)) > RADIUS for node in explorer.map.nodes
    )
    assert len(explorer.map.nodes) < 2 * len(without.map.nodes)


def test_a_place_without_exits_is_a_map_of_one_node() -> None:
    _, explorer = explore(Rooms(0.7, 0.7, start=(0.35, 0.35)))
    assert len(explorer.map.nodes) == 1
    assert not explorer.map.nodes[0].exits


def test_no_end_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Explorer, "MOST_NODES", 20)
    with pytest.raises(NoEndError, match="found 20 places and no end"):
        explore(Rooms(50.0, 50.0, start=(25.0, 25.0)), extent=30.0)


def test_what_is_too_far_away_is_no_closed_area() -> None:
    message = r"got 3\.\d m away .* say --extent with more than 3 m"
    with pytest.raises(NoEndError, match=message):
        explore(Rooms(50.0, 50.0, start=(25.0, 25.0)), extent=3.0)
    explore(Rooms(3.0, 1.0, start=(0.5, 0.5)), extent=3.0)


def test_who_needs_walls_goes_into_the_open_last() -> None:
    rooms = Rooms(4.4, 4.4, start=(0.5, 0.5))
    rover = GhostRover(rooms, Floor(RADIUS))
    explorer = Explorer(rover, rover.floor, STEP, math.pi, 20.0, keeps_to_walls=True)
    explorer.explore()
    assert coverage(rooms, explorer) > 0.99

    def to_wall(place: tuple[float, float]) -> float:
        return min(*place, 4.4 - place[0], 4.4 - place[1])

    ways = [to_wall(node.place) for node in explorer.map.nodes]
    half = len(ways) // 2
    assert max(ways) > 1.5
    assert sum(ways[:half]) < 0.7 * sum(ways[half:])


def test_the_same_world_is_explored_the_same_way() -> None:
    first, second = (explore(two_rooms(0.8))[1].map.as_json() for _ in range(2))
    assert first == second
