#: if standalone
"""Places whose poses follow from what is known of them, all together."""

from collections.abc import Sequence
from dataclasses import dataclass

from .pose import Pose, wrap_angle
from .scan_matching import Matrix, solve

#: endif


@dataclass(frozen=True)
class Link:
    """Where a place is as seen from another one, and how sure that is."""

    start: int
    end: int
    relative: Pose  # of the end, seen from the start
    information: Matrix  # on x, y and heading in the world: the inverse of a covariance
    is_certain: bool = False  # that it is about these places: wheels never mistake them


@dataclass(frozen=True)
class Compass:
    """The heading of a place, and how sure that is."""

    place: int
    heading: float
    information: float


class PoseGraph:
    """Poses of places, and links between them.

    The poses are those that agree best with all links, in the sense of least squares: an
    error that shows when a loop closes is spread over all the way round.
    """

    ROUNDS = 3  # of making the problem linear about the poses by then
    STRAIN = 16.0  # squared deviations that what is certain may be off at most

    def __init__(self) -> None:
        self.poses: list[Pose] = []
        self._links: list[Link] = []
        self._compasses: list[Compass] = []

    def add(self, pose: Pose) -> int:
        """A new place; the first one stays where it is. The result is its number."""
        self.poses.append(pose)
        return len(self.poses) - 1

    def link(self, link: Link) -> None:
        """Something is known of two places."""
        self._links.append(link)

    def orient(self, compass: Compass) -> None:
        """Something is known of a heading."""
        self._compasses.append(compass)

    def components(self, places: Sequence[int]) -> list[list[int]]:
        """The places in groups that hang together by links between them."""
        left, found = set(places), []
        neighbours: dict[int, list[int]] = {place: [] for place in left}
        for link in self._links:
            if link.start in left and link.end in left:
                neighbours[link.start].append(link.end)
                neighbours[link.end].append(link.start)
        for place in places:
            group, queue = [], [place]
            while queue:
                number = queue.pop()
                if number in left:
                    left.remove(number)
                    group.append(number)
                    queue += neighbours[number]
            if group:
                found.append(sorted(group))
        return found

    def relax(self) -> None:
        """Finds the poses that agree best (Gauss-Newton)."""
        for _ in range(self.ROUNDS):
            system = self._linear()
            change = system.solution()
            for number, (dx, dy, turned) in enumerate(change):
                pose = self.poses[number]
                theta = wrap_angle(pose.theta + turned)
                self.poses[number] = Pose(pose.x + dx, pose.y + dy, theta)
            if max(max(map(abs, step)) for step in change) < 1e-4:
                break

    def closes(self, links: Sequence[Link]) -> bool:
        """Adds links that close a loop, if all that is certain can be as they say."""
        poses, count = list(self.poses), len(self._links)
        self._links += links
        self.relax()
        strain = max(
            (
                bilinear(link.information, self._error(link), self._error(link))
                for link in self._links
                if link.is_certain
            ),
            default=0.0,
        )
        if strain <= self.STRAIN:
            return True
        self.poses[:] = poses
        del self._links[count:]
        return False

    def _error(self, link: Link) -> list[float]:
        """How far the end is from where the link has it."""
        end, there = (
            self.poses[link.end],
            link.relative.placed_on(self.poses[link.start]),
        )
        return [end.x - there.x, end.y - there.y, wrap_angle(end.theta - there.theta)]

    def _linear(self) -> "LinearSystem":
        system = LinearSystem(len(self.poses))
        for link in self._links:
            start = self.poses[link.start]
            there = link.relative.placed_on(start)
            # When the start turns, the end goes round it.
            lever = (-(there.y - start.y), there.x - start.x)
            slope = [[-1.0, 0.0, -lever[0]], [0.0, -1.0, -lever[1]], [0.0, 0.0, -1.0]]
            system.add(link, slope, self._error(link))
        for compass in self._compasses:
            off = wrap_angle(self.poses[compass.place].theta - compass.heading)
            system.turn(compass.place, compass.information, off)
        return system


def bilinear(matrix: Matrix, a: Sequence[float], b: Sequence[float]) -> float:
    """A'Mb."""
    return sum(a[i] * matrix[i][j] * b[j] for i in range(len(a)) for j in range(len(b)))


Vector = list[list[float]]  # three numbers for each place


class LinearSystem:
    """Equations for small changes of poses, in blocks of three by three."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._blocks: dict[tuple[int, int], Matrix] = {}
        self._right: Vector = [[0.0] * 3 for _ in range(count)]
        # The first place stays.
        self._add_block(0, 0, [[1e9 * (i == j) for j in range(3)] for i in range(3)])
        for number in range(count):
            tiny = [[1e-6 * (i == j) for j in range(3)] for i in range(3)]
            self._add_block(number, number, tiny)

    def add(self, link: Link, slope: Matrix, error: Sequence[float]) -> None:
        """A link, whose error depends on the start by `slope` and on the end directly."""
        start, end, weighted = link.start, link.end, link.information
        across = product(transposed(slope), weighted)
        self._add_block(start, start, product(across, slope))
        self._add_block(start, end, across)
        self._add_block(end, start, transposed(across))
        self._add_block(end, end, weighted)
        for i in range(3):
            self._right[start][i] -= sum(across[i][j] * error[j] for j in range(3))
            self._right[end][i] -= sum(weighted[i][j] * error[j] for j in range(3))

    def turn(self, place: int, information: float, error: float) -> None:
        """A heading that is known."""
        self._blocks[place, place][2][2] += information
        self._right[place][2] -= information * error

    def _add_block(self, row: int, column: int, block: Matrix) -> None:
        known = self._blocks.setdefault((row, column), [[0.0] * 3 for _ in range(3)])
        for i in range(3):
            for j in range(3):
                known[i][j] += block[i][j]

    def solution(self) -> Vector:
        """By conjugate gradients, with each place's own block to begin with."""
        found: Vector = [[0.0] * 3 for _ in range(self._count)]
        rest = [list(part) for part in self._right]
        eased = self._eased(rest)
        direction = [list(part) for part in eased]
        now = dot_product(rest, eased)
        goal = 1e-8 * now
        for _ in range(6 * self._count):
            if now <= goal or now < 1e-12:
                break
            image = self._times(direction)
            step = now / dot_product(direction, image)
            for n in range(self._count):
                for i in range(3):
                    found[n][i] += step * direction[n][i]
                    rest[n][i] -= step * image[n][i]
            eased = self._eased(rest)
            before, now = now, dot_product(rest, eased)
            for n in range(self._count):
                for i in range(3):
                    direction[n][i] = eased[n][i] + now / before * direction[n][i]
        return found

    def _eased(self, vector: Vector) -> Vector:
        return [solve(self._blocks[n, n], part) for n, part in enumerate(vector)]

    def _times(self, vector: Vector) -> Vector:
        found: Vector = [[0.0] * 3 for _ in range(self._count)]
        for (row, column), block in self._blocks.items():
            x, y, theta = vector[column]
            sums = found[row]
            for i in range(3):
                a, b, c = block[i]
                sums[i] += a * x + b * y + c * theta
        return found


def transposed(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]


def product(a: Matrix, b: Matrix) -> Matrix:
    return [
        [
            sum(p * q for p, q in zip(row, column, strict=True))
            for column in zip(*b, strict=True)
        ]
        for row in a
    ]


def dot_product(a: Vector, b: Vector) -> float:
    return sum(
        p * q for u, v in zip(a, b, strict=True) for p, q in zip(u, v, strict=True)
    )
