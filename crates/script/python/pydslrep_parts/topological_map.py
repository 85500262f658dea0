#: if standalone
"""Maps of places and the ways between them."""

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from .occupancy_grid import Place

#: endif


@dataclass
class Exit:
    """A direction in which a place can be left."""

    bearing: float  # radians, counter-clockwise from the world's x axis
    leads_to: int | None = None  # the node there, or the one nearest to what is there


@dataclass
class Node:
    """A place where a robot has been."""

    number: int
    x: float
    y: float
    exits: list[Exit] = field(default_factory=list)
    ways: dict[int, float] = field(default_factory=dict)  # length by neighbour

    @property
    def place(self) -> Place:
        """Where it is."""
        return self.x, self.y


class TopologicalMap:
    """Nodes are places, edges are drives that were made."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._blocked: set[tuple[int, int]] = set()

    def add(self, x: float, y: float) -> Node:
        """A new node."""
        node = Node(len(self.nodes), x, y)
        self.nodes.append(node)
        return node

    def move(self, node: Node, place: Place) -> None:
        """A node is elsewhere than was thought."""
        node.x, node.y = place
        for number in node.ways:
            other = self.nodes[number]
            node.ways[number] = other.ways[node.number] = math.dist(place, other.place)

    def connect(self, a: Node, b: Node) -> None:
        """An edge that was driven."""
        a.ways[b.number] = b.ways[a.number] = math.dist(a.place, b.place)

    def block(self, a: Node, b: Node) -> None:
        """An edge that cannot be driven any more, though it was."""
        self._blocked |= {(a.number, b.number), (b.number, a.number)}

    def near(self, place: Place, within: float) -> list[Node]:
        """The nodes about a place, the nearest first."""
        found = (
            (math.dist(node.place, place), node.number)
            for node in self.nodes
            if abs(node.x - place[0]) <= within and abs(node.y - place[1]) <= within
        )
        return [self.nodes[number] for away, number in sorted(found) if away <= within]

    def distances(self, start: Node) -> dict[int, float]:
        """How far it is along edges to every node that can be reached."""
        return {number: away for number, (away, _) in self._search(start).items()}

    def path(self, start: Node, end: Node) -> list[Node]:
        """The nodes on the shortest way, without the first; raises KeyError."""
        found = self._search(start)
        path = [end]
        while path[-1] is not start:
            path.append(self.nodes[found[path[-1].number][1]])
        return path[-2::-1]

    def edges(self) -> Iterator[tuple[int, int, float]]:
        """Each edge once: two nodes' numbers, and its length."""
        for node in self.nodes:
            for other, length in sorted(node.ways.items()):
                if node.number < other:
                    yield node.number, other, length

    def as_json(self) -> dict[str, list[dict[str, Any]]]:
        """The map as it is written to a file: metres and degrees."""
        return {
            "nodes": [
                {
                    "id": node.number,
                    "x": round(node.x, 4) + 0.0,  # no -0
                    "y": round(node.y, 4) + 0.0,
                    "exits": [
                        {
                            "bearing": round(math.degrees(way.bearing), 1) + 0.0,
                            "to": way.leads_to,
                        }
                        for way in node.exits
                    ],
                }
                for node in self.nodes
            ],
            "edges": [
                {"from": a, "to": b, "length": round(length, 4)}
                for a, b, length in self.edges()
            ],
        }

    def _search(self, start: Node) -> dict[int, tuple[float, int]]:
        """Distance and the node before, by number (Dijkstra's algorithm)."""
        found: dict[int, tuple[float, int]] = {}
        queue = [(0.0, start.number, start.number)]
        while queue:
            away, number, before = heapq.heappop(queue)
            if number not in found:
                found[number] = away, before
                for other, length in self.nodes[number].ways.items():
                    if (number, other) not in self._blocked:
                        heapq.heappush(queue, (away + length, other, number))
        return found
