#: if standalone
"""Where a robot is by how its wheels turn, and how that is put right by what it sees again."""

import math
from collections.abc import Sequence

from .coppeliasim import Body
from .floor import Place
from .pose import Pose, wrap_angle

#: endif


class Odometer:
    """Adds up what the wheels of a two-wheel robot roll."""

    def __init__(self, body: Body) -> None:
        """Starts where the simulator says that the robot is, and never asks it again."""
        self._body = body
        self._pose = body.pose()
        self._angles = body.wheel_angles()

    def pose(self) -> Pose:
        """Where the robot should be."""
        before, self._angles = self._angles, self._body.wheel_angles()
        left, right = (
            wrap_angle(now - was) * radius
            for now, was, radius in zip(
                self._angles, before, self._body.model.wheels.values(), strict=True
            )
        )
        # Both wheels go round the same centre: this is exact for any arc.
        turned = (right - left) / (2.0 * self._body.drive.turning_radius)
        chord = (left + right) / 2.0
        if turned:
            chord *= 2.0 * math.sin(turned / 2.0) / turned
        there = self._pose.turned(turned / 2.0).ahead(chord)
        self._pose = there.turned(turned / 2.0)
        return self._pose

    def correct(self, pose: Pose) -> None:
        """The robot is somewhere else."""
        self._pose = pose


GRAIN = 0.04  # m between cells of what was seen before
TURNS = math.radians(8.0)  # the most that a heading is put right at once ...
SHIFT = 0.16  # m: ... and a place


def recognise(here: Pose, seen: Sequence[Place], known: Sequence[Place]) -> Pose:
    """The pose from which `seen` lies on `known` best, near the one it was thought to be.

    Both are places where something stands, `seen` as it is from `here`. Where little of it
    fits, or nothing fits better, the pose stays.
    """
    field: dict[tuple[int, int], float] = {}
    for x, y in known:
        column, row = round(x / GRAIN), round(y / GRAIN)
        for right in range(-2, 3):
            for up in range(-2, 3):
                cell = column + right, row + up
                fit = 1.0 - math.hypot(right, up) / 3.0
                field[cell] = max(fit, field.get(cell, 0.0))
    points = [Pose(x, y, 0.0).seen_from(here) for x, y in seen]

    def score(pose: Pose) -> float:
        cos, sin = math.cos(pose.theta), math.sin(pose.theta)
        total = 0.0
        for point in points:
            x = pose.x + cos * point.x - sin * point.y
            y = pose.y + sin * point.x + cos * point.y
            total += field.get((round(x / GRAIN), round(y / GRAIN)), 0.0)
        # Along a bare wall everything fits: then the least change is best.
        off = math.hypot(pose.x - here.x, pose.y - here.y)
        turned = abs(wrap_angle(pose.theta - here.theta))
        return total / len(points) - 0.3 * off - 0.3 * turned

    if len(points) < 10:
        return here
    best, most = here, score(here)
    shift, turn = SHIFT / 2.0, TURNS / 2.0
    steps = [-2, -1, 0, 1, 2]
    while shift > 0.005:
        middle = best
        for a in steps:
            for b in steps:
                for c in steps:
                    pose = Pose(
                        middle.x + a * shift, middle.y + b * shift, middle.theta
                    )
                    pose = pose.turned(c * turn)
                    if (value := score(pose)) > most:
                        best, most = pose, value
        shift, turn, steps = shift / 2.0, turn / 2.0, [-1, 0, 1]
    return best if most > 0.4 else here
