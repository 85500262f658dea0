import itertools

import pytest
from pydslrep_runtime.slam.topological_map import Frontier, TopologicalMap


def ring() -> TopologicalMap:
    """Four corners of a 1 m square, without an edge from the last to the first."""
    found = TopologicalMap()
    corners = [found.add(x, y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for a, b in itertools.pairwise(corners):
        found.connect(a, b)
    return found


def test_the_shortest_path_follows_edges() -> None:
    found = ring()
    first, *_, last = found.nodes
    assert found.distances(first) == {0: 0.0, 1: 1.0, 2: 2.0, 3: 3.0}
    assert [node.number for node in found.path(first, last)] == [1, 2, 3]
    assert found.path(first, first) == []
    found.connect(last, first)
    assert [node.number for node in found.path(first, last)] == [3]


def test_a_blocked_edge_is_a_last_resort() -> None:
    found = ring()
    found.block(found.nodes[1], found.nodes[2])
    assert found.distances(found.nodes[0])[3] == 3.0 + found.DETOUR
    found.connect(found.nodes[3], found.nodes[0])
    assert [node.number for node in found.path(*found.nodes[1:3])] == [0, 3, 2]


def test_an_edge_that_is_always_blocked_stays_in_the_map_but_not_in_paths() -> None:
    found = ring()
    for _ in range(found.MAX_BLOCKS):
        found.block(found.nodes[2], found.nodes[1])
    assert found.distances(found.nodes[0]) == {0: 0.0, 1: 1.0}
    assert len(list(found.edges())) == 3
    with pytest.raises(KeyError):
        found.path(found.nodes[0], found.nodes[3])


def test_the_nearest_nodes_come_first() -> None:
    found = ring()
    assert [node.number for node in found.nodes_near((0.9, 0.3), 1.0)] == [1, 2, 0]
    assert found.nodes_near((5.0, 5.0), 1.0) == []


def test_as_json() -> None:
    found = ring()
    found.nodes[0].frontiers.append(Frontier(-1.5707963, 1))
    data = found.as_json()
    assert data["nodes"][0] == {
        "id": 0,
        "x": 0.0,
        "y": 0.0,
        "exits": [{"bearing": -90.0, "to": 1}],
    }
    found.nodes[2].is_uncertain = True
    assert found.as_json()["nodes"][2]["uncertain"] is True
    assert data["edges"][0] == {"from": 0, "to": 1, "length": 1.0}
