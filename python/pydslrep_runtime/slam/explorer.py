"""Exploration: chooses where to go next until no frontier is left."""

import itertools
import math
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from typing import Protocol

from ..pose import Pose, wrap_angle
from .occupancy_grid import OccupancyGrid, Position
from .topological_map import Frontier, Node, TopologicalMap

# A closer look, if no frontier is left: lengths in steps, m from a node that is new, and steps
# from the nearest node, without an obstacle between, where something may be unseen.
CLOSE_LENGTHS = 1.0, 0.8, 0.6
CLOSE = 0.15
FAR_STEPS = 2.0


class ExplorerRobot(Protocol):
    """The robot as the explorer uses it; updates the occupancy grid as it moves."""

    def pose(self) -> Pose:
        """The estimated pose."""

    async def turn_by(self, angle: float) -> None:
        """Turns in place, to the left if positive."""

    async def localise(self) -> int:
        """Corrects the estimated pose and returns the number of a new keyframe."""

    def position(self, number: int) -> Position:
        """The current estimate of a keyframe's position."""

    def uncertain(self) -> Collection[int]:
        """The keyframes that may be somewhere else, because the robot was lost."""

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        """Turns to a goal and drives there; returns False if an obstacle blocks it.

        Stops early once `should_stop` returns True, which counts as arriving.
        """

    async def back_up_to(self, goal: Position) -> None:
        """Reverses to a position behind the robot."""


class UnboundedAreaError(Exception):
    """The area seems to be unbounded."""


@dataclass(frozen=True)
class Target:
    """Where to go next: through a node's frontier, to a new or a known node."""

    node: Node
    frontier: Frontier
    goal: Position
    known_node: Node | None = None


