#: if standalone
"""Where a robot is by what it sees: its marks laid on those that are known."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .pose import Pose, wrap_angle
from .scan import Mark

#: endif


Matrix = list[list[float]]


def solve(matrix: Sequence[Sequence[float]], right: Sequence[float]) -> list[float]:
    """The solution of linear equations, by elimination; the matrix is positive definite."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    size = len(rows)
    for pivot in range(size):
        for row in rows[pivot + 1 :]:
            share = row[pivot] / rows[pivot][pivot]
            for column in range(pivot, size + 1):
                row[column] -= share * rows[pivot][column]
    solution = [0.0] * size
    for index in reversed(range(size)):
        known = sum(rows[index][c] * solution[c] for c in range(index + 1, size))
        solution[index] = (rows[index][size] - known) / rows[index][index]
    return solution


@dataclass(frozen=True)
class KnownMark:
    """A mark in the world, and the number of the place that it was seen from."""

    x: float
    y: float
    cos: float  # of its normal
    sin: float
    place: int


class KnownMarks:
    """Marks by where they are."""

    CELL = 0.1  # m

    def __init__(self, marks: Iterable[KnownMark]) -> None:
        self._cells: dict[tuple[int, int], list[KnownMark]] = {}
        for mark in marks:
            self._cells.setdefault(self._cell(mark.x, mark.y), []).append(mark)

    def _cell(self, x: float, y: float) -> tuple[int, int]:
        return math.floor(x / self.CELL), math.floor(y / self.CELL)

    def nearest(
        self, x: float, y: float, normal: float, within: float
    ) -> KnownMark | None:
        """The nearest mark that faces about the same way."""
        cos, sin = math.cos(normal), math.sin(normal)
        left, low = self._cell(x - within, y - within)
        right, high = self._cell(x + within, y + within)
        best, least = None, within * within
        for column in range(left, right + 1):
            for row in range(low, high + 1):
                for mark in self._cells.get((column, row), ()):
                    square = (mark.x - x) ** 2 + (mark.y - y) ** 2
                    if square < least and mark.cos * cos + mark.sin * sin > 0.8:
                        best, least = mark, square
        return best


@dataclass(frozen=True)
class Match:
    """Where marks lie best on known ones."""

    pose: Pose  # of the place they are seen from
    drift: float  # radians that the sweep turned further than the wheels did
    share: float  # of the marks that lie on something known
    count: int  # of these
    rough: float  # m that they are off it (rms)
    information: dict[int, Matrix]  # on the pose, by the place that told it


MARK_ERROR = 0.015  # m
ALIKE = 4.0  # marks that tell the same, for they are next to each other
DRIFT = 0.03  # radians that a sweep may turn too far (standard deviation)
GATES = (
    0.25,
    0.2,
    0.15,
    0.1,
    0.08,
    0.06,
    0.06,
    0.06,
)  # m from mark to mark, as it goes on


def match(
    marks: Sequence[Mark],
    guess: Pose,
    uncertainty: tuple[float, float],
    known: KnownMarks,
    start: Pose | None = None,
) -> Match | None:
    """Lays marks on known ones, from point to line; None where too few have a counterpart.

    `uncertainty` is how far off the guess may be in metres and radians, as standard
    deviations: what the marks do not tell stays as it was. The search begins at `start`.
    """
    pose, drift = start or guess, 0.0
    place, heading = (1.0 / sigma**2 for sigma in uncertainty)
    for gate in GATES:
        rows = [
            [place, 0.0, 0.0, 0.0],
            [0.0, place, 0.0, 0.0],
            [0.0, 0.0, heading, 0.0],
            [0.0, 0.0, 0.0, 1.0 / DRIFT**2],
        ]
        off = (guess.x - pose.x, guess.y - pose.y, wrap_angle(guess.theta - pose.theta))
        right = [place * off[0], place * off[1], heading * off[2], -drift / DRIFT**2]
        pairs = list(paired(marks, pose, drift, known, gate))
        if len(pairs) < 8:
            return None
        for _, slope, error in pairs:
            weight = weight_of(error)
            for i in range(4):
                right[i] -= weight * slope[i] * error
                for j in range(4):
                    rows[i][j] += weight * slope[i] * slope[j]
        dx, dy, turned, more = solve(rows, right)
        pose = Pose(pose.x + dx, pose.y + dy, wrap_angle(pose.theta + turned))
        drift += more
    return summed_up(marks, pose, drift, known)


def weight_of(error: float) -> float:
    """Of a pair: the further apart, the less likely is it one (Geman and McClure)."""
    return (
        1.0 / (ALIKE * MARK_ERROR**2) / (1.0 + (error / (2.0 * MARK_ERROR)) ** 2) ** 2
    )


def paired(
    marks: Sequence[Mark], pose: Pose, drift: float, known: KnownMarks, gate: float
) -> Iterable[tuple[KnownMark, list[float], float]]:
    """Marks with their counterparts: how an error depends on the pose and the drift."""
    for mark in marks:
        turned = Pose(pose.x, pose.y, pose.theta + drift * mark.when)
        at = Pose(mark.x, mark.y, mark.normal).placed_on(turned)
        other = known.nearest(at.x, at.y, at.theta, gate)
        if other is not None:
            error = other.cos * (at.x - other.x) + other.sin * (at.y - other.y)
            swing = other.sin * (at.x - pose.x) - other.cos * (at.y - pose.y)
            yield other, [other.cos, other.sin, swing, swing * mark.when], error


def summed_up(
    marks: Sequence[Mark], pose: Pose, drift: float, known: KnownMarks
) -> Match:
    information: dict[int, Matrix] = {}
    squares, count = 0.0, 0
    for other, slope, error in paired(marks, pose, drift, known, GATES[-1]):
        rows = information.setdefault(other.place, [[0.0] * 4 for _ in range(4)])
        weight = weight_of(error)
        for i in range(4):
            for j in range(4):
                rows[i][j] += weight * slope[i] * slope[j]
        squares += error * error
        count += 1
    # What also a drift would explain says nothing of the pose (Schur complement).
    reduced = {}
    for number, rows in information.items():
        rest = rows[3][3] + 1.0 / DRIFT**2
        reduced[number] = [
            [rows[i][j] - rows[i][3] * rows[3][j] / rest for j in range(3)]
            for i in range(3)
        ]
    share = count / max(1, len(marks))
    return Match(pose, drift, share, count, math.sqrt(squares / max(1, count)), reduced)
