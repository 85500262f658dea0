#: if standalone
"""Exploring: where to go next, until there is nowhere left."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from .occupancy_grid import Floor, Place
from .pose import Pose, wrap_angle
from .topological_map import Exit, Node, TopologicalMap

#: endif


class Rover(Protocol):
    """What exploring needs of a robot, which shows its floor what it sees on the way."""

    def pose(self) -> Pose:
        """Where it is."""

    def turn_by(self, angle: float) -> None:
        """Turns in place, to the left where positive."""

    def localise(self) -> int:
        """Makes sure of where it is, if it has to; the number of this place."""

    def place(self, number: int) -> Place:
        """Where a place is, as far as is known by now."""

    def drive_to(self, goal: Place, is_enough: Callable[[], bool]) -> bool:
        """Turns to a place and drives there; whether it arrived, or something came near.

        Where `is_enough` says so it stops before, which is as good as arriving.
        """

    def retreat_to(self, goal: Place) -> None:
        """Drives back the way it came."""


class NoEndError(Exception):
    """There seems to be no end to what can be explored; says what was found so far."""


@dataclass(frozen=True)
class Way:
    """Where to go next: by an exit of a node to a new place, or to a known one."""

    node: Node
    exit: Exit
    goal: Place
    known: Node | None = None


class Explorer:
    """Explores by topology.

    Nodes are places, edges are drives that were made. The directions in which a node has
    room for a step are its exits; one is unexplored while no node is near its end.
    """

    DIRECTIONS = 24  # that are tried at a node
    MOST_NODES = 1000  # that a closed area can be thought to have

    def __init__(
        self,
        rover: Rover,
        floor: Floor,
        step: float,
        blind: float,
        extent: float,
        *,
        keeps_to_walls: bool = False,
    ) -> None:
        """`step` is the length of an edge, `blind` the angle that no sensor looks at.

        A closed area ends less than `extent` away from where exploring starts, in metres.
        """
        self.map = TopologicalMap()
        self._rover, self._floor = rover, floor
        self._step, self._blind, self._extent = step, blind, extent
        # A robot that needs walls to know where it is goes into the open last, metres.
        self._shyness = 4.0 * step if keeps_to_walls else 0.0
        self._spacing = 0.8 * step  # nearer to a node, a place is the same
        self._sure = (
            1.5 * step
        )  # to be driven without making sure of where the robot is
        self._loop = 4.0 * step  # a known way of this length is worth a shorter one
        self._numbers: list[int] = []  # of the nodes' places, as the rover counts them
        self._dead: set[tuple[int, int]] = set()  # node and direction: something came

    def explore(self) -> None:
        """Explores until no exit is left; raises NoEndError."""
        self._here = self._settle()
        while way := self._nearest_way():
            if self._travel(way.node):
                self._leave(way)

    def _nearest_way(self) -> Way | None:
        """The unexplored exit with the shortest way to it; straight ahead, if it can be."""
        distances = self.map.distances(self._here)
        heading = self._rover.pose().theta
        best, least = None, math.inf
        for number, away in distances.items():
            if away >= least:
                continue
            node = self.map.nodes[number]
            for exit_ in node.exits:
                if exit_.leads_to is not None:
                    continue
                turn = abs(wrap_angle(exit_.bearing - heading)) if not away else 0.0
                cost = away + 0.1 * self._step * turn
                if cost < least and self._shyness:
                    goal = self._end(node, exit_.bearing)
                    cost += self._shyness * self._floor.is_bare(goal)
                if cost < least and (way := self._way(node, exit_)):
                    best, least = way, cost
        return best

    def _way(self, node: Node, exit_: Exit) -> Way | None:
        """What there is to explore by an exit; it leads to a known node where nothing."""
        goal = self._end(node, exit_.bearing)
        for known in self.map.near(goal, self._spacing):
            if known is node or not self._floor.is_open(goal, known.place):
                continue
            if self._is_shortcut(node, known):
                return Way(node, exit_, known.place, known)
            exit_.leads_to = known.number
            return None
        return Way(node, exit_, goal)

    def _is_shortcut(self, node: Node, known: Node) -> bool:
        """Whether driving to a known node closes a loop."""
        distance = self.map.distances(node).get(known.number, math.inf)
        return distance > self._loop and self._floor.is_open(node.place, known.place)

    def _travel(self, node: Node) -> bool:
        """Drives by known edges; whether it arrived."""
        unsure = 0.0
        for following in self.map.path(self._here, node):
            unsure += self._here.ways[following.number]
            if not self._rover.drive_to(following.place, lambda: False):
                self._rover.retreat_to(self._here.place)
                self.map.block(self._here, following)
                return False
            self._here = following
            if unsure > self._sure or following is node:
                self._localise()
                unsure = 0.0
        return True

    def _leave(self, way: Way) -> None:
        """Drives by an exit."""
        node = way.node
        is_enough = self._exits_change(way) if way.known is None else lambda: False
        if not self._rover.drive_to(way.goal, is_enough):
            # Whatever is there now, this is no exit any more.
            self._rover.retreat_to(node.place)
            node.exits.remove(way.exit)
            self._dead.add((node.number, self._direction(way.exit.bearing)))
            return
        if way.known:
            self._localise()
        self._here = way.known or self._settle()
        self.map.connect(node, self._here)
        way.exit.leads_to = self._here.number

    def _exits_change(self, way: Way) -> Callable[[], bool]:
        """Tells where a side opens: a place with other exits than the one before."""
        sides = (math.pi / 2.0, -math.pi / 2.0)

        def are_open(pose: Pose) -> list[bool]:
            ends = (pose.turned(side).ahead(self._step) for side in sides)
            start = pose.x, pose.y
            return [self._floor.is_open(start, (end.x, end.y)) for end in ends]

        before = are_open(Pose(way.node.x, way.node.y, way.exit.bearing))

        def is_enough() -> bool:
            here = self._rover.pose()
            if math.dist((here.x, here.y), way.node.place) < 0.5 * self._step:
                return False
            return any(
                now and not was for now, was in zip(are_open(here), before, strict=True)
            )

        return is_enough

    def _settle(self) -> Node:
        """Makes a node here, and finds its exits and what is new about those near it."""
        number = self._localise()
        here = Pose(*self._rover.place(number), 0.0)
        node = self.map.add(here.x, here.y)
        self._numbers.append(number)
        self._floor.stand(here.x, here.y)
        self._check_end(node)
        self._look_around(node)
        for near in self.map.near(node.place, 4.0 * self._step):
            self._find_exits(near)
        return node

    def _check_end(self, node: Node) -> None:
        """Raises NoEndError where the area seems to be open."""
        away = math.dist(node.place, self.map.nodes[0].place)
        if away > self._extent:
            raise NoEndError(
                f"got {away:.1f} m away from its start without an end: is the area closed? "
                f"If it is that large, say --extent with more than {self._extent:g} m"
            )
        if len(self.map.nodes) >= self.MOST_NODES:
            raise NoEndError(
                f"found {len(self.map.nodes)} places and no end: is the area closed?"
            )

    def _localise(self) -> int:
        """Makes sure of where the robot is, and of where the nodes are by that."""
        number = self._rover.localise()
        for node, own in zip(self.map.nodes, self._numbers, strict=True):
            if (place := self._rover.place(own)) != node.place:
                self.map.move(node, place)
        return number

    def _look_around(self, node: Node) -> None:
        """Turns until all about a node was seen, to the side where less is missing."""
        turned, side = 0.0, 1.0
        while turned < self._blind and (missing := self._undecided(node)):
            if turned == 0.0:
                heading = self._rover.pose().theta
                left = sum(wrap_angle(bearing - heading) > 0.0 for bearing in missing)
                side = 1.0 if 2 * left >= len(missing) else -1.0
            angle = min(self._blind - turned, math.pi / 6.0)
            self._rover.turn_by(side * angle)
            turned += angle
        self._floor.stand(node.x, node.y)

    def _undecided(self, node: Node) -> list[float]:
        """The directions in which nobody has looked yet."""
        return [
            bearing
            for bearing in self._bearings()
            if self._floor.is_undecided(node.place, self._end(node, bearing))
        ]

    def _find_exits(self, node: Node) -> None:
        """Sees which directions are open by now; what is known of exits stays."""
        known = {self._direction(way.bearing): way for way in node.exits}
        for bearing in self._open_bearings(node):
            direction = self._direction(bearing)
            if direction not in known and (node.number, direction) not in self._dead:
                node.exits.append(Exit(bearing))

    def _open_bearings(self, node: Node) -> list[float]:
        """The middle of each open range of directions; wide ones have several."""
        bearings = self._bearings()
        is_open = [
            self._floor.is_open(node.place, self._end(node, bearing))
            for bearing in bearings
        ]
        if all(is_open):
            return bearings[:: self.DIRECTIONS // 8]
        found: list[float] = []
        first = is_open.index(False)
        run: list[int] = []
        for index in range(first, first + self.DIRECTIONS + 1):
            if is_open[index % self.DIRECTIONS]:
                run.append(index)
            elif run:
                count = 1 + (len(run) - 1) * 8 // self.DIRECTIONS
                for part in range(count):
                    share = 0.5 if count == 1 else part / (count - 1)
                    at = run[round(share * (len(run) - 1))]
                    found.append(bearings[at % self.DIRECTIONS])
                run = []
        return found

    def _bearings(self) -> list[float]:
        return [
            wrap_angle(index * math.tau / self.DIRECTIONS)
            for index in range(self.DIRECTIONS)
        ]

    def _direction(self, bearing: float) -> int:
        return round(bearing / math.tau * self.DIRECTIONS) % self.DIRECTIONS

    def _end(self, node: Node, bearing: float) -> Place:
        end = Pose(node.x, node.y, bearing).ahead(self._step)
        return end.x, end.y