class Explorer:
    """Explores an area and builds its topological map.

    A node's frontiers are the directions in which the robot has room for one step. A
    frontier is unexplored until a node is near its end.
    """

    BEARINGS = 24  # that are tested at a node
    MAX_NODES = 1000  # of a closed area

    def __init__(
        self,
        robot: ExplorerRobot,
        grid: OccupancyGrid,
        step: float,
        blind_angle: float,
        extent: float,
        *,
        prefers_walls: bool = False,
    ) -> None:
        """`step` is the length of an edge, `blind_angle` the widest gap between sensors.

        `extent` limits the distance from the start, in metres.
        """
        self.map = TopologicalMap()
        self.on_node: Callable[[], object] = lambda: None  # when the map has grown
        self._robot, self._grid = robot, grid
        self._step, self._blind_angle, self._extent = step, blind_angle, extent
        # In metres: a robot that localises by walls explores open space last.
        self._open_space_cost = 4.0 * step if prefers_walls else 0.0
        self._spacing = 0.8 * step  # a position nearer to a node belongs to that node
        self._max_unlocalised = 1.5 * step  # to drive without localising
        self._min_loop = 4.0 * step  # a shortcut must save a path of this length
        self._keyframes: list[int] = []  # the robot's keyframe of each node
        # A robot that localises by walls may miss a door, and try it again in the end.
        self._max_attempts = 3 if prefers_walls else 1
        self._blocks: Counter[tuple[int, int]] = Counter()  # by node and bearing index
        # Where obstacles have stopped it. Its grid may have a hole in a wall there, as wide
        # as its pose is off: from each node nearby, that looks like another way through.
        self._bumps: list[Position] = []
        self._max_bumps = 4 if prefers_walls else math.inf
        self._looks_closely = prefers_walls
        self._looked_at: set[tuple[int, float]] = set()  # nodes and bearings

    async def explore(self) -> None:
        """Explores until no frontier is left; raises UnboundedAreaError."""
        self._here = await self._add_node()
        while target := self._nearest_target() or self._overlooked_target():
            if await self._travel_to(target.node):
                await self._explore_frontier(target)
        for node in self.map.nodes:
            node.frontiers = [
                frontier
                for frontier in node.frontiers
                if frontier.target is not None or not self._is_given_up(node, frontier)
            ]

    def _nearest_target(self) -> Target | None:
        """The unexplored frontier with the shortest path, preferably straight ahead."""
        distances = self.map.distances(self._here)
        heading = self._robot.pose().theta
        best, least = None, math.inf
        for number, distance in distances.items():
            if distance >= least:
                continue
            node = self.map.nodes[number]
            for frontier in node.frontiers:
                if frontier.target is not None:
                    continue
                is_here = not distance
                turn = abs(wrap_angle(frontier.bearing - heading)) if is_here else 0.0
                blocks = self._blocks[
                    node.number, self._bearing_index(frontier.bearing)
                ]
                cost = distance + 0.1 * self._step * turn + self.map.DETOUR * blocks
                if cost < least and self._open_space_cost:
                    goal = self._endpoint(node, frontier.bearing, frontier.length)
                    cost += self._open_space_cost * self._grid.is_featureless(goal)
                if cost >= least or self._is_given_up(node, frontier):
                    continue
                if target := self._target(node, frontier):
                    best, least = target, cost
        return best

    def _is_given_up(self, node: Node, frontier: Frontier) -> bool:
        """Whether obstacles have stopped the robot too often on the way."""
        return self._bumps_ahead(node, frontier) >= self._max_bumps

    def _bumps_ahead(self, node: Node, frontier: Frontier) -> int:
        """How often obstacles have stopped the robot on the way."""
        here = Pose(node.x, node.y, frontier.bearing)
        radius = self._grid.radius
        count = 0
        for x, y in self._bumps:
            bump = Pose(x, y, 0.0).relative_to(here)
            is_ahead = 0.0 < bump.x < self._step + radius
            count += is_ahead and abs(bump.y) < 0.6 * radius
        return count

    def _target(self, node: Node, frontier: Frontier) -> Target | None:
        """What to explore through a frontier; None if it leads to a known node."""
        goal = self._endpoint(node, frontier.bearing, frontier.length)
        for known_node in self._nodes_around(goal):
            if known_node is node:
                continue
            if self._closes_loop(node, known_node):
                return Target(node, frontier, known_node.position, known_node)
            frontier.target = known_node.number
            return None
        return Target(node, frontier, goal)

    def _nodes_around(
        self, position: Position, within: float | None = None
    ) -> Iterator[Node]:
        """The nodes that a position belongs to, or those within another distance."""
        for node in self.map.nodes_near(position, within or self._spacing):
            if self._grid.is_path_clear(position, node.position):
                yield node

    def _overlooked_target(self) -> Target | None:
        """A target between those directions that were tried, from where a new way leads on.

        A robot that is unsure of its pose keeps farther away from walls: few ways lead through
        a narrow door. Each direction is tried once.
        """
        if not self._looks_closely:
            return None
        distances = self.map.distances(self._here)
        for number in sorted(distances, key=distances.__getitem__):
            node = self.map.nodes[number]
            for frontier in self._overlooked(node):
                self._looked_at.add((number, frontier.bearing))
                node.frontiers.append(frontier)
                # An obstacle there is a wall, as the grid may have holes in walls.
                index = self._bearing_index(frontier.bearing)
                self._blocks[number, index] = self._max_attempts - 1
                goal = self._endpoint(node, frontier.bearing, frontier.length)
                return Target(node, frontier, goal)
        return None

    def _overlooked(self, node: Node) -> Iterator[Frontier]:
        """Directions that lead to new ways."""
        for bearing, length in itertools.product(self._close_bearings(), CLOSE_LENGTHS):
            goal = self._endpoint(node, bearing, length)
            frontier = Frontier(bearing, length=length)
            index = self._bearing_index(bearing)
            if (
                (node.number, bearing) not in self._looked_at
                and self._blocks[node.number, index] < self._max_attempts
                and self._grid.is_path_clear(node.position, goal)
                and not any(self._nodes_around(goal, CLOSE))
                and self._leads_on(goal)
                and not self._bumps_ahead(node, frontier)
            ):
                yield frontier

    def _close_bearings(self) -> list[float]:
        count = 3 * self.BEARINGS
        return [wrap_angle(index * math.tau / count) for index in range(count)]

    def _leads_on(self, goal: Position) -> bool:
        """Whether there is room for another step, to what is not seen from a node nearby."""
        ends = (Pose(*goal, bearing).ahead(self._step) for bearing in self._bearings())
        return any(
            self._grid.is_path_clear(goal, end)
            and not any(self._nodes_around(end, FAR_STEPS * self._step))
            for end in ((pose.x, pose.y) for pose in ends)
        )

    def _closes_loop(self, node: Node, known_node: Node) -> bool:
        """Whether driving to a known node closes a loop."""
        distance = self.map.distances(node).get(known_node.number, math.inf)
        return distance > self._min_loop and self._grid.is_path_clear(
            node.position, known_node.position
        )

    async def _travel_to(self, node: Node) -> bool:
        """Drives along known edges; returns False if an obstacle blocks one."""
        unlocalised = 0.0
        for next_node in self.map.path(self._here, node):
            unlocalised += self._here.neighbours[next_node.number]
            if not await self._robot.drive_to(next_node.position, lambda: False):
                await self._robot.back_up_to(self._here.position)
                self.map.block(self._here, next_node)
                await self._localise()
                return False
            before, self._here = self._here, next_node
            if unlocalised > self._max_unlocalised or next_node is node:
                await self._localise()
                unlocalised = 0.0
                if not self._is_at(next_node):
                    self.map.block(before, next_node)
                    self._here = self._nearest_node()
                    return False
        return True

    async def _explore_frontier(self, target: Target) -> None:
        """Drives through a frontier."""
        node = target.node
        should_stop = (
            self._openings_change(target)
            if target.known_node is None
            else lambda: False
        )
        if not await self._robot.drive_to(target.goal, should_stop):
            # An obstacle has appeared: this is no longer a frontier.
            contact = self._robot.pose().ahead(self._grid.radius)
            self._bumps.append((contact.x, contact.y))
            await self._robot.back_up_to(node.position)
            self._discard(target)
            return
        if target.known_node:
            await self._localise()
        self._here = target.known_node or await self._add_node()
        if self._is_at(self._here) and self._is_step(node, self._here):
            self.map.connect(node, self._here)
            target.frontier.target = self._here.number
            return
        # The robot was lost, and is somewhere else.
        self._discard(target)
        near = self._nearest_node(target.known_node or self._here)
        if target.known_node:
            self._here = near
        else:
            self.map.connect(near, self._here)

    def _discard(self, target: Target) -> None:
        """Postpones a frontier that the robot cannot explore, and removes it in the end."""
        index = self._bearing_index(target.frontier.bearing)
        self._blocks[target.node.number, index] += 1
        if self._blocks[target.node.number, index] >= self._max_attempts:
            target.node.frontiers.remove(target.frontier)

    def _is_at(self, node: Node) -> bool:
        """Whether the robot is at a node, as it should be."""
        here = self._robot.pose()
        return math.dist((here.x, here.y), node.position) < self._step

    def _is_step(self, a: Node, b: Node) -> bool:
        """Whether two nodes are as near to each other as connected ones."""
        return math.dist(a.position, b.position) < 3.0 * self._step

    def _nearest_node(self, besides: Node | None = None) -> Node:
        """The nearest node that the robot can drive to, or else the nearest."""
        pose = self._robot.pose()
        here = pose.x, pose.y
        near = [n for n in self.map.nodes_near(here, math.inf) if n is not besides]
        return next(
            (n for n in near if self._grid.is_path_clear(here, n.position)), near[0]
        )

    def _openings_change(self, target: Target) -> Callable[[], bool]:
        """Whether a passage opens to a side that was closed at the last node."""
        sides = (math.pi / 2.0, -math.pi / 2.0)

        def are_open(pose: Pose) -> list[bool]:
            ends = (pose.turned(side).ahead(self._step) for side in sides)
            start = pose.x, pose.y
            return [self._grid.is_path_clear(start, (end.x, end.y)) for end in ends]

        before = are_open(Pose(target.node.x, target.node.y, target.frontier.bearing))

        def should_stop() -> bool:
            here = self._robot.pose()
            if math.dist((here.x, here.y), target.node.position) < 0.5 * self._step:
                return False
            return any(
                now and not was for now, was in zip(are_open(here), before, strict=True)
            )

        return should_stop

    async def _add_node(self) -> Node:
        """Adds a node here and updates the frontiers of all nodes nearby."""
        number = await self._localise()
        here = Pose(*self._robot.position(number), 0.0)
        node = self.map.add(here.x, here.y)
        node.is_uncertain = number in self._robot.uncertain()
        self._keyframes.append(number)
        self._grid.mark_footprint(here.x, here.y)
        self._check_bounds(node)
        await self._look_around(node)
        for nearby in self.map.nodes_near(node.position, 4.0 * self._step):
            self._find_frontiers(nearby)
        self.on_node()
        return node

    def _check_bounds(self, node: Node) -> None:
        """Raises UnboundedAreaError if the area seems to be open."""
        distance = math.dist(node.position, self.map.nodes[0].position)
        if distance > self._extent:
            raise UnboundedAreaError(
                f"the area is still open {distance:.1f} m from the start: is it closed? "
                f"If it is larger, set --extent to more than {self._extent:g} m"
            )
        if len(self.map.nodes) >= self.MAX_NODES:
            raise UnboundedAreaError(
                f"the area is still open after {len(self.map.nodes)} nodes: is it closed?"
            )

    async def _localise(self) -> int:
        """Localises the robot and corrects the nodes' positions."""
        number = await self._robot.localise()
        for node, keyframe in zip(self.map.nodes, self._keyframes, strict=True):
            if (position := self._robot.position(keyframe)) != node.position:
                self.map.move(node, position)
            node.is_uncertain = keyframe in self._robot.uncertain()
        return number

    async def _look_around(self, node: Node) -> None:
        """Turns until all bearings are explored, towards the side with fewer missing."""
        turned, side = 0.0, 1.0
        while turned < self._blind_angle and (
            missing := self._unexplored_bearings(node)
        ):
            if turned == 0.0:
                heading = self._robot.pose().theta
                left = sum(wrap_angle(bearing - heading) > 0.0 for bearing in missing)
                side = 1.0 if 2 * left >= len(missing) else -1.0
            angle = min(self._blind_angle - turned, math.pi / 6.0)
            await self._robot.turn_by(side * angle)
            turned += angle
        self._grid.mark_footprint(node.x, node.y)

    def _unexplored_bearings(self, node: Node) -> list[float]:
        """The bearings that sensors have not covered yet."""
        return [
            bearing
            for bearing in self._bearings()
            if self._grid.is_unexplored(node.position, self._endpoint(node, bearing))
        ]

    def _find_frontiers(self, node: Node) -> None:
        """Adds frontiers for bearings that are open now; keeps the known ones."""
        known = {self._bearing_index(frontier.bearing) for frontier in node.frontiers}
        for bearing in self._open_bearings(node):
            index = self._bearing_index(bearing)
            is_blocked = self._blocks[node.number, index] >= self._max_attempts
            if index not in known and not is_blocked:
                node.frontiers.append(Frontier(bearing))

    def _open_bearings(self, node: Node) -> list[float]:
        """The middle of each open range of bearings; wide ranges give several."""
        bearings = self._bearings()
        is_clear = [
            self._grid.is_path_clear(node.position, self._endpoint(node, bearing))
            for bearing in bearings
        ]
        if all(is_clear):
            return bearings[:: self.BEARINGS // 8]
        found: list[float] = []
        first = is_clear.index(False)
        run: list[int] = []
        for index in range(first, first + self.BEARINGS + 1):
            if is_clear[index % self.BEARINGS]:
                run.append(index)
            elif run:
                count = 1 + (len(run) - 1) * 8 // self.BEARINGS
                for part in range(count):
                    fraction = 0.5 if count == 1 else part / (count - 1)
                    chosen = run[round(fraction * (len(run) - 1))]
                    found.append(bearings[chosen % self.BEARINGS])
                run = []
        return found

    def _bearings(self) -> list[float]:
        return [
            wrap_angle(index * math.tau / self.BEARINGS)
            for index in range(self.BEARINGS)
        ]

    def _bearing_index(self, bearing: float) -> int:
        return round(bearing / math.tau * self.BEARINGS) % self.BEARINGS

    def _endpoint(self, node: Node, bearing: float, length: float = 1.0) -> Position:
        end = Pose(node.x, node.y, bearing).ahead(length * self._step)
        return end.x, end.y
