"""A topological map: nodes connected by edges."""

import heapq
import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from ..pose import heading_degrees
from .occupancy_grid import Position


@dataclass
class Frontier:
    """A direction in which the robot can leave a node."""

    bearing: float  # radians, counter-clockwise from the world's x axis
    target: int | None = None  # the node it leads to; None while unexplored
    length: float = 1.0  # of the way to its end, in steps


@dataclass
class Node:
    """A position that the robot has visited."""

    number: int
    x: float
    y: float
    frontiers: list[Frontier] = field(default_factory=list)
    neighbours: dict[int, float] = field(default_factory=dict)  # edge length by node
    is_uncertain: bool = False  # whether the robot may have been somewhere else

    @property
    def position(self) -> Position:
        """The node's position."""
        return self.x, self.y


class TopologicalMap:
    """Nodes are visited positions; edges are paths that were driven."""

    DETOUR = 20.0  # m to drive rather than use an edge where an obstacle was
    MAX_BLOCKS = 3  # times that an edge is blocked before it is given up

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._blocked: Counter[frozenset[int]] = Counter()

    def add(self, x: float, y: float) -> Node:
        """Adds a node."""
        node = Node(len(self.nodes), x, y)
        self.nodes.append(node)
        return node

    def move(self, node: Node, position: Position) -> None:
        """Corrects the position of a node."""
        node.x, node.y = position
        for number in node.neighbours:
            other = self.nodes[number]
            node.neighbours[number] = other.neighbours[node.number] = math.dist(
                position, other.position
            )

    def connect(self, a: Node, b: Node) -> None:
        """Adds an edge that was driven."""
        a.neighbours[b.number] = b.neighbours[a.number] = math.dist(
            a.position, b.position
        )

    def block(self, a: Node, b: Node) -> None:
        """Makes an edge a last resort because an obstacle now blocks it.

        The obstacle may go away, or be a wall that the robot hits because it is lost.
        """
        self._blocked[frozenset((a.number, b.number))] += 1

    def nodes_near(self, position: Position, within: float) -> list[Node]:
        """The nodes within a distance, nearest first."""
        found = (
            (math.dist(node.position, position), node.number)
            for node in self.nodes
            if abs(node.x - position[0]) <= within
            and abs(node.y - position[1]) <= within
        )
        return [
            self.nodes[number]
            for distance, number in sorted(found)
            if distance <= within
        ]

    def distances(self, start: Node) -> dict[int, float]:
        """The path length to every reachable node."""
        return {n: distance for n, (distance, _) in self._search(start).items()}

    def path(self, start: Node, end: Node) -> list[Node]:
        """The nodes on the shortest path, without the first; raises KeyError."""
        found = self._search(start)
        path = [end]
        while path[-1] is not start:
            path.append(self.nodes[found[path[-1].number][1]])
        return path[-2::-1]

    def edges(self) -> Iterator[tuple[int, int, float]]:
        """Each edge once: the numbers of its nodes, and its length."""
        for node in self.nodes:
            for other, length in sorted(node.neighbours.items()):
                if node.number < other:
                    yield node.number, other, length

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """The map in its file format: metres and degrees."""
        return {
            "nodes": [
                {
                    "id": node.number,
                    "x": round(node.x, 4) + 0.0,  # no -0
                    "y": round(node.y, 4) + 0.0,
                    "exits": [
                        {
                            "bearing": heading_degrees(frontier.bearing),
                            "to": frontier.target,
                        }
                        for frontier in node.frontiers
                    ],
                    **({"uncertain": True} if node.is_uncertain else {}),
                }
                for node in self.nodes
            ],
            "edges": [
                {"from": a, "to": b, "length": round(length, 4)}
                for a, b, length in self.edges()
            ],
        }

    def _search(self, start: Node) -> dict[int, tuple[float, int]]:
        """The distance and predecessor of each node, by number (Dijkstra)."""
        found: dict[int, tuple[float, int]] = {}
        queue = [(0.0, start.number, start.number)]
        while queue:
            distance, number, before = heapq.heappop(queue)
            if number not in found:
                found[number] = distance, before
                for other, length in self.nodes[number].neighbours.items():
                    blocks = self._blocked[frozenset((number, other))]
                    if blocks < self.MAX_BLOCKS:
                        length += self.DETOUR * blocks
                        heapq.heappush(queue, (distance + length, other, number))
        return found
