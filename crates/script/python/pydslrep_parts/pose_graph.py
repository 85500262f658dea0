#: if standalone
"""A pose graph: poses estimated together from the constraints between them."""

from collections.abc import Sequence
from dataclasses import dataclass

from .pose import Pose, wrap_angle
from .scan_matching import Matrix, solve

#: endif


@dataclass(frozen=True)
class Constraint:
    """A measurement of one pose relative to another."""

    start: int
    end: int
    relative: Pose  # the end in the frame of the start
    information: Matrix  # on x, y and heading in the world: the inverse covariance
    is_odometry: bool = False  # so it connects the right poses; a scan match may not


@dataclass(frozen=True)
class HeadingEstimate:
    """An absolute measurement of a heading."""

    node: int
    heading: float
    information: float


class PoseGraph:
    """Poses, and constraints between them.

    The poses minimise the squared error of all constraints: a loop closure spreads the
    accumulated error over the whole loop.
    """

    MAX_ITERATIONS = 3  # of Gauss-Newton
    MAX_CHI2 = 16.0  # of any odometry constraint after a loop closure

    def __init__(self) -> None:
        self.poses: list[Pose] = []
        self._constraints: list[Constraint] = []
        self._headings: list[HeadingEstimate] = []

    def add(self, pose: Pose) -> int:
        """Adds a pose and returns its number; the first pose is fixed."""
        self.poses.append(pose)
        return len(self.poses) - 1

    def add_constraint(self, constraint: Constraint) -> None:
        """Adds a relative measurement."""
        self._constraints.append(constraint)

    def add_heading(self, heading: HeadingEstimate) -> None:
        """Adds an absolute heading."""
        self._headings.append(heading)

    def connected_components(self, nodes: Sequence[int]) -> list[list[int]]:
        """Groups nodes that are connected by constraints among them."""
        left, found = set(nodes), []
        neighbours: dict[int, list[int]] = {node: [] for node in left}
        for constraint in self._constraints:
            if constraint.start in left and constraint.end in left:
                neighbours[constraint.start].append(constraint.end)
                neighbours[constraint.end].append(constraint.start)
        for node in nodes:
            group, queue = [], [node]
            while queue:
                number = queue.pop()
                if number in left:
                    left.remove(number)
                    group.append(number)
                    queue += neighbours[number]
            if group:
                found.append(sorted(group))
        return found

    def optimise(self) -> None:
        """Minimises the squared error of all constraints (Gauss-Newton)."""
        for _ in range(self.MAX_ITERATIONS):
            system = self._linearise()
            change = system.solution()
            for number, (dx, dy, turned) in enumerate(change):
                pose = self.poses[number]
                theta = wrap_angle(pose.theta + turned)
                self.poses[number] = Pose(pose.x + dx, pose.y + dy, theta)
            if max(max(map(abs, step)) for step in change) < 1e-4:
                break

    def try_loop_closure(self, constraints: Sequence[Constraint]) -> bool:
        """Adds constraints that close a loop, unless they contradict the odometry."""
        poses, count = list(self.poses), len(self._constraints)
        self._constraints += constraints
        self.optimise()
        chi2 = max(
            (
                bilinear_form(
                    constraint.information,
                    self._error(constraint),
                    self._error(constraint),
                )
                for constraint in self._constraints
                if constraint.is_odometry
            ),
            default=0.0,
        )
        if chi2 <= self.MAX_CHI2:
            return True
        self.poses[:] = poses
        del self._constraints[count:]
        return False

    def _error(self, constraint: Constraint) -> list[float]:
        """The difference between the end's pose and the measurement."""
        end, there = (
            self.poses[constraint.end],
            constraint.relative.transformed_by(self.poses[constraint.start]),
        )
        return [end.x - there.x, end.y - there.y, wrap_angle(end.theta - there.theta)]

    def _linearise(self) -> "LinearSystem":
        system = LinearSystem(len(self.poses))
        for constraint in self._constraints:
            start = self.poses[constraint.start]
            there = constraint.relative.transformed_by(start)
            # When the start rotates, the end moves around it.
            lever = (-(there.y - start.y), there.x - start.x)
            jacobian = [
                [-1.0, 0.0, -lever[0]],
                [0.0, -1.0, -lever[1]],
                [0.0, 0.0, -1.0],
            ]
            system.add(constraint, jacobian, self._error(constraint))
        for heading in self._headings:
            error = wrap_angle(self.poses[heading.node].theta - heading.heading)
            system.add_heading(heading.node, heading.information, error)
        return system


def bilinear_form(matrix: Matrix, a: Sequence[float], b: Sequence[float]) -> float:
    """Computes a'Mb."""
    return sum(a[i] * matrix[i][j] * b[j] for i in range(len(a)) for j in range(len(b)))


Vector = list[list[float]]  # three numbers per pose


class LinearSystem:
    """The normal equations for small changes of the poses, in 3x3 blocks."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._blocks: dict[tuple[int, int], Matrix] = {}
        self._rhs: Vector = [[0.0] * 3 for _ in range(count)]
        # The first pose is fixed.
        self._add_block(0, 0, [[1e9 * (i == j) for j in range(3)] for i in range(3)])
        for number in range(count):
            tiny = [[1e-6 * (i == j) for j in range(3)] for i in range(3)]
            self._add_block(number, number, tiny)

    def add(
        self, constraint: Constraint, jacobian: Matrix, error: Sequence[float]
    ) -> None:
        """Adds a constraint; `jacobian` is by the start, that by the end is the identity."""
        start, end, weighted = constraint.start, constraint.end, constraint.information
        across = product(transposed(jacobian), weighted)
        self._add_block(start, start, product(across, jacobian))
        self._add_block(start, end, across)
        self._add_block(end, start, transposed(across))
        self._add_block(end, end, weighted)
        for i in range(3):
            self._rhs[start][i] -= sum(across[i][j] * error[j] for j in range(3))
            self._rhs[end][i] -= sum(weighted[i][j] * error[j] for j in range(3))

    def add_heading(self, node: int, information: float, error: float) -> None:
        """Adds an absolute heading."""
        self._blocks[node, node][2][2] += information
        self._rhs[node][2] -= information * error

    def _add_block(self, row: int, column: int, block: Matrix) -> None:
        known = self._blocks.setdefault((row, column), [[0.0] * 3 for _ in range(3)])
        for i in range(3):
            for j in range(3):
                known[i][j] += block[i][j]

    def solution(self) -> Vector:
        """Solves by conjugate gradients with a block-Jacobi preconditioner."""
        found: Vector = [[0.0] * 3 for _ in range(self._count)]
        residual = [list(part) for part in self._rhs]
        preconditioned = self._precondition(residual)
        direction = [list(part) for part in preconditioned]
        now = dot_product(residual, preconditioned)
        goal = 1e-8 * now
        for _ in range(6 * self._count):
            if now <= goal or now < 1e-12:
                break
            image = self._multiply(direction)
            step = now / dot_product(direction, image)
            for n in range(self._count):
                for i in range(3):
                    found[n][i] += step * direction[n][i]
                    residual[n][i] -= step * image[n][i]
            preconditioned = self._precondition(residual)
            before, now = now, dot_product(residual, preconditioned)
            for n in range(self._count):
                for i in range(3):
                    direction[n][i] = (
                        preconditioned[n][i] + now / before * direction[n][i]
                    )
        return found

    def _precondition(self, vector: Vector) -> Vector:
        return [solve(self._blocks[n, n], part) for n, part in enumerate(vector)]

    def _multiply(self, vector: Vector) -> Vector:
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
