"""A pose graph: poses estimated together from the constraints between them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import bsr_array, coo_array, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from ...pose import Pose, wrap_angle
from .poses import Array, difference, rows_of, transformed

LOOSE = np.diag(np.array([0.5, 0.5, 2.0]) ** -2)  # the information after contact


@dataclass(frozen=True, eq=False)
class Constraint:
    """A measurement of one pose relative to another."""

    start: int
    end: int
    relative: Pose  # the end in the frame of the start
    information: Array  # on x, y and heading in the world: the inverse covariance
    is_odometry: bool = False  # so it connects the right poses; a scan match may not


class PoseGraph:
    """Poses, and constraints between them.

    The poses minimise the squared error of all constraints: a loop closure spreads the
    accumulated error over the whole loop.
    """

    MAX_ITERATIONS = 3  # of Gauss-Newton
    MAX_CHI2 = 16.0  # that a loop closure may add to any odometry constraint

    def __init__(self) -> None:
        self.poses: list[Pose] = []
        self._constraints: list[Constraint] = []
        self._headings: list[Constraint] = []

    def add(self, pose: Pose) -> int:
        """Adds a pose and returns its number; the first pose is fixed."""
        self.poses.append(pose)
        return len(self.poses) - 1

    def add_constraint(self, constraint: Constraint) -> None:
        """Adds a relative measurement."""
        self._constraints.append(constraint)

    def add_heading(self, node: int, heading: float, sigma: float) -> None:
        """Adds an absolute measurement of a heading, with its standard deviation."""
        relative = Pose(0.0, 0.0, heading - self.poses[0].theta)
        information = np.diag([0.0, 0.0, sigma**-2])
        self._headings.append(Constraint(0, node, relative, information))

    def loosen(self, number: int) -> None:
        """Lets a pose be nearly anywhere: the robot was turned or moved on the way there."""
        odometry = [c for c in self._constraints if c.is_odometry and c.end == number]
        self._constraints = [
            c for c in self._constraints if number not in (c.start, c.end)
        ]
        self._headings = [c for c in self._headings if c.end != number]
        for c in odometry:
            self.add_constraint(replace(c, information=LOOSE, is_odometry=False))

    def connected_components(self, nodes: Sequence[int]) -> list[list[int]]:
        """Groups nodes that are connected by constraints among them."""
        connections = coo_array((len(self.poses), len(self.poses)))
        if self._constraints:
            ends = np.array([(c.start, c.end) for c in self._constraints])
            connections = coo_array(
                (np.ones(len(ends)), tuple(ends.T)), connections.shape
            )
        among = connections.tocsr()[nodes][:, nodes]
        count, labels = connected_components(among, directed=False)
        return [
            sorted(
                node for node, own in zip(nodes, labels, strict=True) if own == label
            )
            for label in range(count)
        ]

    def optimise(self) -> None:
        """Minimises the squared error of all constraints (Gauss-Newton)."""
        system = LinearSystem([*self._constraints, *self._headings])
        poses = rows_of(self.poses)
        for _ in range(self.MAX_ITERATIONS):
            change = system.solution(poses)
            poses += change
            if np.abs(change).max() < 1e-4:
                break
        self.poses[:] = [Pose(x, y, wrap_angle(turn)) for x, y, turn in poses.tolist()]

    def try_loop_closure(self, constraints: Sequence[Constraint]) -> bool:
        """Adds constraints that close a loop, unless they contradict the odometry."""
        poses, count = list(self.poses), len(self._constraints)
        odometry = LinearSystem([c for c in self._constraints if c.is_odometry])
        before = odometry.chi2(rows_of(poses))
        self._constraints += constraints
        self.optimise()
        # Where the robot was pushed, they may contradict each other already.
        added = odometry.chi2(rows_of(self.poses)) - before
        if added.max(initial=0.0) <= self.MAX_CHI2:
            return True
        self.poses[:] = poses
        del self._constraints[count:]
        return False


class LinearSystem:
    """Constraints as arrays, and their normal equations."""

    def __init__(self, constraints: Sequence[Constraint]) -> None:
        ends = [(c.start, c.end) for c in constraints]
        self._ends = np.array(ends, int).reshape(-1, 2)
        self._relative = rows_of(c.relative for c in constraints)
        information = np.array([c.information for c in constraints])
        self._information = information.reshape(-1, 3, 3)

    def chi2(self, poses: Array) -> Array:
        """The squared error of each constraint, in standard deviations."""
        error, _ = self._errors(poses)
        found: Array = np.einsum("ci,cij,cj->c", error, self._information, error)
        return found

    def solution(self, poses: Array) -> Array:
        """The changes of x, y and heading that minimise the linearised error."""
        error, jacobian = self._errors(poses)
        numbers = np.arange(len(error) + 1)
        weights = bsr_array((self._information, numbers[:-1], numbers))
        weighted = jacobian.T @ weights
        prior = np.full_like(poses, 1e-6)
        prior[0] = 1e9  # the first pose is fixed
        system = weighted @ jacobian + diags_array(prior.ravel())
        return np.reshape(spsolve(system.tocsc(), -weighted @ error.ravel()), (-1, 3))

    def _errors(self, poses: Array) -> tuple[Array, bsr_array]:
        """The differences between ends and measurements, and the derivatives by all poses."""
        start, end = poses[self._ends[:, 0]], poses[self._ends[:, 1]]
        there = transformed(self._relative, start)
        blocks = np.tile([-np.eye(3), np.eye(3)], (len(start), 1, 1))
        # When the start rotates, the end moves around it.
        lever = there - start
        blocks[::2, 0, 2], blocks[::2, 1, 2] = lever[:, 1], -lever[:, 0]
        places = self._ends.ravel(), 2 * np.arange(len(start) + 1)
        jacobian = bsr_array((blocks, *places), (start.size, poses.size))
        return difference(end, there), jacobian
